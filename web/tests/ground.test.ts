import { expect, test } from "vitest";
import { facesUp, Ground } from "../src/scene/ground";

/** A square tile of side 10 from a corner, which rises by `slope` per metre of x. */
function tile(x: number, z: number, slope: number) {
  const corners = [
    [x, z],
    [x + 10, z],
    [x + 10, z + 10],
    [x, z + 10],
  ];
  return {
    positions: Float32Array.from(corners.flatMap(([east, south]) => [east, slope * east - 5, south])),
    triangles: Uint32Array.from([0, 2, 1, 0, 3, 2]),
  };
}

test("all tiles are the ground, and it slopes evenly between its points", () => {
  const ground = new Ground();
  ground.take([tile(-10, 0, 0.1), tile(0, 0, 0.1), tile(0, -10, 0.1)]);
  for (const [x, z] of [
    [-9.3, 4],
    [3.21, 9.9],
    [7.7, -6.1],
    [-0.3, 3],
  ])
    expect(ground.heightAt(x, z)).toBeCloseTo(0.1 * x - 5, 3);
  expect(ground.heightAt(-5, -5)).toBe(-Infinity);
  expect(ground.heightAt(11, 0)).toBe(-Infinity);
});

test("of two sheets the upper one is the ground, and other tiles replace it", () => {
  const ground = new Ground();
  const [low, high] = [tile(0, 0, 0), tile(0, 0, 0)];
  for (let i = 1; i < high.positions.length; i += 3) high.positions[i] = -2;
  ground.take([low, high]);
  expect(ground.heightAt(5, 5)).toBeCloseTo(-2);
  ground.take([low]);
  expect(ground.heightAt(5, 5)).toBeCloseTo(-5);
  ground.take([]);
  expect(ground.heightAt(5, 5)).toBe(-Infinity);
});

test("what is narrow or flat as a line is no ground", () => {
  const ground = new Ground();
  const line = {
    positions: Float32Array.from([0, 0, 0, 9, 1, 0, 9, 2, 0]),
    triangles: Uint32Array.from([0, 1, 2]),
  };
  ground.take([line]);
  expect(ground.heightAt(4, 0)).toBe(-Infinity);
});

test("sheets seen from above are ground, walls and bodies are not", () => {
  const sheet = tile(0, 0, 0.5);
  expect(facesUp(sheet)).toBe(true);
  expect(
    facesUp({ ...sheet, triangles: sheet.triangles.map((_, i, all) => all[i - (i % 3) + 2 - (i % 3)]) }),
  ).toBe(false);
  const wall = {
    positions: Float32Array.from([0, 0, 0, 9, 0, 0, 9, 3, 0]),
    triangles: Uint32Array.from([0, 1, 2]),
  };
  expect(facesUp(wall)).toBe(false);
  const body = { ...sheet, triangles: Uint32Array.from([...sheet.triangles, 0, 1, 2]) };
  expect(facesUp(body)).toBe(false);
});
