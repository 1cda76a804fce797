/** How much is spent on a picture. */
export interface Quality {
  name: string;
  /** Pixels of the picture per pixel of the screen at most. */
  pixelRatio: number;
  /** Samples per pixel at edges. */
  samples: number;
  /** Side of the shadow map in texels, 0 for none. */
  shadowMap: number;
  shafts: boolean;
  halo: boolean;
}

/** From the finest to the cheapest. */
export const QUALITIES: Quality[] = [
  { name: "fine", pixelRatio: 2, samples: 4, shadowMap: 2048, shafts: true, halo: true },
  { name: "medium", pixelRatio: 1, samples: 4, shadowMap: 1024, shafts: true, halo: true },
  { name: "light", pixelRatio: 1, samples: 0, shadowMap: 1024, shafts: true, halo: false },
  { name: "plain", pixelRatio: 0.7, samples: 0, shadowMap: 512, shafts: false, halo: false },
  { name: "coarse", pixelRatio: 0.5, samples: 0, shadowMap: 0, shafts: false, halo: false },
];

/** A picture that takes longer than this (milliseconds) is too slow. */
const TOO_SLOW = 42;
/** Pictures looked at before a decision. */
const WINDOW = 24;
/** A gap between pictures longer than this (milliseconds) is a pause, not slowness. */
const PAUSE = 1500;

/** Steps down to a cheaper quality while pictures come too slowly. */
export class QualityGovernor {
  level = 0;
  private sum = 0;
  private count = 0;

  /** The time since the last picture; says whether the quality has changed. */
  note(milliseconds: number): boolean {
    if (milliseconds > PAUSE) return false;
    this.sum += milliseconds;
    if (++this.count < WINDOW) return false;
    const mean = this.sum / this.count;
    this.sum = this.count = 0;
    if (mean <= TOO_SLOW || this.level === QUALITIES.length - 1) return false;
    this.level += 1;
    return true;
  }
}
