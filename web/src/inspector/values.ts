/** Units of values that the engine names without one. */
const UNITS: Record<string, string> = {
  age: "s",
  aim: "m",
  body_length: "m",
  depth: "m",
  distance: "m",
  dt: "s",
  flow: "m/s",
  frequency: "Hz",
  heading: "",
  height: "m",
  home: "m",
  length: "m",
  mass: "kg",
  position: "m",
  radius: "m",
  size: "m",
  speed: "m/s",
  temperature: "°C",
  time: "s",
  velocity: "m/s",
};

/** Units as they stand at the end of names, longest first. */
const ENDINGS: [string, string][] = [
  ["_body_lengths_per_s", "BL/s"],
  ["_w_per_kg", "W/kg"],
  ["_j_per_kg", "J/kg"],
  ["_m_per_s2", "m/s²"],
  ["_rad_per_s", "rad/s"],
  ["_m_per_s", "m/s"],
  ["_degrees", "°"],
  ["_celsius", "°C"],
  ["_per_s", "1/s"],
  ["_rad", "rad"],
  ["_deg", "°"],
  ["_hz", "Hz"],
  ["_kg", "kg"],
  ["_j", "J"],
  ["_m", "m"],
  ["_s", "s"],
  ["_w", "W"],
];

export interface Formatted {
  text: string;
  /** The number to plot; undefined for what is none. */
  number?: number;
}

/** Unit of a value: written after its name in brackets or at its end, or known from its name. */
export function unitOf(name: string): { label: string; unit: string } {
  const written = /^(.*?)\s*[([]([^)\]]+)[)\]]$/.exec(name);
  if (written) return { label: written[1], unit: written[2] };
  const ending = ENDINGS.find(([letters]) => name.endsWith(letters));
  if (ending) return { label: name.slice(0, -ending[0].length), unit: ending[1] };
  const last = name.split(".").at(-1) ?? name;
  return { label: name, unit: UNITS[last] ?? "" };
}

/** A number with three figures that matter. */
export function formatNumber(number: number): string {
  if (!Number.isFinite(number)) return number > 0 ? "∞" : Number.isNaN(number) ? "–" : "−∞";
  if (Number.isInteger(number) && Math.abs(number) < 1e6) return String(number);
  const size = Math.abs(number);
  if (size < 1e-9) return "0";
  if (size >= 1e6 || size < 1e-3) return number.toExponential(2);
  const places = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;
  return number.toFixed(places);
}

/** A value with its unit, as a person reads it. */
export function formatValue(name: string, value: unknown): Formatted {
  const { unit } = unitOf(name);
  const tail = unit ? ` ${unit}` : "";
  if (typeof value === "number") return { text: formatNumber(value) + tail, number: value };
  if (typeof value === "boolean") return { text: value ? "yes" : "no", number: value ? 1 : 0 };
  if (typeof value === "string") return { text: value };
  if (value == null) return { text: "nothing" };
  if (isNumbers(value)) {
    const size = Math.hypot(...value);
    const parts = value.length <= 4 ? value.map(formatNumber).join("  ") : `${value.length} numbers`;
    return { text: parts + tail, number: value.length <= 3 ? size : undefined };
  }
  if (Array.isArray(value))
    return { text: value.length === 0 ? "nothing" : `${value.length}`, number: value.length };
  return { text: "" };
}

/** Rows of a map of values, maps within maps unfolded with dots between names. */
export function flatten(values: Record<string, unknown>, prefix = ""): [string, unknown][] {
  return Object.entries(values).flatMap(([name, value]): [string, unknown][] => {
    const path = prefix ? `${prefix}.${name}` : name;
    const isMap =
      typeof value === "object" && value !== null && !Array.isArray(value) && !ArrayBuffer.isView(value);
    return isMap ? flatten(value as Record<string, unknown>, path) : [[path, value]];
  });
}

function isNumbers(value: unknown): value is number[] {
  return Array.isArray(value) && value.length > 0 && value.every((one) => typeof one === "number");
}
