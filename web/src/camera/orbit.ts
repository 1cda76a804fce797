import CameraControls from "camera-controls";
import * as THREE from "three";
import { relaxation, subjectOf } from "./rig";
import type { CameraMode, Scenery, Viewpoint } from "./viewpoint";

CameraControls.install({ THREE });

/** Vertical angle of view: a lens of about 38 mm, radians. */
export const FIELD_OF_VIEW = 0.62;
/** Time constant in seconds with which the point of interest follows the animal. */
const FOLLOW_LAG = 0.35;

/** Controls by mouse, touch and wheel, shared by the modes that use them. */
export class HandControls {
  readonly controls: CameraControls;
  private readonly own = new THREE.PerspectiveCamera();

  constructor(element: HTMLElement) {
    this.controls = new CameraControls(this.own, element);
    this.controls.enabled = false;
    this.controls.smoothTime = 0.22;
    this.controls.draggingSmoothTime = 0.09;
    this.controls.minDistance = 0.05;
    this.controls.dollyToCursor = false;
  }

  /** Takes over a viewpoint that looks at a point so many metres ahead. */
  takeOver(view: Viewpoint, distance: number): void {
    const ahead = new THREE.Vector3(0, 0, -distance).applyQuaternion(view.rotation).add(view.position);
    const { x, y, z } = view.position;
    this.controls.setLookAt(x, y, z, ahead.x, ahead.y, ahead.z, false);
  }

  move(view: Viewpoint, dt: number): void {
    this.own.fov = THREE.MathUtils.radToDeg(view.fieldOfView);
    this.controls.update(dt);
    view.position.copy(this.own.position);
    view.rotation.copy(this.own.quaternion);
  }
}

/** Goes wherever the hand leads it. */
export class FreeCamera implements CameraMode {
  readonly name = "free";

  constructor(private readonly hand: HandControls) {}

  enter(from: Viewpoint, scenery: Scenery): void {
    this.hand.takeOver(from, distanceAhead(from, scenery));
    this.hand.controls.enabled = true;
  }

  leave(): void {
    this.hand.controls.enabled = false;
  }

  update(view: Viewpoint, scenery: Scenery): string | null {
    view.fieldOfView += (FIELD_OF_VIEW - view.fieldOfView) * relaxation(scenery.dt, 0.4);
    this.hand.move(view, scenery.dt);
    return null;
  }
}

/** Goes with the selected animal; the hand may turn round it and come nearer. */
export class FollowCamera implements CameraMode {
  readonly name = "follow";
  private subject = 0;
  private readonly point = new THREE.Vector3();

  constructor(private readonly hand: HandControls) {}

  enter(): void {
    this.subject = 0;
    this.hand.controls.enabled = true;
  }

  leave(): void {
    this.hand.controls.enabled = false;
  }

  update(view: Viewpoint, scenery: Scenery): string | null {
    const subject = subjectOf(scenery, scenery.selected);
    if (!subject) return "select an animal to follow it";
    const { controls } = this.hand;
    const lead = new THREE.Vector3(0, 0, 0.35 * subject.length).applyQuaternion(subject.rotation);
    const aim = subject.position.clone().add(lead);
    if (this.subject !== scenery.selected) {
      const offset = new THREE.Vector3(2.6, 0.9, -1.9).multiplyScalar(subject.length);
      const from = offset.applyQuaternion(subject.rotation).add(aim);
      this.point.copy(aim);
      const smoothly = this.subject !== 0;
      controls.setLookAt(from.x, from.y, from.z, aim.x, aim.y, aim.z, smoothly);
      this.subject = scenery.selected;
    }
    if (this.point.distanceTo(aim) > 12 * subject.length) this.point.copy(aim);
    this.point.lerp(aim, relaxation(scenery.dt, FOLLOW_LAG));
    controls.moveTo(this.point.x, this.point.y, this.point.z, false);
    view.fieldOfView += (FIELD_OF_VIEW - view.fieldOfView) * relaxation(scenery.dt, 0.4);
    this.hand.move(view, scenery.dt);
    return null;
  }
}

/** Looks straight down on everything. */
export class TopCamera implements CameraMode {
  readonly name = "top";

  constructor(private readonly hand: HandControls) {}

  enter(_from: Viewpoint, scenery: Scenery): void {
    const box = scenery.stage.layout?.bounds ?? [-5, 0, -5, 5, 5, 5];
    const [x, z] = [(box[0] + box[3]) / 2, (box[2] + box[5]) / 2];
    const wide = Math.max(4, Math.min(60, Math.max(box[3] - box[0], box[5] - box[2])));
    const height = (0.55 * wide) / Math.tan(FIELD_OF_VIEW / 2);
    const ground = box[1];
    this.hand.controls.setLookAt(x, ground + height, z + 1e-3, x, ground, z, false);
    this.hand.controls.enabled = true;
  }

  leave(): void {
    this.hand.controls.enabled = false;
  }

  update(view: Viewpoint, scenery: Scenery): string | null {
    view.fieldOfView = FIELD_OF_VIEW;
    this.hand.move(view, scenery.dt);
    return null;
  }
}

/** How far ahead the point lies round which a free camera turns: what is selected, else the middle of the scene. */
function distanceAhead(view: Viewpoint, scenery: Scenery): number {
  const subject = subjectOf(scenery, scenery.selected);
  if (subject) return Math.max(0.1, subject.position.distanceTo(view.position));
  const box = scenery.stage.layout?.bounds;
  if (!box) return 5;
  const middle = new THREE.Vector3((box[0] + box[3]) / 2, (box[1] + box[4]) / 2, (box[2] + box[5]) / 2);
  return Math.min(12, Math.max(2, middle.distanceTo(view.position)));
}
