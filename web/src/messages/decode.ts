import { decode } from "@msgpack/msgpack";
import { type Fields, typed } from "./arrays";
import { type PackedMesh, unfoldMesh } from "./packed_mesh";
import type { Message } from "./types";

type Map = Record<string, unknown>;

const MESH: Fields = {
  positions: Uint16Array,
  normals: Int16Array,
  uvs: Float32Array,
  colors: Uint16Array,
  triangles: Uint32Array,
  short_triangles: Uint16Array,
  parents: Int8Array,
  rest: Float32Array,
  joint_indices: Uint8Array,
  joint_weights: Uint8Array,
};
const BATCH: Fields = { ids: Uint32Array, transforms: Float32Array, tints: Float32Array };
const MOVING: Fields = {
  positions: Uint16Array,
  rotations: Int16Array,
  scales: Uint16Array,
  poses: Int16Array,
};
const DRIFTING: Fields = { positions: Uint16Array, radii: Uint8Array };
const RETINA: Fields = { color: Uint8Array, depth: Float32Array, identity: Uint32Array };

/** How the byte fields of each message become arrays; messages that are missing here have none. */
const READERS: Record<string, (message: Map) => void> = {
  mesh: (message) => {
    typed(message, MESH);
    unfoldMesh(message as unknown as PackedMesh);
  },
  batch: (message) => typed(message, BATCH),
  frame: (message) => {
    for (const moving of Object.values(message.moving as Record<string, Map>)) typed(moving, MOVING);
    for (const drifting of Object.values(message.drifting as Record<string, Map>)) typed(drifting, DRIFTING);
  },
  inspection: (message) => {
    if (message.retina) typed(message.retina as Map, RETINA);
  },
};

const KINDS = new Set([
  "hello",
  "mesh",
  "texture",
  "material",
  "batch",
  "layout",
  "frame",
  "parameters",
  "events",
  "statistics",
  "timeline",
  "inspection",
  "populations",
  "script",
  "snapshot",
  "notice",
]);

/** The messages in one that came: those of a bundle, or itself. */
export function unpack(bytes: Uint8Array): Uint8Array[] {
  if (!isBundle(bytes)) return [bytes];
  const { messages } = decode(bytes) as { messages: Uint8Array[] };
  // Copies: what is kept of one message must not hold the whole bundle.
  return messages.map((message) => message.slice());
}

/** A map whose first entry says that it is a bundle. */
function isBundle(bytes: Uint8Array): boolean {
  const head = "\u00a4type\u00a6bundle";
  return [...head].every((letter, at) => bytes[at + 1] === letter.charCodeAt(0));
}

/** One message of the stream, its byte fields as arrays of numbers; null for a type that this page does not know. */
export function decodeMessage(bytes: Uint8Array): Message | null {
  const message = decode(bytes) as Map;
  if (typeof message !== "object" || message === null || typeof message.type !== "string") {
    throw new Error("a message without a type");
  }
  if (!KINDS.has(message.type)) return null;
  READERS[message.type]?.(message);
  return message as unknown as Message;
}
