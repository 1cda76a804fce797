import type { ContourMesh } from "./mesh";
import { type Feature, type Picture, Potential } from "./picture";

/** Width of the potential at the end, in pixels: the mesh settles on the feature itself. */
export const NARROWEST = 1.5;
/** A mesh that moves less than this per step, in pixels, is at rest. */
const REST = 0.02;
/** Most steps at one width of the potential. */
const PATIENCE = 250;

/** Lets a mesh settle on a picture: first by a wide potential that catches from far away, then by narrower ones. */
export class Relaxation {
  /** Present width of the potential, pixels. */
  width: number;
  /** How far the mesh moved in the last step, pixels. */
  moved = Number.POSITIVE_INFINITY;
  private potential: Potential;
  private steps = 0;

  constructor(
    private readonly picture: Picture,
    private readonly feature: Feature,
    widest: number,
  ) {
    this.width = Math.max(widest, NARROWEST);
    this.potential = new Potential(picture, feature, this.width);
  }

  /** Whether the mesh is at rest at the narrowest potential. */
  get done(): boolean {
    return this.width <= NARROWEST && (this.moved < REST || this.steps >= PATIENCE);
  }

  /** One step of the mesh. */
  step(mesh: ContourMesh): void {
    this.moved = mesh.step(this.potential);
    this.steps += 1;
    if (this.width > NARROWEST && (this.moved < 5 * REST || this.steps >= PATIENCE)) {
      this.width = Math.max(0.6 * this.width, NARROWEST);
      this.potential = new Potential(this.picture, this.feature, this.width);
      this.steps = 0;
    }
  }

  /** Goes on after the mesh was moved by hand. */
  wake(): void {
    this.steps = 0;
    this.moved = Number.POSITIVE_INFINITY;
  }
}
