import {
  HalfFloatType,
  LinearFilter,
  Matrix4,
  type PerspectiveCamera,
  type Texture,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { Pass } from "./fullscreen";
import { LIGHT } from "./shaders/light";
import { MEDIUM } from "./shaders/medium";
import type { SharedUniforms } from "./shared_uniforms";

/** The picture of the shafts is smaller than the picture by this factor. */
const SHRINK = 4;

const FRAGMENT = /* glsl */ `
${MEDIUM}
${LIGHT}
uniform highp sampler2D uDepth;
uniform mat4 uClipToWorld;
uniform vec3 uEye;
uniform float uShafts;
uniform float uReach;

float beamAt(vec3 place) {
  vec2 entry = (place.xz + uSunBelow.xz * ((uSurface - place.y) / uSunBelow.y)) / uTileSize;
  float broad = textureLod(uCausticTile, entry * 0.31, 4.0).r;
  float fine = textureLod(uCausticTile, entry.yx * 0.77 + 0.21, 3.4).r;
  return pow(max(0.0, broad * 0.65 + fine * 0.35 - 0.55), 1.6) * 2.2;
}

float openAt(vec3 place) {
  if (!uShadows) return 1.0;
  vec3 at = shadowPlace(place);
  if (any(greaterThan(abs(at - 0.5), vec3(0.49)))) return 1.0;
  return texture(uShadowMap, at);
}

void main() {
  outColor = vec4(0.0);
  if (!uWater || uShafts <= 0.0 || uEye.y > uSurface) return;
  vec4 end = uClipToWorld * vec4(vAt * 2.0 - 1.0, texture(uDepth, vAt).r * 2.0 - 1.0, 1.0);
  vec3 path = end.xyz / end.w - uEye;
  float len = length(path);
  vec3 direction = path / max(len, 1e-4);
  len = min(len, uReach);
  if (direction.y > 1e-3) len = min(len, (uSurface - uEye.y) / direction.y);
  float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  float cosine = dot(direction, uSunBelow);
  float phase = 0.25 + 0.75 * pow(max(0.0, cosine), 3.0);
  vec3 gathered = vec3(0.0);
  for (int i = 0; i < STEPS; i++) {
    float from = len * pow(float(i) / float(STEPS), 1.5);
    float to = len * pow(float(i + 1) / float(STEPS), 1.5);
    float at = mix(from, to, grain);
    vec3 place = uEye + direction * at;
    float depth = uSurface - place.y;
    float fade = exp(-depth * 0.07);
    gathered += (to - from) * exp(-uExtinction * at) * sunlightAt(depth) * beamAt(place) * openAt(place) * fade;
  }
  outColor = vec4(gathered * (uExtinction - uAbsorption) * phase * uShafts * 1.6, 1.0);
}
`;

/** Beams of sunlight made visible by what drifts in the water, gathered along each line of sight. */
export class Shafts {
  private readonly target = new WebGLRenderTarget(1, 1, {
    type: HalfFloatType,
    minFilter: LinearFilter,
    magFilter: LinearFilter,
    depthBuffer: false,
  });
  private readonly own;
  private readonly pass: Pass;

  constructor(shared: SharedUniforms) {
    this.own = {
      uDepth: { value: null as Texture | null },
      uClipToWorld: { value: new Matrix4() },
      uReach: { value: 40 },
    };
    this.pass = new Pass(FRAGMENT, { ...shared, ...this.own });
    this.pass.mesh.material.defines = { STEPS: 14 };
  }

  get texture(): Texture {
    return this.target.texture;
  }

  resize(width: number, height: number): void {
    this.target.setSize(Math.max(1, Math.ceil(width / SHRINK)), Math.max(1, Math.ceil(height / SHRINK)));
  }

  render(renderer: WebGLRenderer, camera: PerspectiveCamera, depth: Texture): void {
    this.own.uDepth.value = depth;
    this.own.uClipToWorld.value.multiplyMatrices(camera.matrixWorld, camera.projectionMatrixInverse);
    this.pass.render(renderer, this.target);
  }

  dispose(): void {
    this.target.dispose();
    this.pass.dispose();
  }
}
