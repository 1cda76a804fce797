import {
  AddEquation,
  BufferAttribute,
  BufferGeometry,
  CustomBlending,
  DoubleSide,
  GLSL3,
  HalfFloatType,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  OneFactor,
  OrthographicCamera,
  RedFormat,
  RepeatWrapping,
  ShaderMaterial,
  type Texture,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { WAVES } from "./shaders/waves";

/** Overhang of the sheet of light on each side of the tile. */
const OVERHANG = 0.1;

const VERTEX = /* glsl */ `
${WAVES}
uniform float uMoment;
const float THROW = 0.13; // tiles per unit of slope, as in the engine's waves.rs
out vec2 vEntry;
out vec2 vLanding;
void main() {
  vEntry = position.xy;
  vLanding = vEntry + tileSlope(vEntry, uMoment) * THROW;
  gl_Position = vec4(vLanding * 2.0 - 1.0, 0.0, 1.0);
}
`;

/** A light sheet's brightness is the area it entered through over the area it lands on. */
const FRAGMENT = /* glsl */ `
in vec2 vEntry;
in vec2 vLanding;
layout(location = 0) out vec4 outColor;
float areaOf(vec2 a, vec2 b) {
  return abs(a.x * b.y - a.y * b.x);
}
void main() {
  float entered = areaOf(dFdx(vEntry), dFdy(vEntry));
  float landed = areaOf(dFdx(vLanding), dFdy(vLanding));
  outColor = vec4(min(entered / max(landed, 1e-9), 14.0));
}
`;

/** The bright net that waves throw on the ground: a tile that repeats, drawn anew as the waves move; its mean is 1. */
export class Caustics {
  private readonly target: WebGLRenderTarget;
  private readonly sheet: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);

  /** Texels along one side of the tile; the sheet has half as many quads. */
  constructor(size: number) {
    this.target = new WebGLRenderTarget(size, size, {
      type: HalfFloatType,
      format: RedFormat,
      wrapS: RepeatWrapping,
      wrapT: RepeatWrapping,
      minFilter: LinearMipmapLinearFilter,
      magFilter: LinearFilter,
      generateMipmaps: true,
      depthBuffer: false,
    });
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { uMoment: { value: 0 } },
      depthTest: false,
      depthWrite: false,
      side: DoubleSide, // folds of the sheet light up too
      transparent: true,
      blending: CustomBlending,
      blendEquation: AddEquation,
      blendSrc: OneFactor,
      blendDst: OneFactor,
    });
    this.sheet = new Mesh(sheetGeometry(size / 2), material);
    this.sheet.frustumCulled = false;
  }

  get texture(): Texture {
    return this.target.texture;
  }

  render(renderer: WebGLRenderer, time: number): void {
    this.sheet.material.uniforms.uMoment.value = time;
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(this.sheet, this.camera);
  }

  dispose(): void {
    this.target.dispose();
    this.sheet.geometry.dispose();
    this.sheet.material.dispose();
  }
}

/** A grid over the tile and a little more on each side, so that light that crosses the border is not missed. */
function sheetGeometry(quads: number): BufferGeometry {
  const side = quads + 1;
  const positions = new Float32Array(3 * side * side);
  const index: number[] = [];
  for (let row = 0; row < side; row++) {
    for (let column = 0; column < side; column++) {
      const at = row * side + column;
      positions[3 * at] = -OVERHANG + (column / quads) * (1 + 2 * OVERHANG);
      positions[3 * at + 1] = -OVERHANG + (row / quads) * (1 + 2 * OVERHANG);
      if (row < quads && column < quads) index.push(at, at + 1, at + side, at + 1, at + side + 1, at + side);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setIndex(index);
  return geometry;
}
