import { colorOfSpecies } from "../colors";
import type { BatchLayout } from "../messages/types";
import type { Stage } from "../scene/stage";

/** One thing on the map. */
export interface Spot {
  id: number;
  species: string;
  /** Metres. */
  x: number;
  y: number;
  z: number;
  /** Radius on the level, metres. */
  radius: number;
}

/** A part of the level, metres; north is −Z, so that east is +X. */
export interface Section {
  x: number;
  z: number;
  /** Half its side. */
  half: number;
}

/** All individuals of the batches that are wanted. */
export function spotsOf(stage: Stage, wanted: (layout: BatchLayout) => boolean): Spot[] {
  const batches = [...stage.batches.values()].filter((batch) => wanted(batch.layout));
  return batches.flatMap((batch) =>
    [...batch.layout.ids].map((id, slot) => {
      const [x, y, z, scale] = batch.placeOf(slot);
      const { box } = batch.asset;
      const radius = 0.5 * Math.max(box[3] - box[0], box[5] - box[2]) * scale;
      return { id, species: batch.layout.species, x, y, z, radius };
    }),
  );
}

/** The square that holds them all, with some room. */
export function sectionOf(spots: readonly Spot[]): Section {
  if (spots.length === 0) return { x: 0, z: 0, half: 5 };
  const span = (of: (spot: Spot) => number) => {
    const values = spots.map(of);
    return [Math.min(...values), Math.max(...values)];
  };
  const [west, east] = span((spot) => spot.x);
  const [north, south] = span((spot) => spot.z);
  const half = 0.55 * Math.max(east - west, south - north, 2);
  return { x: (west + east) / 2, z: (north + south) / 2, half };
}

/** Place in a picture of this size, pixels from the upper left. */
export function toPicture(
  { x, z }: { x: number; z: number },
  section: Section,
  size: number,
): [number, number] {
  const pixels = size / (2 * section.half);
  return [(x - section.x + section.half) * pixels, (z - section.z + section.half) * pixels];
}

/** Place in the world of a point in the picture: x and z, metres. */
export function toWorld(point: readonly [number, number], section: Section, size: number): [number, number] {
  const metres = (2 * section.half) / size;
  return [point[0] * metres + section.x - section.half, point[1] * metres + section.z - section.half];
}

/** What lies nearest to a point in the picture, within `reach` pixels. */
export function nearest(
  spots: readonly Spot[],
  point: readonly [number, number],
  section: Section,
  size: number,
  reach: number,
): Spot | null {
  let best: Spot | null = null;
  let least = reach;
  for (const spot of spots) {
    const [x, y] = toPicture(spot, section, size);
    const away = Math.hypot(x - point[0], y - point[1]);
    if (away <= least) [best, least] = [spot, away];
  }
  return best;
}

/** Draws a map: a net of metres, what stands there, everything that can be moved, and what is selected. */
export function drawMap(
  context: CanvasRenderingContext2D,
  spots: readonly Spot[],
  standing: readonly Spot[],
  section: Section,
  size: number,
  selected: number,
): void {
  context.clearRect(0, 0, size, size);
  drawNet(context, section, size);
  const pixels = size / (2 * section.half);
  context.fillStyle = "#8fa9b433";
  context.beginPath();
  for (const spot of standing) {
    const [x, y] = toPicture(spot, section, size);
    const radius = Math.max(1, spot.radius * pixels);
    context.moveTo(x + radius, y);
    context.arc(x, y, radius, 0, 2 * Math.PI);
  }
  context.fill();
  for (const spot of spots) {
    const [x, y] = toPicture(spot, section, size);
    const radius = Math.min(9, Math.max(2, 0.5 * spot.radius * pixels));
    context.globalAlpha = spot.id === selected ? 1 : 0.75;
    context.fillStyle = colorOfSpecies(spot.species);
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fill();
    if (spot.id !== selected) continue;
    context.strokeStyle = "#ffffff";
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(x, y, radius + 4, 0, 2 * Math.PI);
    context.stroke();
  }
  context.globalAlpha = 1;
}

/** Metres between the lines of the net: 1, 2 or 5 times a power of ten, some six across the picture. */
export function meshOf(half: number): number {
  const wanted = half / 3;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * ([1, 2, 5, 10].find((one) => one * power >= wanted) ?? 10);
}

function drawNet(context: CanvasRenderingContext2D, section: Section, size: number): void {
  const mesh = meshOf(section.half);
  context.strokeStyle = "#ffffff14";
  context.lineWidth = 1;
  context.beginPath();
  for (const axis of ["x", "z"] as const) {
    const first = Math.ceil((section[axis] - section.half) / mesh) * mesh;
    for (let at = first; at < section[axis] + section.half; at += mesh) {
      const line = ((at - section[axis] + section.half) * size) / (2 * section.half);
      context.moveTo(axis === "x" ? line : 0, axis === "x" ? 0 : line);
      context.lineTo(axis === "x" ? line : size, axis === "x" ? size : line);
    }
  }
  context.stroke();
  context.fillStyle = "#8fa9b4";
  context.font = "10px system-ui";
  context.fillText(`${Number(mesh.toPrecision(2))} m`, 5, size - 6);
}
