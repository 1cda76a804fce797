import type { Box, MeshMessage } from "./types";

/** The arrays of a mesh as they travel, in few bits; `unfoldMesh` makes a `MeshMessage` of it. */
export interface PackedMesh {
  box: Box;
  /** 0 to 65535 across the box. */
  positions: Uint16Array;
  /** × 32767. */
  normals: Int16Array;
  /** The greatest part of a color. */
  brightest: number;
  /** 0 to 65535 of it. */
  colors?: Uint16Array;
  triangles?: Uint32Array;
  /** In place of `triangles` where there are few vertices. */
  short_triangles?: Uint16Array;
  /** Four per vertex, sum about 255. */
  joint_weights?: Uint8Array;
}

/** Turns the arrays into floats as they are drawn with, in place. */
export function unfoldMesh(packed: PackedMesh): void {
  const mesh = packed as unknown as MeshMessage;
  const { box, positions, normals, colors, joint_weights: weights } = packed;
  const step = [0, 1, 2].map((axis) => (box[axis + 3] - box[axis]) / 65535);
  mesh.positions = Float32Array.from(positions, (number, at) => box[at % 3] + number * step[at % 3]);
  mesh.normals = Float32Array.from(normals, (number) => number / 32767);
  const shade = packed.brightest / 65535;
  if (colors) mesh.colors = Float32Array.from(colors, (number) => number * shade);
  mesh.triangles = packed.triangles ?? Uint32Array.from(packed.short_triangles ?? []);
  if (weights) mesh.joint_weights = unitWeights(weights);
}

function unitWeights(weights: Uint8Array): Float32Array {
  const result = new Float32Array(weights.length);
  for (let i = 0; i < weights.length; i += 4) {
    const sum = weights[i] + weights[i + 1] + weights[i + 2] + weights[i + 3] || 1;
    for (let k = i; k < i + 4; k++) result[k] = weights[k] / sum;
  }
  return result;
}
