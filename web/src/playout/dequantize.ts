import type { BatchLayout, Box, Moving } from "../messages/types";

/** Where everything of one batch is at one moment; the arrays may be longer than needed. */
export interface Placement {
  /** x, y, z, scale and quaternion x, y, z, w per instance. */
  places: Float32Array;
  /** Per instance and joint x, y, z, 0 and a quaternion: the joint's pose times its inverse rest, in mesh space. */
  poses: Float32Array;
}

/** Writes the places that the layout gives. */
export function placeAsLaidOut(places: Float32Array, batch: BatchLayout): void {
  places.set(batch.transforms);
}

/** Writes joints at rest. */
export function poseAtRest(poses: Float32Array): void {
  poses.fill(0);
  for (let i = 7; i < poses.length; i += 8) poses[i] = 1;
}

/** Writes positions, rotations and scales that a frame says have changed over places as laid out. */
export function placeAsMoved(places: Float32Array, moving: Moving): void {
  if (moving.positions && moving.box) placePositions(places, moving.positions, moving.box);
  if (moving.scales && moving.size) placeScales(places, moving.scales, moving.size);
  const { rotations } = moving;
  if (!rotations) return;
  const count = Math.min(places.length / 8, rotations.length / 4);
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < 4; k++) places[8 * i + 4 + k] = rotations[4 * i + k] / 32767;
  }
}

function placeScales(places: Float32Array, scales: Uint16Array, [least, greatest]: [number, number]): void {
  const count = Math.min(places.length / 8, scales.length);
  const step = (greatest - least) / 65535;
  for (let i = 0; i < count; i++) places[8 * i + 3] = least + scales[i] * step;
}

function placePositions(places: Float32Array, positions: Uint16Array, box: Box): void {
  const count = Math.min(places.length / 8, positions.length / 3);
  for (let axis = 0; axis < 3; axis++) {
    const low = box[axis];
    const step = (box[axis + 3] - low) / 65535;
    for (let i = 0; i < count; i++) places[8 * i + axis] = low + positions[3 * i + axis] * step;
  }
}

/** Writes poses times inverse rest; `rest` has eight numbers per joint. */
export function poseAsMoved(
  target: Float32Array,
  poses: Int16Array,
  extent: number,
  rest: Float32Array,
): void {
  const joints = rest.length / 8;
  const count = Math.min(target.length / 8, poses.length / 7);
  const step = extent / 32767;
  for (let i = 0; i < count; i++) {
    const p = 7 * i;
    const r = 8 * (i % joints);
    const [qx, qy, qz, qw] = [poses[p + 3], poses[p + 4], poses[p + 5], poses[p + 6]];
    const size = 1 / Math.hypot(qx, qy, qz, qw) || 0;
    const [rx, ry, rz, rw] = [-rest[r + 4], -rest[r + 5], -rest[r + 6], rest[r + 7]];
    const x = (qw * rx + qx * rw + qy * rz - qz * ry) * size;
    const y = (qw * ry - qx * rz + qy * rw + qz * rx) * size;
    const z = (qw * rz + qx * ry - qy * rx + qz * rw) * size;
    const w = (qw * rw - qx * rx - qy * ry - qz * rz) * size;
    const [ax, ay, az] = [rest[r], rest[r + 1], rest[r + 2]];
    const tx = 2 * (y * az - z * ay);
    const ty = 2 * (z * ax - x * az);
    const tz = 2 * (x * ay - y * ax);
    const o = 8 * i;
    target[o] = poses[p] * step - (ax + w * tx + y * tz - z * ty);
    target[o + 1] = poses[p + 1] * step - (ay + w * ty + z * tx - x * tz);
    target[o + 2] = poses[p + 2] * step - (az + w * tz + x * ty - y * tx);
    target[o + 3] = 0;
    target[o + 4] = x;
    target[o + 5] = y;
    target[o + 6] = z;
    target[o + 7] = w;
  }
}

/** Takes over where the same individuals were in another layout; those who are new keep their place. */
export function carryOver(
  to: Placement,
  ids: Uint32Array,
  from: Placement,
  fromIds: Uint32Array,
  joints: number,
): void {
  const slots = slotsOf(fromIds);
  const used = new Map<number, number>();
  const width = 8 * joints;
  ids.forEach((id, slot) => {
    // A plant has many leaves: the first stays the first, and so on.
    const nth = used.get(id) ?? 0;
    used.set(id, nth + 1);
    const old = slots.get(id)?.[nth];
    if (old === undefined) return;
    to.places.set(from.places.subarray(8 * old, 8 * old + 8), 8 * slot);
    if (width > 0) to.poses.set(from.poses.subarray(width * old, width * (old + 1)), width * slot);
  });
}

function slotsOf(ids: Uint32Array): Map<number, number[]> {
  const slots = new Map<number, number[]>();
  ids.forEach((id, slot) => {
    const own = slots.get(id);
    if (own) own.push(slot);
    else slots.set(id, [slot]);
  });
  return slots;
}

/** Place of one instance between two moments: x, y, z, scale and a unit quaternion, written to `target`. */
export function placeBetween(
  target: Float32Array,
  older: Float32Array,
  newer: Float32Array,
  slot: number,
  blend: number,
): void {
  const start = 8 * slot;
  let dot = 0;
  for (let k = 4; k < 8; k++) dot += older[start + k] * newer[start + k];
  const sign = dot < 0 ? -1 : 1;
  for (let k = 0; k < 4; k++) target[k] = older[start + k] + blend * (newer[start + k] - older[start + k]);
  for (let k = 4; k < 8; k++) target[k] = sign * older[start + k] * (1 - blend) + newer[start + k] * blend;
  const size = Math.hypot(target[4], target[5], target[6], target[7]) || 1;
  for (let k = 4; k < 8; k++) target[k] /= size;
}
