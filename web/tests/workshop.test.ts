import { describe, expect, it } from "vitest";
import { meshOf, nearest, type Spot, sectionOf, toPicture, toWorld } from "../src/workshop/map";
import { commands } from "../src/workshop/steering";
import { formatView, parseView } from "../src/workshop/view_file";

const spot = (id: number, x: number, z: number): Spot => ({ id, species: "kelp", x, y: -3, z, radius: 0.2 });

describe("the map", () => {
  const spots = [spot(1, -4, 2), spot(2, 6, 2), spot(3, 0, 7)];

  it("holds everything that can be moved", () => {
    const section = sectionOf(spots);
    for (const one of spots) {
      const [x, y] = toPicture(one, section, 200);
      expect(Math.min(x, y)).toBeGreaterThan(0);
      expect(Math.max(x, y)).toBeLessThan(200);
    }
  });

  it("takes a place on the picture back to the place in the world", () => {
    const section = sectionOf(spots);
    const [x, z] = toWorld(toPicture({ x: 1.25, z: -0.5 }, section, 270), section, 270);
    expect(x).toBeCloseTo(1.25, 9);
    expect(z).toBeCloseTo(-0.5, 9);
  });

  it("finds what is under the mouse, and nothing far from it", () => {
    const section = sectionOf(spots);
    const [x, y] = toPicture(spots[1], section, 270);
    expect(nearest(spots, [x + 3, y - 2], section, 270, 10)?.id).toBe(2);
    expect(nearest(spots, [x - 40, y - 40], section, 270, 10)).toBeNull();
  });

  it("is not lost in an empty world", () => {
    expect(sectionOf([])).toEqual({ x: 0, z: 0, half: 5 });
  });

  it("has a net of round numbers of metres", () => {
    expect([0.6, 4, 9, 40].map(meshOf)).toEqual([0.2, 2, 5, 20]);
  });
});

describe("steering", () => {
  it("glides on with no key held", () => {
    expect(commands(new Set(), null)).toEqual({ turn: 0, pitch: 0, speed: 1, brake: 0, mouth: 0 });
  });

  it("turns left and right, up and down, by keys", () => {
    expect(commands(new Set(["a"]), null).turn).toBeGreaterThan(0.5);
    expect(commands(new Set(["arrowright"]), null).turn).toBeLessThan(-0.5);
    expect(commands(new Set(["a", "d"]), null).turn).toBe(0);
    expect(commands(new Set(["r"]), null).pitch).toBeGreaterThan(0);
    expect(commands(new Set(["w"]), null).speed).toBeGreaterThan(2);
    expect(commands(new Set(["s"]), null)).toMatchObject({ brake: 1 });
    expect(commands(new Set(["e"]), null).mouth).toBe(1);
  });

  it("turns to where the mouse is: right of the middle is to the right, above it up", () => {
    const steered = commands(new Set(), [0.5, -0.5]);
    expect(steered.turn).toBeLessThan(0);
    expect(steered.pitch).toBeGreaterThan(0);
  });

  it("stays within what the world takes", () => {
    const { turn, pitch, speed } = commands(new Set(["a", "arrowleft", "r", "w"]), [-1, -1]);
    expect(turn).toBeLessThanOrEqual(1.5);
    expect(pitch).toBeLessThanOrEqual(1.2);
    expect(speed).toBeLessThanOrEqual(4);
  });
});

describe("the file of a view", () => {
  const view = { camera: "free", eye: [1, -2, 3.25], target: [0, -3, 0] } as const;

  it("says again what it was made from", () => {
    const text = formatView({ camera: view.camera, eye: [...view.eye], target: [...view.target] });
    expect(parseView(text)).toEqual({ bioscope: "view", ...view });
  });

  it.each([
    "",
    "null",
    "[]",
    '{"bioscope":"view"}',
    '{"bioscope":"view","camera":"free","eye":[1,2],"target":[0,0,0]}',
    '{"bioscope":"view","camera":"free","eye":[1,2,1e99],"target":[0,0,0]}',
  ])("is refused where it is none: %s", (text) => {
    expect(parseView(text)).toBeNull();
  });
});
