import type { Quaternion, Vector3 } from "three";
import type { Stage } from "../scene/stage";

/** Where one looks from: looks along its own −Z with +Y up. */
export interface Viewpoint {
  position: Vector3;
  rotation: Quaternion;
  /** Vertical angle of view, radians. */
  fieldOfView: number;
}

/** What a way of looking may know. */
export interface Scenery {
  stage: Stage;
  /** World time now, seconds. */
  time: number;
  /** Identity of the selected individual, 0 for none. */
  selected: number;
  /** Seconds since the last picture; of the film's clock while a video is made. */
  dt: number;
}

/** A way of looking at the world. */
export interface CameraMode {
  readonly name: string;
  /** Begins from where one looked until now. */
  enter(from: Viewpoint, scenery: Scenery): void;
  /** Moves the viewpoint; says why not if it cannot. */
  update(view: Viewpoint, scenery: Scenery): string | null;
  leave(): void;
}
