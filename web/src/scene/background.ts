import { Matrix4, type PerspectiveCamera } from "three";
import { fullscreenMesh } from "./fullscreen";
import { MEDIUM } from "./shaders/medium";
import type { SharedUniforms } from "./shared_uniforms";

const FRAGMENT = /* glsl */ `
${MEDIUM}
uniform mat4 uViewToWorld;
uniform mat4 uInverseProjection;
uniform vec3 uEye;

void main() {
  vec4 ahead = uInverseProjection * vec4(vAt * 2.0 - 1.0, 1.0, 1.0);
  vec3 direction = normalize((uViewToWorld * vec4(ahead.xyz / ahead.w, 0.0)).xyz);
  vec3 color;
  float depth = depthOf(uEye.y);
  if (depth > 0.0) color = waterGlow(depth, direction, FAR_AWAY);
  else if (uWater && direction.y < 0.0) color = waterGlow(0.0, bentDown(direction, vec3(0.0, 1.0, 0.0)), FAR_AWAY);
  else {
    color = skyOf(direction) + sunDisc(direction, 0.0);
    vec3 kept = exp(-uExtinction * (300.0 / max(direction.y, 0.01)));
    if (!uWater) color = color * kept + uGlow * (1.0 - kept);
  }
  outColor = vec4(color, 1.0);
}
`;

/** What is seen where nothing stands: open water, or sky, sun and haze. */
export class Background {
  readonly mesh;
  private readonly own = {
    uViewToWorld: { value: new Matrix4() },
    uInverseProjection: { value: new Matrix4() },
  };

  constructor(shared: SharedUniforms) {
    this.mesh = fullscreenMesh(FRAGMENT, { ...shared, ...this.own }, true);
    this.mesh.renderOrder = 5;
  }

  update(camera: PerspectiveCamera): void {
    this.own.uViewToWorld.value.copy(camera.matrixWorld);
    this.own.uInverseProjection.value.copy(camera.projectionMatrixInverse);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
