import { Matrix4, Quaternion, Vector3 } from "three";
import type { Rig } from "../messages/types";
import type { CameraMode, Scenery, Viewpoint } from "./viewpoint";

/** Time constants in seconds with which a following camera moves and turns. */
const FOLLOW_LAG = 0.9;
const AIM_LAG = 0.35;
/** Sway of a fixed camera, metres: as of one who floats. */
const SWAY = 0.015;

const UP = new Vector3(0, 1, 0);
const matrix = new Matrix4();

/** Rotation of a camera at `position` that looks at `target`. */
export function facing(position: Vector3, target: Vector3): Quaternion {
  return new Quaternion().setFromRotationMatrix(matrix.lookAt(position, target, UP));
}

/** Share of the way to go in `dt` seconds with this time constant. */
export function relaxation(dt: number, lag: number): number {
  return 1 - Math.exp(-dt / lag);
}

/** Where a fixed or orbiting rig stands and what it looks at. */
export function standing(rig: Rig, time: number): { position: Vector3; target: Vector3 } {
  const target = new Vector3(...(rig.target ?? [0, 0, 0]));
  if (rig.kind === "fixed") {
    const sway = new Vector3(Math.sin(time * 0.53), Math.sin(time * 0.41 + 1), 0).multiplyScalar(SWAY);
    return { position: new Vector3(...(rig.position ?? [0, 0, 0])).add(sway), target };
  }
  const angle = (time / (rig.period || 1)) * 2 * Math.PI;
  const radius = rig.radius ?? 1;
  const around = new Vector3(Math.sin(angle) * radius, rig.height ?? 0, Math.cos(angle) * radius);
  return { position: around.add(target), target };
}

/** The world's own rig: fixed, orbiting or following; moves as in the engine's rig.rs. */
export class RigCamera implements CameraMode {
  readonly name: string;
  private fresh = true;
  private before = 0;

  constructor(private readonly rig: Rig) {
    this.name = rig.name;
  }

  enter(): void {
    this.fresh = true;
  }

  leave(): void {}

  update(view: Viewpoint, scenery: Scenery): string | null {
    view.fieldOfView = this.rig.field_of_view;
    if (this.rig.kind === "follow") return this.follow(view, scenery);
    const { position, target } = standing(this.rig, scenery.time);
    view.position.copy(position);
    view.rotation.copy(facing(position, target));
    return null;
  }

  private follow(view: Viewpoint, scenery: Scenery): string | null {
    const subject = findIndividual(scenery, this.rig.species ?? "", this.rig.index ?? 0);
    if (!subject) return `there is no ${this.rig.species} to follow`;
    const ahead = new Vector3(0, 0, 1).applyQuaternion(subject.rotation);
    const level = new Quaternion().setFromAxisAngle(UP, Math.atan2(ahead.x, ahead.z));
    const offset = new Vector3(...(this.rig.offset ?? [0, 1, -4])).multiplyScalar(subject.length);
    const wanted = offset.applyQuaternion(level).add(subject.position);
    const leap = scenery.time < this.before || scenery.time > this.before + 2;
    this.before = scenery.time;
    if (this.fresh || leap) {
      view.position.copy(wanted);
      view.rotation.copy(facing(wanted, subject.position));
    } else {
      view.position.lerp(wanted, relaxation(scenery.dt, FOLLOW_LAG));
      view.rotation.slerp(facing(view.position, subject.position), relaxation(scenery.dt, AIM_LAG));
    }
    this.fresh = false;
    return null;
  }
}

/** Where an individual is, how it is turned, and how long it is (metres). */
export interface Subject {
  position: Vector3;
  rotation: Quaternion;
  length: number;
  /** From its origin to the tip of its snout along its own +Z, metres. */
  snout: number;
}

/** The individual with this identity; null if it is not in the scene. */
export function subjectOf(scenery: Scenery, id: number): Subject | null {
  const found = scenery.stage.find(id);
  if (!found) return null;
  const place = found.batch.placeOf(found.slot);
  const { box } = found.batch.asset;
  return {
    position: new Vector3(place[0], place[1], place[2]),
    rotation: new Quaternion(place[4], place[5], place[6], place[7]),
    length: (box[5] - box[2]) * place[3],
    snout: box[5] * place[3],
  };
}

function findIndividual(scenery: Scenery, species: string, index: number): Subject | null {
  let left = index;
  for (const { layout } of scenery.stage.batches.values()) {
    if (layout.species !== species) continue;
    if (left < layout.count) return subjectOf(scenery, layout.ids[left]);
    left -= layout.count;
  }
  return null;
}
