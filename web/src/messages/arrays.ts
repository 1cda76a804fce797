/** Raw little-endian numbers out of MessagePack `bin` values. */

interface ArrayOf<T> {
  new (buffer: ArrayBuffer, offset: number, length: number): T;
  readonly BYTES_PER_ELEMENT: number;
}

/** The numbers in these bytes, without a copy where they lie aligned; fails if bytes are left over. */
export function numbers<T>(kind: ArrayOf<T>, bytes: Uint8Array, field: string): T {
  if (!(bytes instanceof Uint8Array)) throw new Error(`${field} holds no bytes`);
  const size = kind.BYTES_PER_ELEMENT;
  if (bytes.byteLength % size !== 0)
    throw new Error(`${field}: ${bytes.byteLength} bytes are no multiple of ${size}`);
  const aligned = bytes.byteOffset % size === 0 ? bytes : bytes.slice();
  return new kind(aligned.buffer as ArrayBuffer, aligned.byteOffset, aligned.byteLength / size);
}

/** Which fields of a map hold numbers of which kind. */
export type Fields = Record<string, ArrayOf<ArrayBufferView>>;

/** Replaces byte fields by arrays of numbers, in place; absent or nil fields become undefined. */
export function typed(map: Record<string, unknown>, fields: Fields): void {
  for (const [field, kind] of Object.entries(fields)) {
    const value = map[field];
    map[field] = value == null ? undefined : numbers(kind, value as Uint8Array, field);
  }
}
