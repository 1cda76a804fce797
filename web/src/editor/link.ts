import { fromBase64, toBase64 } from "../share/page_copy";

/** Longest text that a link may unfold to, letters; as in the server's messages.py. */
export const LONGEST_TEXT = 500_000;

/** What a link to a model restores. */
export interface SharedModel {
  text: string;
  seed: number;
  /** Derivation steps that are shown; null for as many as the text says. */
  steps: number | null;
}

/** The part of an address after # that restores this: the text packed, in the letters of base64url. */
export async function formatModelHash({ text, seed, steps }: SharedModel): Promise<string> {
  const packed = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  const letters = toBase64(packed).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  const shown = steps === null ? "" : `&steps=${steps}`;
  return `#seed=${seed}${shown}&model=${letters}`;
}

/** What the part of an address after # restores; null if it is no link to a model, or a broken one. */
export async function parseModelHash(hash: string): Promise<SharedModel | null> {
  const fields = new URLSearchParams(hash.replace(/^#/, ""));
  const letters = fields.get("model");
  const seed = wholeNumber(fields.get("seed") ?? "1");
  const steps = fields.has("steps") ? wholeNumber(fields.get("steps") ?? "") : null;
  if (!letters || seed === null) return null;
  try {
    const packed = fromBase64(letters.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = await through(packed, new DecompressionStream("deflate-raw"));
    return { text: new TextDecoder("utf-8", { fatal: true }).decode(bytes), seed, steps };
  } catch {
    return null;
  }
}

/** Bytes led through a stream; fails when more come out than a text may have. */
async function through(
  bytes: Uint8Array,
  stream: CompressionStream | DecompressionStream,
): Promise<Uint8Array> {
  const reader = new Blob([bytes as BlobPart]).stream().pipeThrough(stream).getReader();
  const parts: Uint8Array[] = [];
  let length = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    length += part.value.length;
    if (length > LONGEST_TEXT) {
      await reader.cancel();
      throw new Error("the text of the link is too long");
    }
    parts.push(part.value);
  }
  const all = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

function wholeNumber(text: string): number | null {
  return /^\d{1,15}$/.test(text) ? Number(text) : null;
}
