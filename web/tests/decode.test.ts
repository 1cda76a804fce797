import { encode } from "@msgpack/msgpack";
import { describe, expect, it } from "vitest";
import { decodeMessage } from "../src/messages/decode";
import type { Frame, Inspection, Layout, MeshMessage } from "../src/messages/types";

const bytes = (array: ArrayBufferView) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

describe("decodeMessage", () => {
  it("gives the numbers of a mesh back, at whatever offset they lie", () => {
    for (const name of ["a", "ab", "abc", "abcd"]) {
      const positions = new Float32Array([1.5, -2, 3e5]);
      const sent = {
        type: "mesh",
        name,
        key: 7,
        positions: bytes(positions),
        normals: bytes(new Float32Array([0, 1, 0])),
        uvs: null,
        triangles: bytes(new Uint32Array([0, 70000, 2])),
        parents: bytes(new Int8Array([-1, 0])),
        levels: [[40, 8]],
      };
      const mesh = decodeMessage(encode(sent)) as MeshMessage;
      expect([...mesh.positions]).toEqual([...positions]);
      expect([...mesh.triangles]).toEqual([0, 70000, 2]);
      expect([...(mesh.parents ?? [])]).toEqual([-1, 0]);
      expect(mesh.uvs).toBeUndefined();
      expect(mesh.levels).toEqual([[40, 8]]);
    }
  });

  it("turns nested arrays of layouts, frames and retinas into numbers", () => {
    const batch = { name: "cod", ids: bytes(new Uint32Array([4e9])), transforms: bytes(new Float32Array(8)) };
    const layout = decodeMessage(encode({ type: "layout", batches: [batch], points: [] })) as Layout;
    expect(layout.batches[0].ids[0]).toBe(4e9);
    expect(layout.batches[0].transforms).toHaveLength(8);
    const moving = { cod: { positions: bytes(new Uint16Array([65535, 1, 0])), box: [0, 0, 0, 1, 1, 1] } };
    const frame = decodeMessage(encode({ type: "frame", moving, drifting: {} })) as Frame;
    expect([...(frame.moving.cod.positions ?? [])]).toEqual([65535, 1, 0]);
    expect(frame.moving.cod.rotations).toBeUndefined();
    const retina = { width: 1, height: 1, depth: bytes(new Float32Array([Infinity])) };
    const inspection = decodeMessage(encode({ type: "inspection", retina })) as Inspection;
    expect(inspection.retina?.depth[0]).toBe(Infinity);
  });

  it("refuses what is no message and leaves out what it does not know", () => {
    expect(() => decodeMessage(encode([1, 2]))).toThrow("without a type");
    expect(() => decodeMessage(encode({ type: "mesh", positions: new Uint8Array(5) }))).toThrow("positions");
    expect(decodeMessage(encode({ type: "weather" }))).toBeNull();
  });
});
