import { PerspectiveCamera, Quaternion, Vector3 } from "three";
import type { Hello } from "../messages/types";
import { EyeCamera } from "./eye";
import { FilmCamera } from "./film";
import { FIELD_OF_VIEW, FollowCamera, FreeCamera, HandControls, TopCamera } from "./orbit";
import { facing, RigCamera } from "./rig";
import type { CameraMode, Scenery, Viewpoint } from "./viewpoint";

/** All ways of looking, and the one in use. */
export class Cameras {
  readonly camera = new PerspectiveCamera(35, 1, 0.02, 600);
  readonly view: Viewpoint = {
    position: new Vector3(6, 2, 6),
    rotation: new Quaternion(),
    fieldOfView: FIELD_OF_VIEW,
  };
  /** Called when another way of looking is in use. */
  changed: (name: string) => void = () => {};
  private readonly hand: HandControls;
  private readonly always: CameraMode[];
  private modes: CameraMode[];
  private mode: CameraMode;
  private entered = false;
  private scenery: Scenery | null = null;

  constructor(element: HTMLElement) {
    this.hand = new HandControls(element);
    const free = new FreeCamera(this.hand);
    this.always = [free, new FollowCamera(this.hand), new EyeCamera(), new TopCamera(this.hand)];
    this.modes = this.always;
    this.mode = free;
    this.camera.matrixAutoUpdate = false;
  }

  get name(): string {
    return this.mode.name;
  }

  get names(): string[] {
    return this.modes.map((mode) => mode.name);
  }

  /** Takes the world's rigs; starts filming with them if there are any and nothing was chosen. */
  offer({ cameras: rigs, shots }: Hello, start: boolean): void {
    const own = rigs.map((rig) => new RigCamera(rig));
    this.modes = [...this.always, ...own];
    const film = new FilmCamera(rigs, shots);
    if (rigs.length > 0) this.modes.push(film);
    const again = this.modes.find((mode) => mode.name === this.mode.name);
    const next = start && rigs.length > 0 ? film : (again ?? this.always[0]);
    if (next === this.mode) return;
    this.mode.leave();
    this.mode = next;
    this.entered = false;
    this.changed(next.name);
  }

  /** Looks at the whole of a box, for worlds without rigs. */
  frame(box: readonly number[]): void {
    const middle = new Vector3((box[0] + box[3]) / 2, (box[1] + box[4]) / 2, (box[2] + box[5]) / 2);
    const size = Math.min(20, Math.hypot(box[3] - box[0], box[4] - box[1], box[5] - box[2]));
    this.view.position.copy(middle).add(new Vector3(0.35, 0.12, 0.5).multiplyScalar(size));
    this.view.rotation.copy(facing(this.view.position, middle));
    this.entered = false;
  }

  /** Uses another way of looking; unknown names change nothing. */
  use(name: string): void {
    const mode = this.modes.find((one) => one.name === name);
    if (!mode || mode === this.mode) return;
    this.mode.leave();
    this.mode = mode;
    this.entered = false;
    this.changed(name);
  }

  /** The next way of looking; those that need a selected animal are left out without one. */
  next(selected: number): void {
    const possible = this.modes.filter((mode) => selected !== 0 || !["follow", "eye"].includes(mode.name));
    const index = possible.indexOf(this.mode);
    this.use(possible[(index + 1) % possible.length].name);
  }

  /** A hand has touched the picture: automatic cameras give way to the free one, from where they are. */
  touched(): void {
    if (["free", "follow", "top"].includes(this.name)) return;
    this.use("free");
    if (this.scenery) this.enter(this.scenery); // at once, so that the drag that has just begun counts
  }

  /** Looks from here to there with the free camera. */
  lookFrom(position: [number, number, number], target: [number, number, number]): void {
    this.use("free");
    this.view.position.set(...position);
    this.view.rotation.copy(facing(this.view.position, new Vector3(...target)));
    this.entered = false;
  }

  /** Moves the camera for the next picture; `aspect` is width over height. */
  update(scenery: Scenery, aspect: number): void {
    this.scenery = scenery;
    if (!this.entered) this.enter(scenery);
    const problem = this.mode.update(this.view, scenery);
    if (problem) this.use("free");
    this.keepAboveGround(scenery);
    this.apply(aspect);
  }

  private enter(scenery: Scenery): void {
    this.mode.enter(this.view, scenery);
    this.entered = true;
  }

  private keepAboveGround(scenery: Scenery): void {
    const ground = scenery.stage.ground.heightAt(this.view.position.x, this.view.position.z);
    this.view.position.y = Math.max(this.view.position.y, ground + 0.06);
  }

  private apply(aspect: number): void {
    const { camera, view } = this;
    camera.position.copy(view.position);
    camera.quaternion.copy(view.rotation);
    camera.fov = (view.fieldOfView * 180) / Math.PI;
    camera.aspect = aspect;
    camera.updateMatrix();
    camera.updateMatrixWorld();
    camera.updateProjectionMatrix();
  }
}
