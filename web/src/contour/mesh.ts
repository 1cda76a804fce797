/**
 * A mesh of deformable contours: X. Tu, Artificial Animals for Computer Animation (LNCS 1635), appendix A, after
 * M. Kass, A. Witkin & D. Terzopoulos, "Snakes: active contour models", 1988.
 */

import { factor, solve } from "./cholesky";
import type { Potential } from "./picture";

/** A point in pixels, y downward. */
export type Point = [number, number];

/** Strengths of the forces, for viscosity 1. */
export interface Strengths {
  /** Of the springs between neighbors on a contour, per pixel. */
  tension: number;
  /** Of a contour's resistance to bending, per pixel. */
  rigidity: number;
  /** Of the picture where it pulls hardest. */
  picture: number;
  /** Of the spring between the cursor and the node that it holds, per pixel. */
  cursor: number;
  /** Of the springs between nodes and their anchors, per pixel. */
  anchor: number;
}

export const STRENGTHS: Strengths = { tension: 0.15, rigidity: 0.15, picture: 4, cursor: 8, anchor: 20 };

/** Time of a step, for viscosity 1: at the narrowest potential the border then settles without swinging. */
const STEP = 0.3;
/** Greatest numbers of nodes down and across. */
export const MOST = [32, 64];

/**
 * Nodes where `columns` upright contours cross `rows` lengthwise ones. The picture pulls at the border; within it, the
 * contours even themselves out. (Inner edges, as of stripes, would tear the mesh; so they are not felt.)
 */
export class ContourMesh {
  /** x and y of every node in pixels, row by row. */
  readonly positions: Float64Array;
  /** Where nodes are anchored. */
  readonly anchors = new Map<number, Point>();
  private grip: { node: number; point: Point } | undefined;
  private readonly contours: number[][];
  private lower: Float64Array | undefined;
  private forces = STRENGTHS;

  constructor(
    readonly rows: number,
    readonly columns: number,
  ) {
    if (!(rows >= 2 && rows <= MOST[0] && columns >= 2 && columns <= MOST[1])) {
      throw new RangeError(`a mesh of ${rows} × ${columns}: expected 2 × 2 to ${MOST[0]} × ${MOST[1]}`);
    }
    this.positions = new Float64Array(2 * rows * columns);
    const count = (length: number) => [...Array(length).keys()];
    this.contours = [
      ...count(rows).map((row) => count(columns).map((column) => this.node(row, column))),
      ...count(columns).map((column) => count(rows).map((row) => this.node(row, column))),
    ];
  }

  /** Number of the node at a crossing. */
  node(row: number, column: number): number {
    return row * this.columns + column;
  }

  /** Whether a node is on the border. */
  isBorder(node: number): boolean {
    const [row, column] = [Math.floor(node / this.columns), node % this.columns];
    return row === 0 || column === 0 || row === this.rows - 1 || column === this.columns - 1;
  }

  /** Where a node is. */
  point(node: number): Point {
    return [this.positions[2 * node], this.positions[2 * node + 1]];
  }

  /**
   * Lays the mesh out evenly over a box, given as left, top, right, bottom, or over the oval in it (by the elliptical
   * grid map of the square to the disk); anchors and grip are gone.
   */
  lay([left, top, right, bottom]: [number, number, number, number], shape: "box" | "oval" = "box"): void {
    this.anchors.clear();
    this.grip = this.lower = undefined;
    const [middleX, middleY] = [0.5 * (left + right), 0.5 * (top + bottom)];
    for (let node = 0; node < this.rows * this.columns; node++) {
      const [row, column] = [Math.floor(node / this.columns), node % this.columns];
      const [u, v] = [(2 * column) / (this.columns - 1) - 1, (2 * row) / (this.rows - 1) - 1];
      const [across, down] =
        shape === "oval" ? [u * Math.sqrt(1 - 0.5 * v * v), v * Math.sqrt(1 - 0.5 * u * u)] : [u, v];
      this.positions[2 * node] = middleX + 0.5 * (right - left) * across;
      this.positions[2 * node + 1] = middleY + 0.5 * (bottom - top) * down;
    }
  }

  /** Sets the strengths of the forces. */
  set strengths(strengths: Strengths) {
    this.forces = strengths;
    this.lower = undefined;
  }

  /** Ties a node to a point by the cursor's spring. */
  hold(node: number, point: Point): void {
    if (this.grip?.node !== node) this.lower = undefined;
    this.grip = { node, point };
  }

  /** Lets go of the node that is held. */
  release(): void {
    this.grip = this.lower = undefined;
  }

  /** Anchors a node where it should stay, or frees it. */
  anchor(node: number, point: Point | undefined): void {
    if (point) this.anchors.set(node, point);
    else this.anchors.delete(node);
    this.lower = undefined;
  }

  /** Sizes the whole mesh about a point, and moves it; anchors stay. */
  transform(factor: number, [x, y]: Point, [right, down]: Point): void {
    for (let at = 0; at < this.positions.length; at += 2) {
      this.positions[at] = x + factor * (this.positions[at] - x) + right;
      this.positions[at + 1] = y + factor * (this.positions[at + 1] - y) + down;
    }
  }

  /** Shifts a node by hand; its neighbors follow the less the further away they are. */
  shift(node: number, [x, y]: Point): void {
    const [row, column] = [Math.floor(node / this.columns), node % this.columns];
    for (let other = 0; other < this.rows * this.columns; other++) {
      const far = Math.hypot(Math.floor(other / this.columns) - row, (other % this.columns) - column);
      const share = Math.exp(-0.5 * (far / 1.6) ** 2);
      this.positions[2 * other] += share * x;
      this.positions[2 * other + 1] += share * y;
    }
  }

  /**
   * One step of γ dx/dt = forces, all springs implicit: stable for any strengths. Nodes stay within the picture.
   * Returns how far the node that moved furthest has moved, in pixels.
   */
  step(potential: Potential): number {
    const count = this.rows * this.columns;
    this.lower ??= factor(this.matrix(), count, 2 * this.columns);
    const sides = [new Float64Array(count), new Float64Array(count)];
    for (let node = 0; node < count; node++) {
      const point = this.point(node);
      const pull = this.isBorder(node) ? potential.force(...point) : [0, 0];
      for (const axis of [0, 1]) {
        sides[axis][node] = point[axis] / STEP + this.forces.picture * pull[axis];
        sides[axis][node] += this.forces.anchor * (this.anchors.get(node)?.[axis] ?? 0);
      }
    }
    if (this.grip) {
      const { node, point } = this.grip;
      for (const axis of [0, 1]) sides[axis][node] += this.forces.cursor * point[axis];
    }
    for (const contour of this.contours) this.addRest(contour, sides);
    for (const side of sides) solve(this.lower, count, 2 * this.columns, side);
    let furthest = 0;
    for (let node = 0; node < count; node++) {
      const x = Math.min(Math.max(sides[0][node], 0), potential.width);
      const y = Math.min(Math.max(sides[1][node], 0), potential.height);
      const [fromX, fromY] = this.point(node);
      furthest = Math.max(furthest, Math.hypot(x - fromX, y - fromY));
      this.positions[2 * node] = x;
      this.positions[2 * node + 1] = y;
    }
    return furthest;
  }

  /**
   * The part of the springs' forces that stems from their rest lengths. A spring's rest length is the mean of its
   * contour's present lengths (our choice): so tension evens out the nodes without shrinking the outline.
   */
  private addRest(contour: number[], [horizontal, vertical]: Float64Array[]): void {
    const steps = contour.slice(1).map((node, index): Point => {
      const [from, to] = [this.point(contour[index]), this.point(node)];
      return [to[0] - from[0], to[1] - from[1]];
    });
    const mean = steps.reduce((sum, step) => sum + Math.hypot(...step), 0) / steps.length;
    steps.forEach((step, index) => {
      const pull = (this.forces.tension * mean) / Math.max(Math.hypot(...step), 1e-6);
      const [from, to] = [contour[index], contour[index + 1]];
      horizontal[from] -= pull * step[0];
      horizontal[to] += pull * step[0];
      vertical[from] -= pull * step[1];
      vertical[to] += pull * step[1];
    });
  }

  /** The matrix of the implicit step: viscosity, springs, rigidity, anchors, cursor. */
  private matrix(): Float64Array {
    const count = this.rows * this.columns;
    const matrix = new Float64Array(count * count);
    const addSquare = (nodes: number[], weights: number[], strength: number) => {
      for (const [i, row] of nodes.entries()) {
        for (const [j, column] of nodes.entries()) {
          matrix[row * count + column] += strength * weights[i] * weights[j];
        }
      }
    };
    for (let node = 0; node < count; node++) {
      matrix[node * (count + 1)] = 1 / STEP + (this.anchors.has(node) ? this.forces.anchor : 0);
    }
    if (this.grip) matrix[this.grip.node * (count + 1)] += this.forces.cursor;
    for (const contour of this.contours) {
      for (let at = 1; at < contour.length; at++) {
        addSquare(contour.slice(at - 1, at + 1), [1, -1], this.forces.tension);
        if (at > 1) addSquare(contour.slice(at - 2, at + 1), [1, -2, 1], this.forces.rigidity);
      }
    }
    return matrix;
  }
}
