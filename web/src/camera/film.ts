import type { Rig } from "../messages/types";
import { RigCamera } from "./rig";
import type { CameraMode, Scenery, Viewpoint } from "./viewpoint";

/** Seconds that a shot is held if the world does not say. */
const HOLD = 8;

/** Goes by itself through the world's shot list, else from rig to rig, until a hand takes over. */
export class FilmCamera implements CameraMode {
  readonly name = "film";
  private readonly shots: { camera: RigCamera; hold: number }[];
  private shot = 0;
  private held = 0;

  constructor(rigs: Rig[], list: [string, number][] = []) {
    const known = list.flatMap(([name, hold]) => {
      const rig = rigs.find((one) => one.name === name);
      return rig ? [{ camera: new RigCamera(rig), hold }] : [];
    });
    this.shots = known.length > 0 ? known : rigs.map((rig) => ({ camera: new RigCamera(rig), hold: HOLD }));
  }

  enter(): void {
    this.shot = 0;
    this.begin();
  }

  leave(): void {}

  update(view: Viewpoint, scenery: Scenery): string | null {
    this.held += scenery.dt;
    if (this.held > this.shots[this.shot].hold && this.shots.length > 1) {
      this.shot = (this.shot + 1) % this.shots.length;
      this.begin();
    }
    return this.shots[this.shot].camera.update(view, scenery);
  }

  private begin(): void {
    this.held = 0;
    this.shots[this.shot].camera.enter();
  }
}
