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
const float REACH = 16.0;

float openAt(vec3 place) {
  if (!uShadows) return 1.0;
  vec3 at = shadowPlace(place);
  if (any(greaterThan(abs(at - 0.5), vec3(0.49)))) return 1.0;
  return texture(uShadowMap, at);
}

/** Light scattered towards the eye along a ray, as difference from still water's; from the engine's shafts.rs. */
void main() {
  float eyeDepth = depthOf(uEye.y);
  outColor = vec4(0.0);
  if (eyeDepth <= 0.0) return;
  vec4 end = uClipToWorld * vec4(vAt * 2.0 - 1.0, texture(uDepth, vAt).r * 2.0 - 1.0, 1.0);
  vec3 path = end.xyz / end.w - uEye;
  float away = length(path);
  vec3 direction = path / max(away, 1e-4);
  float len = min(min(away, REACH), direction.y > 1e-6 ? eyeDepth / direction.y : REACH);
  float start = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  float towards = max(0.0, dot(direction, uSunBelow));
  float strength = uShafts * (0.012 + 0.05 * towards * towards * towards);
  float stride = len / float(STEPS);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < STEPS; i++) {
    float run = (float(i) + start) * stride;
    vec3 place = uEye + direction * run;
    float depth = max(0.0, depthOf(place.y));
    float pattern = causticPattern(place, depth, 3.0);
    float change = pattern * openAt(place) - 1.0;
    float softened = change < 0.0 ? 0.35 * change : 1.3 * change; // light that went several ways fills dark beams
    sum += exp(-uExtinction * (run + depth / uSunBelow.y)) * softened;
  }
  outColor = vec4(uSunColor * sum * (strength * stride), 1.0);
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
