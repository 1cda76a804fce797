import { Color, Matrix4, type Texture, Vector3 } from "three";
import type { Layout, Color as Rgb } from "../messages/types";

/** Refractive index of water. */
const REFRACTION = 1.34;
/** Caustic cells along one side of the tile. */
export const CELLS_PER_TILE = 5;

const color = () => ({ value: new Color() });
const vector = () => ({ value: new Vector3(0, 1, 0) });

/** Uniforms that every material of the scene shares by reference: light, medium, moment. */
export function createSharedUniforms() {
  return {
    uWater: { value: false },
    uSurface: { value: 0 },
    uAbsorption: color(),
    uExtinction: color(),
    uGlow: color(),
    uSun: vector(),
    uSunBelow: vector(),
    uSunColor: color(),
    uZenith: color(),
    uHorizon: color(),
    uNadir: color(),
    uShadowMap: { value: null as Texture | null },
    uShadowMatrix: { value: new Matrix4() },
    uShadowTexel: { value: 1 / 1024 },
    uShadows: { value: false },
    uCausticTile: { value: null as Texture | null },
    uCaustics: { value: 0 },
    uCausticScale: { value: 1 },
    uTileSize: { value: 5 },
    uShafts: { value: 0 },
    /** World time modulo 100 s, after which the waves repeat. */
    uTime: { value: 0 },
    uBlend: { value: 1 },
    uEye: { value: new Vector3() },
  };
}

export type SharedUniforms = ReturnType<typeof createSharedUniforms>;

const set = (target: { value: Color }, [r, g, b]: Rgb) => target.value.setRGB(r, g, b);

/** Takes over sun, sky and medium of a layout. */
export function applyLight(shared: SharedUniforms, layout: Layout): void {
  const { sun, sky, medium } = layout;
  shared.uWater.value = medium.surface !== null;
  shared.uSurface.value = medium.surface ?? 0;
  set(shared.uAbsorption, medium.absorption);
  set(shared.uExtinction, medium.scattering);
  shared.uExtinction.value.add(shared.uAbsorption.value);
  set(shared.uGlow, medium.glow);
  set(shared.uSunColor, sun.color);
  set(shared.uZenith, sky.zenith);
  set(shared.uHorizon, sky.horizon);
  set(shared.uNadir, sky.nadir);
  shared.uSun.value.fromArray(sun.direction).normalize();
  shared.uSunBelow.value.copy(refracted(shared.uSun.value));
  shared.uCaustics.value = medium.caustics;
  shared.uCausticScale.value = Math.max(1e-3, medium.caustic_scale);
  shared.uTileSize.value = shared.uCausticScale.value * CELLS_PER_TILE;
  shared.uShafts.value = medium.shafts;
}

/** Direction towards the sun as seen from below a calm surface (Snell's law). */
export function refracted(direction: Vector3): Vector3 {
  const level = new Vector3(direction.x, 0, direction.z).divideScalar(REFRACTION);
  const up = Math.sqrt(Math.max(0.1, 1 - level.lengthSq()));
  return level.setY(up).normalize();
}
