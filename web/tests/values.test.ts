import { describe, expect, it } from "vitest";
import { colorOf, colorOfSpecies } from "../src/colors";
import { flatten, formatNumber, formatValue, unitOf } from "../src/inspector/values";
import type { Layout } from "../src/messages/types";
import { usedAssets } from "../src/messages/usage";
import { clock } from "../src/overlays/timeline_bar";
import { QUALITIES, QualityGovernor } from "../src/scene/quality";
import { pickedFrom } from "../src/scene/surface_material";

describe("values", () => {
  it("carry their unit", () => {
    expect(formatValue("speed", 0.5).text).toBe("0.500 m/s");
    expect(formatValue("beat [Hz]", 3).text).toBe("3 Hz");
    expect(unitOf("mean_speed_m_per_s")).toEqual({ label: "mean_speed", unit: "m/s" });
    expect(unitOf("nearest_neighbor_m")).toEqual({ label: "nearest_neighbor", unit: "m" });
    expect(formatValue("flow", [3, 0, 4])).toEqual({ text: "3  0  4 m/s", number: 5 });
    expect(formatValue("hungry", true)).toEqual({ text: "yes", number: 1 });
    expect(formatNumber(Number.POSITIVE_INFINITY)).toBe("∞");
    expect(formatNumber(12345.678)).toBe("12346");
  });

  it("of maps in maps are unfolded", () => {
    expect(flatten({ ahead: { distance: 2, aim: [1, 2, 3] }, light: null })).toEqual([
      ["ahead.distance", 2],
      ["ahead.aim", [1, 2, 3]],
      ["light", null],
    ]);
  });

  it("have colors that do not change", () => {
    expect(colorOf("flee")).toBe(colorOf("Flee"));
    expect(colorOf("some behavior")).toBe(colorOf("some behavior"));
    expect(colorOf("avoid")).not.toBe(colorOf("school"));
  });

  it("of eight species have eight colors", () => {
    const species = [
      "fusilier",
      "blacktip_shark",
      "kelp",
      "butterflyfish",
      "parrotfish",
      "yellow_tang",
      "sea_fan",
      "seagrass",
    ];
    expect(new Set(species.map(colorOfSpecies)).size).toBe(8);
    expect(colorOfSpecies("kelp")).toBe(colorOfSpecies("kelp"));
  });

  it("of time read as a clock", () => {
    expect([5, 65, 3725].map(clock)).toEqual(["0:05", "1:05", "1:02:05"]);
  });
});

describe("scene", () => {
  it("needs the meshes of a layout, their levels, materials and textures", () => {
    const layout = { batches: [{ mesh: 1, material: 5 }] } as unknown as Layout;
    const links = { meshLevels: (key: number) => (key < 3 ? [key + 1] : []), materialTexture: () => 9 };
    expect([...usedAssets(layout, links)].sort()).toEqual([
      "material:5",
      "mesh:1",
      "mesh:2",
      "mesh:3",
      "texture:9",
    ]);
  });

  it("names a picked instance in four bytes", () => {
    const [batch, slot] = [3021, 987_654];
    const pixel = [slot & 255, (slot >> 8) & 255, ((slot >> 16) & 15) | ((batch & 15) << 4), batch >> 4];
    expect(pickedFrom(pixel)).toEqual({ batch, slot });
  });

  it("is drawn at lower cost when pictures come slowly, and only then", () => {
    const quick = new QualityGovernor(false);
    for (let i = 0; i < 500; i++) quick.note(16);
    expect(quick.level).toBe(0);
    for (let i = 0; i < 500; i++) quick.note(90);
    expect(quick.level).toBe(QUALITIES.length - 1);
  });
});
