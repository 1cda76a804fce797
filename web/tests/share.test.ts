import { describe, expect, it } from "vitest";
import { changedSettings, formatHash, parseHash, type Shared } from "../src/share/link";
import { fromBase64, toBase64 } from "../src/share/page_copy";

const shared: Shared = {
  world: "my reef & more",
  seed: 41,
  tick: 1200,
  settings: [
    ["anchovy", "cruise_speed", 2.5],
    ["a:b", "depth", -1e-5],
  ],
  camera: "follow",
  eye: [1, -2.5, 3.125],
  target: [0, 0, -7],
};

describe("share links", () => {
  it("come back as they went", () => {
    expect(parseHash(formatHash(shared))).toEqual(shared);
  });

  it("that are broken restore nothing, or only what is sound", () => {
    expect(parseHash("")).toBeNull();
    expect(parseHash("#world=reef&seed=-3&tick=1")).toBeNull();
    expect(parseHash("#world=reef&seed=3&tick=1e9")).toBeNull();
    const parsed = parseHash("#world=reef&seed=3&tick=1&set=a:b&set=a:b:x&set=a:b:2&eye=1,2&target=1,2,NaN");
    expect(parsed?.settings).toEqual([["a", "b", 2]]);
    expect(parsed?.eye).toHaveLength(3);
    expect(parsed?.target.every(Number.isFinite)).toBe(true);
  });

  it("carry the parameters that were changed, and only those", () => {
    const parameter = { unit: "1", minimum: 0, maximum: 9, meaning: "", source: "" };
    const parameters = [
      { ...parameter, name: "calm", default: 0.1, value: Math.fround(0.1) },
      { ...parameter, name: "wild", default: 1, value: 2 },
    ];
    expect(changedSettings([{ name: "cod", parameters }], (_owner, one) => one.default)).toEqual([
      ["cod", "wild", 2],
    ]);
  });
});

describe("base 64", () => {
  it("comes back at every length round a part's", () => {
    for (const length of [0, 1, 2, 3, 24575, 24576, 24577]) {
      const bytes = Uint8Array.from({ length }, (_, index) => (index * 37) & 255);
      expect(Buffer.compare(fromBase64(toBase64(bytes)), bytes)).toBe(0);
    }
  });
});
