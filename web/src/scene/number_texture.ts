import { DataTexture, FloatType, NearestFilter, RGBAFormat } from "three";

/** Texels per row of a store of numbers. */
const WIDTH = 1024;

/** Four numbers per texel for a vertex shader to fetch, row after row; `data` may be written and sent again. */
export class NumberTexture {
  readonly texture: DataTexture;
  readonly data: Float32Array;

  /** Room for `count` times four numbers. */
  constructor(count: number) {
    const width = Math.min(WIDTH, Math.max(1, count));
    const height = Math.max(1, Math.ceil(count / width));
    this.data = new Float32Array(4 * width * height);
    this.texture = new DataTexture(this.data, width, height, RGBAFormat, FloatType);
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    this.texture.generateMipmaps = false;
    this.texture.needsUpdate = true;
  }

  /** Sends the numbers to the graphics processor before they are next drawn with. */
  send(): void {
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}
