import { Quaternion, Vector3 } from "three";
import { relaxation, subjectOf } from "./rig";
import type { CameraMode, Scenery, Viewpoint } from "./viewpoint";

/** Vertical angle of view, radians. */
const FIELD_OF_VIEW = 1.5;
/** Time constant in seconds that takes the tremble out of the head. */
const LAG = 0.08;
/** From an animal's +Z ahead to a camera's −Z ahead. */
const TURNED = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), Math.PI);

/** Looks through the eyes of the selected animal. */
export class EyeCamera implements CameraMode {
  readonly name = "eye";
  private subject = 0;

  enter(): void {
    this.subject = 0;
  }

  leave(): void {}

  update(view: Viewpoint, scenery: Scenery): string | null {
    const subject = subjectOf(scenery, scenery.selected);
    if (!subject) return "select an animal to look through its eyes";
    const ahead = new Vector3(0, 0, 0.85 * subject.snout).applyQuaternion(subject.rotation);
    const rotation = subject.rotation.clone().multiply(TURNED);
    view.position.copy(subject.position).add(ahead);
    if (this.subject === scenery.selected) view.rotation.slerp(rotation, relaxation(scenery.dt, LAG));
    else view.rotation.copy(rotation);
    view.fieldOfView = FIELD_OF_VIEW;
    this.subject = scenery.selected;
    return null;
  }
}
