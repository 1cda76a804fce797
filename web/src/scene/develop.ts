import type { Texture, WebGLRenderer } from "three";
import { Pass } from "./fullscreen";

const FRAGMENT = /* glsl */ `
uniform sampler2D uPicture;
uniform sampler2D uBeams;
uniform bool uWithBeams;
uniform vec2 uTexel;
uniform float uExposure;
uniform bool uWithHalo;

vec3 beamsAt(vec2 at) {
  vec3 sum = vec3(0.0);
  for (int y = -1; y <= 1; y++) for (int x = -1; x <= 1; x++)
    sum += texture(uBeams, at + vec2(x, y) * uTexel * 5.0).rgb;
  return sum / 9.0;
}

/** The shine around what is brighter than the film can hold. */
vec3 haloAt(vec2 at) {
  vec3 sum = vec3(0.0);
  for (int level = 3; level <= 5; level++) {
    vec2 reach = uTexel * exp2(float(level)) * 0.6;
    for (int y = -1; y <= 1; y += 2) for (int x = -1; x <= 1; x += 2) {
      vec3 light = textureLod(uPicture, at + vec2(x, y) * reach, float(level)).rgb;
      sum += max(vec3(0.0), min(light, 8.0) - 0.9);
    }
  }
  return sum / 12.0;
}

/** Scene light to display light, from the engine's rasterizer/light.rs. */
vec3 filmic(vec3 radiance) {
  vec3 x = max(radiance, vec3(0.0)) * 0.8;
  float white = dot(x, vec3(0.2126, 0.7152, 0.0722));
  x = mix(x, vec3(white), 0.35 * smoothstep(0.6, 4.0, white));
  return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

vec3 encoded(vec3 x) {
  return mix(12.92 * x, 1.055 * pow(max(x, vec3(1e-5)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
}

void main() {
  vec3 light = texture(uPicture, vAt).rgb;
  if (uWithBeams) light = max(light + beamsAt(vAt), 0.0);
  if (uWithHalo) light += haloAt(vAt) * 0.35;
  vec2 off = vAt - 0.5;
  light *= 1.0 - 0.55 * dot(off, off);
  vec3 color = encoded(filmic(light * uExposure));
  float grain = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
  outColor = vec4(color + grain / 255.0, 1.0);
}
`;

/** From linear light to the screen: beams, halo, exposure, film curve, vignette. */
export class Develop {
  private readonly uniforms = {
    uPicture: { value: null as Texture | null },
    uBeams: { value: null as Texture | null },
    uWithBeams: { value: false },
    uTexel: { value: [1, 1] },
    uExposure: { value: 1 },
    uWithHalo: { value: false },
  };
  private readonly pass = new Pass(FRAGMENT, this.uniforms);

  render(renderer: WebGLRenderer, picture: Texture, beams: Texture | null, halo: boolean): void {
    const { width, height } = picture.image as { width: number; height: number };
    this.uniforms.uPicture.value = picture;
    this.uniforms.uBeams.value = beams;
    this.uniforms.uWithBeams.value = beams !== null;
    this.uniforms.uTexel.value = [1 / width, 1 / height];
    this.uniforms.uWithHalo.value = halo;
    this.pass.render(renderer, null);
  }

  dispose(): void {
    this.pass.dispose();
  }
}
