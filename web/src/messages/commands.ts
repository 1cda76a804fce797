/** What the page tells the world; see docs/reference/stream.md. */

/** A changed parameter: owner, name, value. */
export type Setting = [string, string, number];

export type Command =
  | { do: "join"; version: string; token?: string }
  | { do: "play" }
  | { do: "pause" }
  | { do: "step"; ticks: number }
  | { do: "back"; ticks: number }
  | { do: "seek"; tick: number }
  | { do: "speed"; factor: number | null }
  | { do: "restart"; seed: number | null; set?: Setting[]; tick?: number }
  | { do: "select"; id: number; retina?: [number, number] }
  | { do: "set"; owner: string; name: string; value: number }
  | { do: "annotations"; on: boolean }
  | { do: "snapshot" }
  | { do: "seen"; tick: number };
