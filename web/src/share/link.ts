import type { Setting } from "../messages/commands";
import type { Owner, Parameter } from "../messages/types";

/** What a share link restores. */
export interface Shared {
  world: string;
  seed: number;
  tick: number;
  settings: Setting[];
  /** Name of the way of looking. */
  camera: string;
  /** Where the camera stands and what it looks at, metres. */
  eye: [number, number, number];
  target: [number, number, number];
}

const short = (number: number) => String(Number(number.toFixed(3)));

/** The part of an address after # that restores this. */
export function formatHash(shared: Shared): string {
  const fields = new URLSearchParams();
  fields.set("world", shared.world);
  fields.set("seed", String(shared.seed));
  fields.set("tick", String(shared.tick));
  for (const [owner, name, value] of shared.settings) fields.append("set", `${owner}:${name}:${value}`);
  fields.set("camera", shared.camera);
  fields.set("eye", shared.eye.map(short).join(","));
  fields.set("target", shared.target.map(short).join(","));
  return `#${fields.toString()}`;
}

/** What the part of an address after # restores; null if it is no share link. */
export function parseHash(hash: string): Shared | null {
  const fields = new URLSearchParams(hash.replace(/^#/, ""));
  const world = fields.get("world");
  const [seed, tick] = [wholeNumber(fields.get("seed")), wholeNumber(fields.get("tick"))];
  if (world === null || seed === null || tick === null) return null;
  return {
    world,
    seed,
    tick,
    settings: fields.getAll("set").flatMap(parseSetting),
    camera: fields.get("camera") ?? "free",
    eye: parsePoint(fields.get("eye")) ?? [6, 2, 6],
    target: parsePoint(fields.get("target")) ?? [0, 0, 0],
  };
}

/** Parameters that differ from what they were when the world began. */
export function changedSettings(
  owners: Owner[],
  initialOf: (owner: string, parameter: Parameter) => number,
): Setting[] {
  return owners.flatMap((owner) =>
    owner.parameters
      .filter((one) => {
        const initial = initialOf(owner.name, one);
        return Math.abs(one.value - initial) > 1e-6 * Math.max(1, Math.abs(initial));
      })
      .map(({ name, value }): Setting => [owner.name, name, Number(value.toPrecision(7))]),
  );
}

function wholeNumber(text: string | null): number | null {
  if (text === null || !/^\d{1,16}$/.test(text)) return null;
  return Number(text);
}

function parseSetting(text: string): Setting[] {
  const at = text.lastIndexOf(":");
  const before = text.lastIndexOf(":", at - 1);
  const value = Number(text.slice(at + 1));
  if (before <= 0 || at <= before + 1 || text.length === at + 1 || !Number.isFinite(value)) return [];
  return [[text.slice(0, before), text.slice(before + 1, at), value]];
}

function parsePoint(text: string | null): [number, number, number] | null {
  const numbers = (text ?? "").split(",").map(Number);
  return numbers.length === 3 && numbers.every(Number.isFinite)
    ? (numbers as [number, number, number])
    : null;
}
