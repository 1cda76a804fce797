import {
  CircleGeometry,
  CustomBlending,
  DoubleSide,
  GLSL3,
  Mesh,
  OneFactor,
  OneMinusSrcAlphaFactor,
  ShaderMaterial,
  type Vector3,
} from "three";
import { MEDIUM } from "./shaders/medium";
import { WAVES } from "./shaders/waves";
import type { SharedUniforms } from "./shared_uniforms";

/** Radius of the drawn part of the surface, metres. */
const RADIUS = 400;

const VERTEX = /* glsl */ `
uniform vec3 uEye;
uniform float uSurface;
out vec3 vPlace;
void main() {
  vPlace = vec3(position.x + uEye.x, uSurface, position.y + uEye.z);
  gl_Position = projectionMatrix * viewMatrix * vec4(vPlace, 1.0);
}
`;

/** From below Snell's window in a mirror, from above a mirror that one sees through the steeper one looks. */
const FRAGMENT = /* glsl */ `
${MEDIUM}
${WAVES}
in vec3 vPlace;
uniform vec3 uEye;
uniform float uTime;
uniform float uTileSize;
layout(location = 0) out vec4 outColor;

void main() {
  float away = distance(vPlace, uEye);
  vec3 ahead = (vPlace - uEye) / away;
  vec3 tilt = surfaceTilt(vPlace.xz, away, uTileSize, uTime);
  float depth = uSurface - uEye.y;
  if (depth > 0.0) {
    vec3 seen = windowOf(ahead, tilt);
    outColor = vec4(seen * exp(-uExtinction * away) + waterGlow(depth, ahead, away), 1.0);
  } else {
    float outside = max(0.02, -dot(ahead, tilt));
    float inside = sqrt(1.0 - (1.0 - outside * outside) / (REFRACTION * REFRACTION));
    float share = fresnelOf(inside, outside);
    vec3 mirrored = ahead + tilt * (2.0 * outside);
    vec3 shine = skyOf(vec3(mirrored.x, max(mirrored.y, 0.02), mirrored.z)) + sunDisc(mirrored, 0.0005);
    outColor = vec4(shine * share, share);
  }
}
`;

/** The surface of the water, wide enough to fade into haze or horizon. */
export class WaterSurface {
  readonly mesh: Mesh<CircleGeometry, ShaderMaterial>;

  constructor(private readonly shared: SharedUniforms) {
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { ...shared },
      side: DoubleSide,
      transparent: true,
      premultipliedAlpha: true,
      blending: CustomBlending,
      blendSrc: OneFactor,
      blendDst: OneMinusSrcAlphaFactor,
    });
    this.mesh = new Mesh(new CircleGeometry(RADIUS, 48), material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 6;
  }

  update(eye: Vector3): void {
    this.mesh.visible = this.shared.uWater.value;
    this.mesh.material.depthWrite = eye.y < this.shared.uSurface.value;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
