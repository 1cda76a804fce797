import type { Rig } from "../messages/types";
import { RigCamera } from "./rig";
import type { CameraMode, Scenery, Viewpoint } from "./viewpoint";

/** Seconds that a shot is held. */
const SHOT = 8;

/** Goes by itself from one of the world's rigs to the next, until a hand takes over. */
export class FilmCamera implements CameraMode {
  readonly name = "film";
  private readonly shots: RigCamera[];
  private shot = 0;
  private held = 0;

  constructor(rigs: Rig[]) {
    this.shots = rigs.map((rig) => new RigCamera(rig));
  }

  enter(): void {
    this.shot = 0;
    this.begin();
  }

  leave(): void {}

  update(view: Viewpoint, scenery: Scenery): string | null {
    this.held += scenery.dt;
    if (this.held > SHOT && this.shots.length > 1) {
      this.shot = (this.shot + 1) % this.shots.length;
      this.begin();
    }
    return this.shots[this.shot].update(view, scenery);
  }

  private begin(): void {
    this.held = 0;
    this.shots[this.shot].enter();
  }
}
