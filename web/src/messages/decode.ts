import { decode } from "@msgpack/msgpack";
import { type Fields, typed } from "./arrays";
import type { Message } from "./types";

type Map = Record<string, unknown>;

const MESH: Fields = {
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  colors: Float32Array,
  triangles: Uint32Array,
  parents: Int8Array,
  rest: Float32Array,
  joint_indices: Uint8Array,
  joint_weights: Float32Array,
};
const BATCH: Fields = { ids: Uint32Array, transforms: Float32Array, tints: Float32Array };
const MOVING: Fields = { positions: Uint16Array, rotations: Int16Array, poses: Int16Array };
const DRIFTING: Fields = { positions: Uint16Array, radii: Uint8Array };
const RETINA: Fields = { color: Uint8Array, depth: Float32Array, identity: Uint32Array };

/** How the byte fields of each message become arrays; messages that are missing here have none. */
const READERS: Record<string, (message: Map) => void> = {
  mesh: (message) => typed(message, MESH),
  layout: (message) => {
    for (const batch of message.batches as Map[]) typed(batch, BATCH);
  },
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
