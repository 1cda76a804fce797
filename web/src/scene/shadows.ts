import {
  DepthTexture,
  Frustum,
  LessEqualCompare,
  LinearFilter,
  Matrix4,
  OrthographicCamera,
  Scene,
  UnsignedIntType,
  type Vector3,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import type { Batch } from "./batch";
import type { SharedUniforms } from "./shared_uniforms";

/** How far towards the sun and away from it shadows reach, as a multiple of the covered radius. */
const REACH = 2.5;

/** What the sun sees around the point of interest. */
export class Shadows {
  readonly scene = new Scene();
  private target: WebGLRenderTarget | null = null;
  private readonly camera = new OrthographicCamera();
  private readonly frustum = new Frustum();
  private readonly matrix = new Matrix4();

  constructor(private readonly shared: SharedUniforms) {
    this.scene.matrixWorldAutoUpdate = false;
  }

  /** Side of the map in texels; 0 for no shadows. */
  resize(renderer: WebGLRenderer, size: number): void {
    if (this.target?.width === Math.max(1, size)) return;
    this.dispose();
    this.shared.uShadows.value = size > 0;
    this.shared.uShadowTexel.value = 1 / Math.max(1, size);
    const depth = new DepthTexture(Math.max(1, size), Math.max(1, size), UnsignedIntType);
    depth.compareFunction = LessEqualCompare;
    depth.minFilter = depth.magFilter = LinearFilter;
    this.target = new WebGLRenderTarget(depth.image.width, depth.image.height, { depthTexture: depth });
    this.shared.uShadowMap.value = depth;
    renderer.setRenderTarget(this.target); // gives the texture its storage, which shaders need even without shadows
    renderer.clear();
  }

  /** Draws the map for a ball around `center`. */
  render(renderer: WebGLRenderer, batches: Iterable<Batch>, center: Vector3, radius: number): void {
    if (!this.target || !this.shared.uShadows.value) return;
    this.aim(center, radius);
    for (const batch of batches) batch.cullShadows(this.frustum);
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0xffffff, 1);
    renderer.clear();
    renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.target?.depthTexture?.dispose();
    this.target?.dispose();
    this.target = null;
  }

  private aim(center: Vector3, radius: number): void {
    const { camera, shared } = this;
    const towards = shared.uWater.value ? shared.uSunBelow.value : shared.uSun.value;
    Object.assign(camera, { left: -radius, right: radius, top: radius, bottom: -radius });
    camera.near = 0.1;
    camera.far = 2 * REACH * radius;
    camera.up.set(Math.abs(towards.y) > 0.95 ? 1 : 0, Math.abs(towards.y) > 0.95 ? 0 : 1, 0);
    camera.position.copy(towards);
    camera.lookAt(0, 0, 0);
    const texel = (2 * radius) / (this.target?.width ?? 1);
    const at = center.clone().applyQuaternion(camera.quaternion.clone().invert());
    at.set(
      Math.round(at.x / texel) * texel,
      Math.round(at.y / texel) * texel,
      Math.round(at.z / texel) * texel,
    );
    camera.position.copy(at.applyQuaternion(camera.quaternion)).addScaledVector(towards, REACH * radius);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    this.matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    this.frustum.setFromProjectionMatrix(this.matrix);
    shared.uShadowMatrix.value.copy(this.matrix);
  }
}
