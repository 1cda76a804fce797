import type { Layout, MaterialMessage, MeshMessage } from "../messages/types";
import type { PlantMesh } from "./messages";

/** Keys of the ground's meshes and of the materials; plants count on from the first. */
const SPECK_KEY = 1;
export const GROUND_KEY = 2;
const GROUND_MATERIAL = 1;
const PLANT_MATERIAL = 2;
/** Radii of the ground's rings, metres, and corners of each. */
const RINGS = [0, 3, 6, 10, 16, 26, 45, 90, 200, 600];
const CORNERS = 64;

/** What plant and ground are made of. */
export function materials(): MaterialMessage[] {
  const common = { type: "material" as const, texture: null, cutout: false, opacity: 1, two_sided: true };
  return [
    {
      ...common,
      key: GROUND_MATERIAL,
      name: "ground",
      color: [1, 1, 1],
      roughness: 1,
      specular: 0.01,
      translucency: 0,
    },
    {
      ...common,
      key: PLANT_MATERIAL,
      name: "plant",
      color: [1, 1, 1],
      roughness: 0.62,
      specular: 0.035,
      translucency: 0.3,
    },
  ];
}

/** Level ground that is lighter where the plant stands and runs into the haze; it throws no shadow on itself. */
export function groundMeshes(): MeshMessage[] {
  const positions: number[] = [];
  const colors: number[] = [];
  const triangles: number[] = [];
  RINGS.forEach((radius, ring) => {
    const light = 0.35 + 0.65 * Math.exp(-radius / 14);
    for (let corner = 0; corner < CORNERS; corner++) {
      const angle = (corner / CORNERS) * 2 * Math.PI;
      positions.push(radius * Math.cos(angle), 0, radius * Math.sin(angle));
      colors.push(0.17 * light, 0.165 * light, 0.13 * light);
      if (ring === 0) continue;
      const [a, b] = [ring * CORNERS + corner, ring * CORNERS + ((corner + 1) % CORNERS)];
      triangles.push(a - CORNERS, b, a, a - CORNERS, b - CORNERS, b);
    }
  });
  const normals = positions.map((_, index) => (index % 3 === 1 ? 1 : 0));
  const ground: MeshMessage = {
    type: "mesh",
    key: GROUND_KEY,
    positions: new Float32Array(positions),
    normals: new Float32Array(normals),
    colors: new Float32Array(colors),
    triangles: new Uint32Array(triangles),
    levels: [[0, SPECK_KEY]],
  };
  // Shadows are thrown by the coarser mesh of a thing: of the ground it is a triangle without area.
  const speck = { ...ground, key: SPECK_KEY, triangles: new Uint32Array(3), levels: [] };
  return [speck, ground];
}

export function plantMesh(key: number, mesh: PlantMesh): MeshMessage {
  return { type: "mesh", key, levels: [], ...mesh };
}

/** Ground and plant in the light of a hazy morning; the plant `scale` times its size, lifted so many metres. */
export function layoutOf(revision: number, mesh: number | null, scale: number, lift: number): Layout {
  const batch = (name: string, key: number, material: number, size: number, height: number) => ({
    name,
    species: name,
    mesh: key,
    material,
    alive: false,
    count: 1,
    ids: new Uint32Array([key]),
    transforms: new Float32Array([0, height, 0, size, 0, 0, 0, 1]),
    joints: 0,
  });
  const ground = batch("ground", GROUND_KEY, GROUND_MATERIAL, 1, 0);
  const plant = mesh === null ? [] : [batch("plant", mesh, PLANT_MATERIAL, scale, lift)];
  return {
    type: "layout",
    revision,
    batches: [ground, ...plant],
    points: [],
    sun: { direction: [0.55, 0.72, 0.5], color: [3.3, 2.95, 2.4] },
    sky: { zenith: [0.16, 0.27, 0.36], horizon: [0.34, 0.42, 0.44], nadir: [0.06, 0.07, 0.06] },
    medium: {
      surface: null,
      absorption: [0, 0, 0],
      scattering: [0.012, 0.012, 0.012],
      glow: [0.1, 0.17, 0.2],
      caustics: 0,
      caustic_scale: 1,
      shafts: 0,
    },
    bounds: [-8, 0, -8, 8, 8, 8],
  };
}
