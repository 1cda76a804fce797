import type { Batch } from "./batch";

/** Cells along each side of the map. */
const CELLS = 96;

/** How high the ground is: a coarse map of the highest points of all that is not alive and broad. */
export class Ground {
  private readonly heights = new Float32Array(CELLS * CELLS).fill(-Infinity);
  private origin = [0, 0];
  private spacing = [1, 1];
  private measured: Batch | null = null;

  /** Measures the broadest lifeless thing. */
  measure(batches: Iterable<Batch>): void {
    let broadest: Batch | null = null;
    for (const batch of batches) {
      if (batch.layout.alive || batch.layout.count !== 1) continue;
      if (!broadest || batch.asset.radius > broadest.asset.radius) broadest = batch;
    }
    if (broadest === this.measured) return;
    this.measured = broadest;
    this.heights.fill(-Infinity);
    if (broadest && broadest.asset.radius > 3) this.take(broadest);
  }

  /** Height of the ground in metres, −∞ where there is none. */
  heightAt(x: number, z: number): number {
    const column = Math.floor((x - this.origin[0]) / this.spacing[0]);
    const row = Math.floor((z - this.origin[1]) / this.spacing[1]);
    if (column < 0 || row < 0 || column >= CELLS || row >= CELLS) return -Infinity;
    return this.heights[row * CELLS + column];
  }

  private take(batch: Batch): void {
    const { box, message } = batch.asset;
    const place = batch.placeOf(0);
    const scale = place[3];
    this.origin = [place[0] + box[0] * scale, place[2] + box[2] * scale];
    this.spacing = [((box[3] - box[0]) * scale) / CELLS, ((box[5] - box[2]) * scale) / CELLS];
    const { positions } = message;
    for (let i = 0; i < positions.length; i += 3) {
      const column = Math.min(CELLS - 1, Math.floor(((positions[i] - box[0]) * scale) / this.spacing[0]));
      const row = Math.min(CELLS - 1, Math.floor(((positions[i + 2] - box[2]) * scale) / this.spacing[1]));
      const at = row * CELLS + column;
      this.heights[at] = Math.max(this.heights[at], place[1] + positions[i + 1] * scale);
    }
  }
}
