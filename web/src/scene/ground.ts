import type { BatchLayout, MeshMessage } from "../messages/types";
import type { Batch } from "./batch";

/** Points along each side of the map. */
const POINTS = 192;
/** Reach from which the ground is one, metres. */
const LEAST = 3;
/** Largest share of the area of a ground that faces down, and least that is seen from above. */
const DOWN = 0.2;
const UP = 0.2;
/** By how much triangles overlap, so that no point falls between two. */
const EDGE = 1e-3;

/** Places of corners and the triangles between them. */
type Mesh = Pick<MeshMessage, "positions" | "triangles">;

/** How high the ground is, of however many tiles: a map of points between which it slopes evenly. */
export class Ground {
  private readonly heights = new Float32Array(POINTS * POINTS).fill(-Infinity);
  private origin = [0, 0];
  private spacing = [1, 1];
  private measured: Mesh[] = [];

  /** Measures all that was built where it stands, in metres of the world, and is not alive. */
  measure(batches: Iterable<Batch>): void {
    const tiles = [...batches].filter(
      ({ layout, asset }) => isBuiltInPlace(layout) && facesUp(asset.message),
    );
    this.take(tiles.map((batch) => batch.asset.message));
  }

  /** Measures meshes. */
  take(tiles: Mesh[]): void {
    const { measured } = this;
    if (tiles.length === measured.length && tiles.every((one, index) => one === measured[index])) return;
    this.measured = tiles;
    this.heights.fill(-Infinity);
    const bounds = [Infinity, Infinity, -Infinity, -Infinity];
    for (const { positions } of tiles)
      for (let i = 0; i < positions.length; i += 3) {
        bounds[0] = Math.min(bounds[0], positions[i]);
        bounds[1] = Math.min(bounds[1], positions[i + 2]);
        bounds[2] = Math.max(bounds[2], positions[i]);
        bounds[3] = Math.max(bounds[3], positions[i + 2]);
      }
    const size = [bounds[2] - bounds[0], bounds[3] - bounds[1]];
    if (!(Math.max(...size) > LEAST && Math.min(...size) > 0)) return;
    this.origin = [bounds[0], bounds[1]];
    this.spacing = size.map((side) => side / (POINTS - 1));
    for (const tile of tiles) this.raise(tile);
  }

  /** Height of the ground in metres, −∞ where there is none. */
  heightAt(x: number, z: number): number {
    const across = (x - this.origin[0]) / this.spacing[0];
    const along = (z - this.origin[1]) / this.spacing[1];
    if (!(across >= 0 && along >= 0 && across <= POINTS - 1 && along <= POINTS - 1)) return -Infinity;
    const column = Math.min(POINTS - 2, Math.floor(across));
    const row = Math.min(POINTS - 2, Math.floor(along));
    const [u, v] = [across - column, along - row];
    const corner = row * POINTS + column;
    const [near, far] = [corner, corner + POINTS].map((at) =>
      between(this.heights[at], this.heights[at + 1], u),
    );
    return between(near, far, v);
  }

  /** Raises the points under a mesh to its height. */
  private raise({ positions, triangles }: Mesh): void {
    const at = (corner: number) => [
      (positions[3 * corner] - this.origin[0]) / this.spacing[0],
      positions[3 * corner + 1],
      (positions[3 * corner + 2] - this.origin[1]) / this.spacing[1],
    ];
    for (let i = 0; i < triangles.length; i += 3)
      this.raiseUnder(at(triangles[i]), at(triangles[i + 1]), at(triangles[i + 2]));
  }

  /** Raises the points under a triangle, whose x and z count in points of the map. */
  private raiseUnder(a: number[], b: number[], c: number[]): void {
    const area = (b[0] - a[0]) * (c[2] - a[2]) - (c[0] - a[0]) * (b[2] - a[2]);
    if (area === 0) return;
    const first = (axis: number) => Math.max(0, Math.ceil(Math.min(a[axis], b[axis], c[axis]) - EDGE));
    const last = (axis: number) =>
      Math.min(POINTS - 1, Math.floor(Math.max(a[axis], b[axis], c[axis]) + EDGE));
    for (let row = first(2); row <= last(2); row++)
      for (let column = first(0); column <= last(0); column++) {
        const shareB = ((column - a[0]) * (c[2] - a[2]) - (c[0] - a[0]) * (row - a[2])) / area;
        const shareC = ((b[0] - a[0]) * (row - a[2]) - (column - a[0]) * (b[2] - a[2])) / area;
        if (Math.min(shareB, shareC, 1 - shareB - shareC) < -EDGE) continue;
        const height = a[1] + shareB * (b[1] - a[1]) + shareC * (c[1] - a[1]);
        const point = row * POINTS + column;
        this.heights[point] = Math.max(this.heights[point], height);
      }
  }
}

/** Whether a thing was built where it stands, as the ground is: its corners are places in the world. */
export function isBuiltInPlace({ alive, count, joints, transforms }: BatchLayout): boolean {
  if (alive || count !== 1 || joints > 0) return false;
  const [x, y, z, scale, qx, qy, qz] = transforms;
  return scale === 1 && [x, y, z, qx, qy, qz].every((one) => one === 0);
}

/** Meshes that were looked at, and whether they face up. */
const looked = new WeakMap<Mesh, boolean>();

/** Whether a mesh is a sheet seen from above: no wall, no roof, no body. */
export function facesUp(mesh: Mesh): boolean {
  let answer = looked.get(mesh);
  if (answer !== undefined) return answer;
  const { positions: p, triangles } = mesh;
  let [whole, up, down] = [0, 0, 0];
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i], 3 * triangles[i + 1], 3 * triangles[i + 2]];
    const [bx, by, bz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const [cx, cy, cz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    const y = bz * cx - bx * cz;
    whole += Math.hypot(by * cz - bz * cy, y, bx * cy - by * cx);
    if (y > 0) up += y;
    else down -= y;
  }
  answer = down <= DOWN * whole && up - down > UP * whole;
  looked.set(mesh, answer);
  return answer;
}

/** A height between two; where one is missing, the other. */
function between(one: number, other: number, share: number): number {
  if (one === -Infinity || other === -Infinity) return Math.max(one, other);
  return one + (other - one) * share;
}
