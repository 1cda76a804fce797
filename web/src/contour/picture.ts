/** The picture under a contour mesh, and the potential by which its features attract contours. */

/** Longest side of a picture in pixels; larger ones are made smaller, for coordinates are shares anyway. */
export const LONGEST_SIDE = 800;

/** A picture as planes of numbers from 0 to 1, row by row from the top. */
export interface Picture {
  width: number;
  height: number;
  /** Red, green and blue weighted with the opacity, and the opacity. */
  planes: Float32Array[];
}

/** What attracts contours: outlines, or thin lines darker or brighter than what is beside them. */
export type Feature = "edges" | "dark lines" | "bright lines";

/** The planes of a picture of 8-bit RGBA pixels. */
export function pictureOf(pixels: Uint8ClampedArray, width: number, height: number): Picture {
  const planes = [0, 1, 2, 3].map(() => new Float32Array(width * height));
  for (let pixel = 0; pixel < width * height; pixel++) {
    const opacity = pixels[4 * pixel + 3] / 255;
    for (let part = 0; part < 3; part++) planes[part][pixel] = (pixels[4 * pixel + part] / 255) * opacity;
    planes[3][pixel] = opacity;
  }
  return { width, height, planes };
}

/** A plane smoothed by a Gaussian of standard deviation `sigma` pixels; the rim is repeated outward. */
export function smoothed(plane: Float32Array, width: number, height: number, sigma: number): Float32Array {
  const reach = Math.ceil(3 * sigma);
  const weights = Float64Array.from({ length: 2 * reach + 1 }, (_, at) =>
    Math.exp(-0.5 * ((at - reach) / sigma) ** 2),
  );
  const total = weights.reduce((sum, one) => sum + one, 0);
  const across = new Float32Array(plane.length);
  const out = new Float32Array(plane.length);
  const pass = (
    from: Float32Array,
    to: Float32Array,
    count: number,
    step: number,
    lines: number,
    next: number,
  ) => {
    for (let line = 0; line < lines; line++) {
      for (let at = 0; at < count; at++) {
        let sum = 0;
        for (let offset = -reach; offset <= reach; offset++) {
          const place = Math.min(Math.max(at + offset, 0), count - 1);
          sum += weights[offset + reach] * from[line * next + place * step];
        }
        to[line * next + at * step] = sum / total;
      }
    }
  };
  pass(plane, across, width, 1, height, width);
  pass(across, out, height, width, width, 1);
  return out;
}

/** Slope of a plane at every pixel by central differences, per pixel. */
function slope(plane: Float32Array, width: number, height: number): [Float32Array, Float32Array] {
  const along = new Float32Array(plane.length);
  const down = new Float32Array(plane.length);
  for (let row = 0; row < height; row++) {
    const above = Math.max(row - 1, 0) * width;
    const below = Math.min(row + 1, height - 1) * width;
    for (let column = 0; column < width; column++) {
      const left = Math.max(column - 1, 0);
      const right = Math.min(column + 1, width - 1);
      along[row * width + column] = 0.5 * (plane[row * width + right] - plane[row * width + left]);
      down[row * width + column] = 0.5 * (plane[below + column] - plane[above + column]);
    }
  }
  return [along, down];
}

/** Strength of the edges of a picture: length of the gradient over all planes. */
export function edges({ width, height, planes }: Picture): Float32Array {
  const squares = new Float32Array(width * height);
  for (const plane of planes) {
    const [along, down] = slope(plane, width, height);
    for (let pixel = 0; pixel < squares.length; pixel++) {
      squares[pixel] += along[pixel] ** 2 + down[pixel] ** 2;
    }
  }
  return squares.map(Math.sqrt);
}

/** Brightness of a picture (Rec. 709 weights). */
function brightness({ planes: [red, green, blue] }: Picture): Float32Array {
  return red.map((one, pixel) => 0.2126 * one + 0.7152 * green[pixel] + 0.0722 * blue[pixel]);
}

/**
 * The force field of a picture: the slope of a potential smoothed by a Gaussian, so that features are felt from
 * further away (D. Terzopoulos, A. Witkin & M. Kass 1988). Edges are maxima of the length of the gradient; dark lines
 * are ravines of the brightness, bright lines its ridges. The strongest force of the field is 1.
 */
export class Potential {
  readonly width: number;
  readonly height: number;
  private readonly along: Float32Array;
  private readonly down: Float32Array;

  constructor(picture: Picture, feature: Feature, sigma: number) {
    this.width = picture.width;
    this.height = picture.height;
    const sharp = feature === "edges" ? edges(picture) : brightness(picture);
    [this.along, this.down] = slope(smoothed(sharp, this.width, this.height, sigma), this.width, this.height);
    let steepest = 1e-9;
    for (let pixel = 0; pixel < this.along.length; pixel++) {
      steepest = Math.max(steepest, Math.hypot(this.along[pixel], this.down[pixel]));
    }
    const scale = (feature === "dark lines" ? -1 : 1) / steepest;
    for (let pixel = 0; pixel < this.along.length; pixel++) {
      this.along[pixel] *= scale;
      this.down[pixel] *= scale;
    }
  }

  /** The force at a point in pixels, between the four pixels round it. */
  force(x: number, y: number): [number, number] {
    const left = Math.min(Math.max(x - 0.5, 0), this.width - 1.001);
    const top = Math.min(Math.max(y - 0.5, 0), this.height - 1.001);
    const [column, row] = [Math.floor(Math.max(left, 0)), Math.floor(Math.max(top, 0))];
    const [u, v] = [Math.max(left, 0) - column, Math.max(top, 0) - row];
    const first = row * this.width + column;
    const right = column + 1 < this.width ? 1 : 0;
    const below = row + 1 < this.height ? this.width : 0;
    const between = (part: Float32Array): number =>
      (1 - v) * ((1 - u) * part[first] + u * part[first + right]) +
      v * ((1 - u) * part[first + below] + u * part[first + below + right]);
    return [between(this.along), between(this.down)];
  }
}

/** Edges weaker than this share of the strongest are the ground's: gradients, noise, the picture's compression. */
const FAINT = 0.15;

/** The box, as left, top, right, bottom in pixels, that holds all but 0.2 % of the clear edges on each side. */
export function contentBox(picture: Picture): [number, number, number, number] {
  const { width, height } = picture;
  const strengths = edges(picture);
  const columns = new Float64Array(width);
  const rows = new Float64Array(height);
  const faint = FAINT * strengths.reduce((most, one) => Math.max(most, one), 0);
  strengths.forEach((one, pixel) => {
    if (one < faint) return;
    columns[pixel % width] += one;
    rows[Math.floor(pixel / width)] += one;
  });
  const ends = (sums: Float64Array): [number, number] => {
    const total = sums.reduce((sum, one) => sum + one, 0);
    if (total <= 0) return [0.1 * sums.length, 0.9 * sums.length];
    let [before, low, high] = [0, 0, sums.length];
    sums.forEach((one, at) => {
      if (before <= 0.002 * total) low = at;
      if (before < 0.998 * total) high = at + 1;
      before += one;
    });
    return high - low < 2 ? [0.1 * sums.length, 0.9 * sums.length] : [low, high];
  };
  const [left, right] = ends(columns);
  const [top, bottom] = ends(rows);
  return [left, top, right, bottom];
}
