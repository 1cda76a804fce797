/** From where one looks, as a file: enough to look from there again. */
export interface ViewFile {
  bioscope: "view";
  /** Name of the way of looking. */
  camera: string;
  /** Where the camera stands and what it looks at, metres. */
  eye: [number, number, number];
  target: [number, number, number];
}

/** The text of a view's file. */
export function formatView(view: Omit<ViewFile, "bioscope">): string {
  return `${JSON.stringify({ bioscope: "view", ...view }, null, 2)}\n`;
}

/** The view in a text; null if it is none. */
export function parseView(text: string): ViewFile | null {
  let found: Partial<ViewFile>;
  try {
    found = JSON.parse(text) as Partial<ViewFile>;
  } catch {
    return null;
  }
  if (typeof found !== "object" || found === null || found.bioscope !== "view") return null;
  const good = typeof found.camera === "string" && isPoint(found.eye) && isPoint(found.target);
  return good ? (found as ViewFile) : null;
}

function isPoint(value: unknown): boolean {
  return (
    Array.isArray(value) &&
    value.length === 3 &&
    value.every((one) => typeof one === "number" && Math.abs(one) < 1e6)
  );
}
