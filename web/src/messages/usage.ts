import type { Layout } from "./types";

/** What an asset refers to: coarser meshes of a mesh, the texture of a material. */
export interface Links {
  meshLevels(key: number): number[];
  materialTexture(key: number): number | null;
}

/** Names (`mesh:3`) of every asset that a layout needs, coarser levels and textures included. */
export function usedAssets(layout: Layout, links: Links): Set<string> {
  const used = new Set<string>();
  for (const batch of layout.batches) {
    if (batch.key !== undefined) used.add(`batch:${batch.key}`);
    addMesh(used, batch.mesh, links);
    used.add(`material:${batch.material}`);
    const texture = links.materialTexture(batch.material);
    if (texture !== null) used.add(`texture:${texture}`);
  }
  return used;
}

function addMesh(used: Set<string>, key: number, links: Links): void {
  const name = `mesh:${key}`;
  if (used.has(name)) return;
  used.add(name);
  for (const level of links.meshLevels(key)) addMesh(used, level, links);
}
