import { describe, expect, it } from "vitest";
import { factor, solve } from "../src/contour/cholesky";
import { ContourMesh, type Point } from "../src/contour/mesh";
import { contentBox, type Feature, type Picture, Potential, pictureOf } from "../src/contour/picture";
import { Relaxation } from "../src/contour/relaxation";
import { asText, folds, textureTable } from "../src/contour/table";

const [WIDTH, HEIGHT] = [240, 160];
const CENTER: Point = [120, 80];

/** A picture whose pixels are shaded by a function of their place, 0 to 1. */
function drawn(shade: (x: number, y: number) => number): Picture {
  const pixels = new Uint8ClampedArray(4 * WIDTH * HEIGHT);
  for (let pixel = 0; pixel < WIDTH * HEIGHT; pixel++) {
    const value = 255 * shade((pixel % WIDTH) + 0.5, Math.floor(pixel / WIDTH) + 0.5);
    pixels.set([value, value, value, 255], 4 * pixel);
  }
  return pictureOf(pixels, WIDTH, HEIGHT);
}

/** Half the height of a fish-like body at a place along it, −1 (snout) to 1 (root of the tail); 0 outside. */
const profile = (u: number) => (Math.abs(u) < 1 ? 46 * Math.sqrt(1 - u * u) * (1 - 0.32 * u) : 0);

/** Distance in pixels to the outline, found by walking along it. */
function distanceToOutline([x, y]: Point): number {
  let nearest = Number.POSITIVE_INFINITY;
  for (let at = 0; at < 4000; at++) {
    const u = -Math.cos((Math.PI * at) / 3999);
    for (const side of [-1, 1]) {
      const [edgeX, edgeY] = [CENTER[0] + 90 * u, CENTER[1] + side * profile(u)];
      nearest = Math.min(nearest, Math.hypot(x - edgeX, y - edgeY));
    }
  }
  return nearest;
}

/** A striped body on a mottled ground. */
const fish = drawn((x, y) => {
  const inside = Math.abs(y - CENTER[1]) < profile((x - CENTER[0]) / 90);
  const stripes = 0.12 * Math.sin(x / 5);
  return inside ? 0.75 + stripes : 0.2 + 0.05 * Math.sin(x / 9) * Math.sin(y / 7);
});

function border(mesh: ContourMesh): number[] {
  return [...Array(mesh.rows * mesh.columns).keys()].filter((node) => mesh.isBorder(node));
}

function settle(mesh: ContourMesh, picture: Picture, widest = 12, feature: Feature = "edges"): Relaxation {
  const relaxation = new Relaxation(picture, feature, widest);
  for (let step = 0; step < 6000 && !relaxation.done; step++) relaxation.step(mesh);
  return relaxation;
}

function settled(widest = 12): ContourMesh {
  const mesh = new ContourMesh(9, 21);
  mesh.lay(contentBox(fish));
  settle(mesh, fish, widest);
  return mesh;
}

describe("a contour mesh", { timeout: 60_000 }, () => {
  it("locks its border to the outline within two pixels, even and without folds inside", () => {
    const mesh = settled();
    for (const node of border(mesh))
      expect(distanceToOutline(mesh.point(node)), `node ${node}`).toBeLessThan(2);
    expect(folds(mesh)).toBe(0);
    // Smooth: an inner node is near the middle of its four neighbors.
    for (let row = 1; row < 8; row++) {
      for (let column = 1; column < 20; column++) {
        const around = [mesh.node(row - 1, column), mesh.node(row + 1, column), mesh.node(row, column - 1)];
        const points = [...around, mesh.node(row, column + 1)].map((node) => mesh.point(node));
        const [x, y] = mesh.point(mesh.node(row, column));
        const [sumX, sumY] = points.reduce(([sx, sy], [px, py]) => [sx + px, sy + py]);
        expect(Math.hypot(x - sumX / 4, y - sumY / 4)).toBeLessThan(1);
      }
    }
  });

  it("catches from further away the wider the potential", () => {
    const far = (widest: number): number => {
      const mesh = new ContourMesh(2, 12);
      const line = drawn((_x, y) => (y < 80 ? 0.2 : 0.8));
      mesh.lay([30, 56, 210, 62]);
      mesh.strengths = { tension: 0, rigidity: 0, picture: 6, cursor: 0, anchor: 0 };
      settle(mesh, line, widest);
      return Math.max(...border(mesh).map((node) => Math.abs(mesh.point(node)[1] - 80)));
    };
    expect(far(2)).toBeGreaterThan(15);
    expect(far(10)).toBeLessThan(1);
  });

  it("follows the cursor, and lets the outline have the node back", () => {
    const mesh = settled();
    const node = mesh.node(0, 10);
    const [x, y] = mesh.point(node);
    const potential = new Potential(fish, "edges", 4);
    mesh.hold(node, [x, y - 9]);
    for (let step = 0; step < 100; step++) mesh.step(potential);
    expect(Math.hypot(mesh.point(node)[0] - x, mesh.point(node)[1] - (y - 9))).toBeLessThan(2);
    mesh.release();
    for (let step = 0; step < 300; step++) mesh.step(potential);
    expect(distanceToOutline(mesh.point(node))).toBeLessThan(2);
  });

  it("keeps an anchored node near its anchor against the picture", () => {
    const mesh = new ContourMesh(9, 21);
    mesh.lay(contentBox(fish));
    const node = mesh.node(8, 6);
    const place: Point = [80, 138];
    mesh.anchor(node, place);
    settle(mesh, fish);
    expect(Math.hypot(mesh.point(node)[0] - 80, mesh.point(node)[1] - 138)).toBeLessThan(1.5);
    expect(distanceToOutline(place)).toBeGreaterThan(8);
    mesh.anchor(node, undefined);
    settle(mesh, fish);
    expect(distanceToOutline(mesh.point(node))).toBeLessThan(2);
  });

  it("settles on dark and on bright lines as well as on edges", () => {
    for (const [feature, line] of [
      ["dark lines", 0.1],
      ["bright lines", 0.9],
    ] as const) {
      const mesh = new ContourMesh(2, 12);
      const picture = drawn((_x, y) => (Math.abs(y - 60) < 1.5 || Math.abs(y - 100) < 1.5 ? line : 0.5));
      mesh.lay([30, 55, 210, 106]);
      settle(mesh, picture, 6, feature);
      for (let column = 0; column < 12; column++) {
        expect(mesh.point(mesh.node(0, column))[1]).toBeCloseTo(60, 0);
        expect(mesh.point(mesh.node(1, column))[1]).toBeCloseTo(100, 0);
      }
    }
  });

  it("fits fins with two rows of twelve", () => {
    const top = (x: number) => 60 - 22 * Math.sin((Math.PI * (x - 40)) / 160);
    const fin = drawn((x, y) => (x > 40 && x < 200 && y > top(x) && y < 110 ? 0.8 : 0.25));
    const mesh = new ContourMesh(2, 12);
    mesh.lay(contentBox(fin));
    settle(mesh, fin);
    for (let column = 1; column < 11; column++) {
      const [x, y] = mesh.point(mesh.node(0, column));
      expect(Math.abs(y - top(x))).toBeLessThan(2);
      expect(Math.abs(mesh.point(mesh.node(1, column))[1] - 110)).toBeLessThan(2);
    }
    const table = textureTable(mesh, WIDTH, HEIGHT);
    expect([table.coordinates.length, table.coordinates[0].length]).toEqual([2, 12]);
  });

  it("refuses sizes that make no mesh, and is stable for any strengths", () => {
    for (const [rows, columns] of [
      [1, 5],
      [5, 1],
      [400, 400],
      [Number.NaN, 4],
    ]) {
      expect(() => new ContourMesh(rows, columns)).toThrow(/expected 2 × 2/);
    }
    const mesh = new ContourMesh(9, 21);
    mesh.lay(contentBox(fish));
    mesh.strengths = { tension: 1e4, rigidity: 1e4, picture: 1e4, cursor: 1e4, anchor: 1e4 };
    mesh.hold(4, [-500, 900]);
    const potential = new Potential(fish, "edges", 3);
    for (let step = 0; step < 50; step++) mesh.step(potential);
    for (const one of mesh.positions) expect(one >= 0 && one <= WIDTH).toBe(true);
  });
});

describe("texture coordinates", () => {
  it("are shares of the picture, one line per node", () => {
    const mesh = new ContourMesh(3, 5);
    mesh.lay([0, 0, WIDTH, HEIGHT]);
    const table = textureTable(mesh, WIDTH, HEIGHT);
    expect(table.coordinates[0][0]).toEqual([0, 0]);
    expect(table.coordinates[2][4]).toEqual([1, 1]);
    expect(table.coordinates[1][2]).toEqual([0.5, 0.5]);
    const lines = asText(table).trim().split("\n");
    expect(lines).toHaveLength(16);
    expect(lines[0]).toBe("row,column,s,t");
    expect(lines[8]).toBe("1,2,0.500000,0.500000");
  });

  it("tell of folds", () => {
    const mesh = new ContourMesh(3, 3);
    mesh.lay([0, 0, 20, 20]);
    expect(folds(mesh)).toBe(0);
    mesh.positions[2 * mesh.node(1, 1)] = 45;
    expect(folds(mesh)).toBeGreaterThan(0);
  });
});

describe("the solver", () => {
  it("solves and refuses what is not positive definite", () => {
    const lower = factor(new Float64Array([4, 2, 2, 3]), 2, 1);
    const values = new Float64Array([10, 9]);
    solve(lower, 2, 1, values);
    expect([...values].map((one) => Number(one.toFixed(12)))).toEqual([1.5, 2]);
    expect(() => factor(new Float64Array([1, 2, 2, 1]), 2, 1)).toThrow(RangeError);
  });
});

describe("a picture without content", () => {
  it("leaves the mesh where it is", () => {
    const blank = drawn(() => 0.5);
    const mesh = new ContourMesh(9, 21);
    mesh.lay(contentBox(blank));
    settle(mesh, blank);
    expect(contentBox(blank)).toEqual([24, 16, 216, 144]);
    expect(mesh.point(0)[0]).toBeCloseTo(24, 3);
    expect(mesh.point(188)[1]).toBeCloseTo(144, 3);
  });
});
