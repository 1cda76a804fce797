import { type PerspectiveCamera, Scene, WebGLRenderTarget } from "three";
import type { Batch } from "./batch";
import type { Stage } from "./stage";
import { pickedFrom } from "./surface_material";

/** Side of the patch round the pointer that is searched, pixels of the screen (odd). */
const PATCH = 17;

/** Finds out which individual is under the pointer by drawing a small patch with numbers for colors. */
export class Picker {
  private readonly target = new WebGLRenderTarget(PATCH, PATCH);
  private readonly pixels = new Uint8Array(4 * PATCH * PATCH);
  private readonly scene = new Scene();

  constructor(private readonly stage: Stage) {
    this.scene.matrixWorldAutoUpdate = false;
  }

  /** Identity of the living thing nearest to a point of the picture (0 to 1 from the upper left), 0 for none. */
  pick(camera: PerspectiveCamera, x: number, y: number, width: number, height: number): number {
    const { renderer } = this.stage;
    const half = (PATCH - 1) / 2;
    camera.setViewOffset(
      width,
      height,
      Math.round(x * width) - half,
      Math.round(y * height) - half,
      PATCH,
      PATCH,
    );
    const meshes = [...this.stage.batches.values()].flatMap((batch) =>
      batch.levels.map(({ mesh, pick }) => ({ mesh, look: mesh.material, pick })),
    );
    for (const { mesh, pick } of meshes) {
      mesh.material = pick;
      this.scene.add(mesh);
    }
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(this.scene, camera);
    for (const { mesh, look } of meshes) {
      mesh.material = look;
      this.stage.scene.add(mesh);
    }
    camera.clearViewOffset();
    renderer.readRenderTargetPixels(this.target, 0, 0, PATCH, PATCH, this.pixels);
    return this.nearest();
  }

  dispose(): void {
    this.target.dispose();
  }

  private nearest(): number {
    const byNumber = new Map<number, Batch>();
    for (const batch of this.stage.batches.values()) byNumber.set(batch.number, batch);
    let best = 0;
    let least = Infinity;
    for (let i = 0; i < PATCH * PATCH; i++) {
      const { batch: number, slot } = pickedFrom(this.pixels.subarray(4 * i, 4 * i + 4));
      const batch = byNumber.get(number);
      if (!batch?.layout.alive) continue;
      const away = Math.hypot((i % PATCH) - PATCH / 2, Math.floor(i / PATCH) - PATCH / 2);
      const id = batch.layout.ids[slot];
      if (id !== undefined && away < least) [best, least] = [id, away];
    }
    return best;
  }
}
