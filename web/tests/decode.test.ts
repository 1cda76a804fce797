import { encode } from "@msgpack/msgpack";
import { describe, expect, it } from "vitest";
import { decodeMessage, unpack } from "../src/messages/decode";
import type { BatchMessage, Frame, Inspection, MeshMessage } from "../src/messages/types";

const bytes = (array: ArrayBufferView) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

describe("decodeMessage", () => {
  it("gives the numbers of a mesh back, at whatever offset they lie", () => {
    for (const name of ["a", "ab", "abc", "abcd"]) {
      const sent = {
        type: "mesh",
        name,
        key: 7,
        box: [1, -2, 0, 3, -1, 4],
        positions: bytes(new Uint16Array([0, 65535, 32768])),
        normals: bytes(new Int16Array([0, 32767, 0])),
        uvs: null,
        brightest: 2,
        colors: bytes(new Uint16Array([65535, 0, 0])),
        triangles: bytes(new Uint32Array([0, 70000, 2])),
        parents: bytes(new Int8Array([-1, 0])),
        joint_weights: bytes(new Uint8Array([128, 128, 0, 0])),
        levels: [[40, 8]],
      };
      const mesh = decodeMessage(encode(sent)) as MeshMessage;
      expect([...mesh.positions].map((one) => Math.round(one * 100) / 100)).toEqual([1, -1, 2]);
      expect([...mesh.normals]).toEqual([0, 1, 0]);
      expect([...(mesh.colors ?? [])]).toEqual([2, 0, 0]);
      expect([...(mesh.joint_weights ?? [])]).toEqual([0.5, 0.5, 0, 0]);
      expect([...mesh.triangles]).toEqual([0, 70000, 2]);
      expect([...(mesh.parents ?? [])]).toEqual([-1, 0]);
      expect(mesh.uvs).toBeUndefined();
      expect(mesh.levels).toEqual([[40, 8]]);
    }
  });

  it("turns nested arrays of batches, frames and retinas into numbers", () => {
    const sent = { name: "cod", ids: bytes(new Uint32Array([4e9])), transforms: bytes(new Float32Array(8)) };
    const batch = decodeMessage(encode({ type: "batch", key: 3, ...sent })) as BatchMessage;
    expect(batch.ids[0]).toBe(4e9);
    expect(batch.transforms).toHaveLength(8);
    const moving = { cod: { positions: bytes(new Uint16Array([65535, 1, 0])), box: [0, 0, 0, 1, 1, 1] } };
    const frame = decodeMessage(encode({ type: "frame", moving, drifting: {} })) as Frame;
    expect([...(frame.moving.cod.positions ?? [])]).toEqual([65535, 1, 0]);
    expect(frame.moving.cod.rotations).toBeUndefined();
    const retina = { width: 1, height: 1, depth: bytes(new Float32Array([Infinity])) };
    const inspection = decodeMessage(encode({ type: "inspection", retina })) as Inspection;
    expect(inspection.retina?.depth[0]).toBe(Infinity);
  });

  it("takes bundles apart and leaves other messages whole", () => {
    const [first, second] = [encode({ type: "notice", text: "a" }), encode({ type: "timeline" })];
    expect(unpack(encode({ type: "bundle", messages: [first, second] }))).toEqual([first, second]);
    expect(unpack(first)).toEqual([first]);
  });

  it("refuses what is no message and leaves out what it does not know", () => {
    expect(() => decodeMessage(encode([1, 2]))).toThrow("without a type");
    expect(() => decodeMessage(encode({ type: "mesh", positions: new Uint8Array(5) }))).toThrow("positions");
    expect(decodeMessage(encode({ type: "weather" }))).toBeNull();
  });
});
