/** A number that a model lets one play with: a line `#define NAME value`. */
export interface ModelParameter {
  name: string;
  value: number;
  /** Where the value stands in the text, in letters. */
  from: number;
  to: number;
  low: number;
  high: number;
  unit: string;
  meaning: string;
  /** Whether the text says the range. */
  declared: boolean;
}

const NUMBER = String.raw`[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?`;
const DEFINITION = new RegExp(
  String.raw`^([ \t]*#[ \t]*define[ \t]+([A-Za-z_]\w*)[ \t]+)(${NUMBER})[ \t]*(?:\/\*(.*?)\*\/[ \t]*|\/\/(.*))?\r?$`,
  "gm",
);
const RANGE = new RegExp(String.raw`(${NUMBER})\s+to\s+(${NUMBER})\s*([^,]*)`);

/**
 * The parameters of a text, in its order. A comment behind the value tells the range, the unit and the meaning:
 * `/* parameter: 3 to 16, m, length of a leaf *\/`, or in words, `/* of the plant, 2 to 4 metres *\/`.
 */
export function parameters(text: string): ModelParameter[] {
  return [...text.matchAll(DEFINITION)].map((found) => {
    const [, before, name, digits, block, line] = found;
    const value = Number(digits);
    const from = found.index + before.length;
    const told = described((block ?? line ?? "").trim());
    const declared = told.range !== null;
    const [low, high] = told.range ?? guessedRange(value);
    const { unit, meaning } = told;
    return {
      name,
      value,
      from,
      to: from + digits.length,
      low: Math.min(low, value),
      high: Math.max(high, value),
      unit,
      meaning,
      declared,
    };
  });
}

/** What a comment says of a parameter. */
function described(comment: string): { range: [number, number] | null; unit: string; meaning: string } {
  const words = comment.replace(/^parameter:\s*/, "");
  const range = RANGE.exec(words);
  if (!range) return { range: null, unit: "", meaning: words };
  const [low, high] = [Number(range[1]), Number(range[2])].sort((a, b) => a - b);
  const rest = `${words.slice(0, range.index)},${words.slice(range.index + range[0].length)}`;
  const parts = rest.split(",").flatMap((part) => part.trim() || []);
  let unit = range[3].trim();
  const follows = words.slice(range.index + range[0].length).split(",").length > 2;
  if (!unit && follows && range.index === 0) unit = parts.shift() ?? "";
  return { range: low < high ? [low, high] : null, unit, meaning: parts.join(", ") };
}

/** Zero to twice the value; one below and above zero. */
function guessedRange(value: number): [number, number] {
  if (value === 0) return [-1, 1];
  return value > 0 ? [0, 2 * value] : [2 * value, 0];
}

/** A value as it is written into a text: as short as its range allows; whole where the text's is. */
export function written(value: number, { low, high, value: present }: ModelParameter): string {
  const whole = [low, high, present].every(Number.isInteger) && high - low >= 2;
  if (whole) return String(Math.round(value));
  const decimals = Math.max(0, Math.min(8, 3 - Math.floor(Math.log10(high - low))));
  return String(Number(value.toFixed(decimals)));
}
