/** What the page tells the world; see docs/reference/stream.md. */

/** A changed parameter: owner, name, value. */
export type Setting = [string, string, number];

/** Motor commands in place of an animal's mind: radians (positive to the left, up), body lengths per second, shares. */
export interface Steering {
  turn: number;
  pitch: number;
  speed: number;
  brake: number;
  mouth: number;
}

/** A new population. */
export interface Addition {
  change: "add";
  kind: "fish" | "plankton" | "plants" | "pillars";
  count: number;
  position: [number, number, number];
  species?: string;
  role?: "predator" | "prey" | "pacifist" | "generic";
  /** Of each plant. */
  leaves?: number;
}

export type Command =
  | { do: "join"; version: string; token?: string }
  | { do: "play" }
  | { do: "pause" }
  | { do: "step"; ticks: number }
  | { do: "back"; ticks: number }
  | { do: "seek"; tick: number }
  | { do: "speed"; factor: number | null }
  | { do: "restart"; seed: number | null; set?: Setting[]; tick?: number }
  | { do: "select"; id: number; retina?: [number, number]; pan?: number; tilt?: number; both?: boolean }
  | { do: "set"; owner: string; name: string; value: number }
  | { do: "resize"; population: string; count: number }
  | { do: "remove"; id: number }
  | { do: "place"; id: number; position: [number, number, number]; scale?: number }
  | { do: "trait"; id: number; name: string; value: number }
  | { do: "steer"; id: number; steering: Steering | null }
  | { do: "add"; addition: Addition }
  | { do: "display"; ticks: number | null }
  | { do: "script" }
  | { do: "play script"; text: string }
  | { do: "annotations"; on: boolean }
  | { do: "snapshot" }
  | { do: "seen"; tick: number }
  | { do: "inspected" };
