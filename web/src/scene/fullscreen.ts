import {
  BufferAttribute,
  BufferGeometry,
  GLSL3,
  type IUniform,
  Mesh,
  OrthographicCamera,
  ShaderMaterial,
  type WebGLRenderer,
  type WebGLRenderTarget,
} from "three";

/** Vertex shader of a triangle that covers the picture; `vAt` runs from 0 to 1 over it. */
const VERTEX = /* glsl */ `
out vec2 vAt;
void main() {
  vAt = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy, FAR, 1.0);
}
`;

/** One triangle over the whole picture; `far` draws it behind everything else. */
export function fullscreenMesh(fragment: string, uniforms: Record<string, IUniform>, far = false) {
  const geometry = new BufferGeometry();
  geometry.setAttribute(
    "position",
    new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3),
  );
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX.replace("FAR", far ? "1.0" : "0.0"),
    fragmentShader: `in vec2 vAt;\nlayout(location = 0) out vec4 outColor;\n${fragment}`,
    uniforms,
    depthTest: far,
    depthWrite: false,
  });
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

const camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);

/** A step that computes one picture from others. */
export class Pass {
  readonly mesh: ReturnType<typeof fullscreenMesh>;

  constructor(fragment: string, uniforms: Record<string, IUniform>) {
    this.mesh = fullscreenMesh(fragment, uniforms);
  }

  render(renderer: WebGLRenderer, target: WebGLRenderTarget | null): void {
    renderer.setRenderTarget(target);
    renderer.render(this.mesh, camera);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
