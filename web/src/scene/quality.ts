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
  /** Share of their size on the screen by which coarser meshes are chosen. */
  detail: number;
  /** Whether things move between the frames of the world. */
  smooth: boolean;
}

/** From the finest to the cheapest. */
export const QUALITIES: Quality[] = [
  {
    name: "fine",
    pixelRatio: 2,
    samples: 4,
    shadowMap: 2048,
    shafts: true,
    halo: true,
    detail: 1,
    smooth: true,
  },
  {
    name: "medium",
    pixelRatio: 1,
    samples: 4,
    shadowMap: 1024,
    shafts: true,
    halo: true,
    detail: 1,
    smooth: true,
  },
  {
    name: "light",
    pixelRatio: 1,
    samples: 0,
    shadowMap: 1024,
    shafts: true,
    halo: false,
    detail: 0.8,
    smooth: true,
  },
  {
    name: "plain",
    pixelRatio: 0.7,
    samples: 0,
    shadowMap: 512,
    shafts: false,
    halo: false,
    detail: 0.5,
    smooth: true,
  },
  {
    name: "coarse",
    pixelRatio: 0.45,
    samples: 0,
    shadowMap: 0,
    shafts: false,
    halo: false,
    detail: 0.35,
    smooth: false,
  },
];

/** A picture that takes longer than this (milliseconds) is too slow. */
const TOO_SLOW = 42;
/** Pictures, or milliseconds, looked at before a decision. */
const PICTURES = 24;
const LONGEST_LOOK = 2500;
/** Where to begin when a processor has to stand in for a graphics processor. */
const WITHOUT_GRAPHICS = 3;

/** Steps down to a cheaper quality while pictures come too slowly. */
export class QualityGovernor {
  level: number;
  private sum = 0;
  private count = 0;

  /** `software`: pictures are computed without a graphics processor. */
  constructor(software: boolean) {
    this.level = software ? WITHOUT_GRAPHICS : 0;
  }

  /** The time since the last picture; says whether the quality has changed. */
  note(milliseconds: number): boolean {
    this.sum += milliseconds;
    if (++this.count < PICTURES && this.sum < LONGEST_LOOK) return false;
    const mean = this.sum / this.count;
    this.sum = this.count = 0;
    if (mean <= TOO_SLOW || this.level === QUALITIES.length - 1) return false;
    this.level += 1;
    return true;
  }
}
