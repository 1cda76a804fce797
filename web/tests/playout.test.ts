import { describe, expect, it } from "vitest";
import type { BatchLayout, Frame } from "../src/messages/types";
import {
  carryOver,
  placeAsLaidOut,
  placeAsMoved,
  placeBetween,
  poseAsMoved,
} from "../src/playout/dequantize";
import { PlayoutQueue } from "../src/playout/queue";

const layout = (transforms: number[], ids: number[]): BatchLayout => ({
  name: "cod",
  species: "cod",
  mesh: 1,
  material: 1,
  alive: true,
  count: ids.length,
  ids: new Uint32Array(ids),
  transforms: new Float32Array(transforms),
  joints: 0,
});

describe("dequantization", () => {
  it("spreads positions over the box and keeps the scale of the layout", () => {
    const places = new Float32Array(8);
    placeAsLaidOut(places, layout([9, 9, 9, 0.5, 0, 0, 0, 1], [1]));
    placeAsMoved(places, {
      box: [-1, 0, 10, 1, 4, 20],
      positions: new Uint16Array([0, 65535, 32768]),
      rotations: new Int16Array([0, 32767, 0, 0]),
    });
    expect(places[0]).toBeCloseTo(-1);
    expect(places[1]).toBeCloseTo(4);
    expect(places[2]).toBeCloseTo(15, 3);
    expect([...places.subarray(3)]).toEqual([0.5, 0, 1, 0, 0]);
  });

  it("a joint that has not left its rest moves nothing, one that has moves by the difference", () => {
    const half = Math.SQRT1_2;
    const rest = new Float32Array([0, 1, 0, 1, 0, half, 0, half]);
    const quantized = (numbers: number[]) =>
      new Int16Array(numbers.map((number) => Math.round(number * 32767)));
    const target = new Float32Array(8);
    poseAsMoved(target, quantized([0, 0.5, 0, 0, half, 0, half]), 2, rest);
    expect(target[0]).toBeCloseTo(0, 3);
    expect(target[1]).toBeCloseTo(0, 3);
    expect(target[7]).toBeCloseTo(1, 3);
    poseAsMoved(target, quantized([0.25, 0.5, 0, 0, 0, 0, 1]), 2, rest);
    expect(target[5]).toBeCloseTo(-half, 3);
    expect(target[7]).toBeCloseTo(half, 3);
    expect(target[0]).toBeCloseTo(0.5, 3); // the joint lies on the axis of the turn
    expect(target[1]).toBeCloseTo(0, 3);
  });

  it("takes the shorter way between two rotations", () => {
    const older = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1]);
    const newer = new Float32Array([2, 0, 0, 1, 0, 0, 0, -1]);
    const between = new Float32Array(8);
    placeBetween(between, older, newer, 0, 0.25);
    expect(between[0]).toBeCloseTo(0.5);
    expect(Math.abs(between[7])).toBeCloseTo(1);
  });

  it("carries individuals over to another layout by identity", () => {
    const from = {
      places: new Float32Array([...Array(8).fill(1), ...Array(8).fill(2)]),
      poses: new Float32Array(),
    };
    const to = { places: new Float32Array(24).fill(9), poses: new Float32Array() };
    carryOver(to, new Uint32Array([6, 7, 5]), from, new Uint32Array([5, 6]), 0);
    expect([to.places[0], to.places[8], to.places[16]]).toEqual([2, 9, 1]);
    carryOver(to, new Uint32Array([5, 5, 5]), from, new Uint32Array([5, 5]), 0);
    expect([to.places[0], to.places[8], to.places[16]]).toEqual([1, 2, 1]);
  });

  it("takes sizes as frames give them", () => {
    const places = new Float32Array(16);
    placeAsMoved(places, { size: [1, 3], scales: new Uint16Array([0, 65535]) });
    expect([places[3], places[11]]).toEqual([1, 3]);
  });
});

const frame = (tick: number): Frame => ({
  type: "frame",
  layout: 1,
  tick,
  time: tick / 60,
  running: true,
  speed: 1,
  rate: 60,
  moving: {},
  drifting: {},
});

describe("PlayoutQueue", () => {
  it("shows a steady stream without jumps, at the speed at which it came", () => {
    const queue = new PlayoutQueue();
    const shown: number[] = [];
    let before = 0;
    for (let now = 0, sent = 0; now < 4000; now += 1000 / 60) {
      while (sent * (1000 / 30) <= now) queue.push(frame(2 * sent++), now);
      const moment = queue.at(now);
      if (!moment) continue;
      if (moment.fresh) before = Math.max(0, moment.frame.tick - 2);
      shown.push(before + (moment.frame.tick - before) * moment.blend);
    }
    const steps = shown.slice(-100).map((tick, index, all) => (index === 0 ? 1 : tick - all[index - 1]));
    expect(Math.min(...steps)).toBeGreaterThan(0.7);
    expect(Math.max(...steps)).toBeLessThan(1.3);
  });

  it("shows a single step soon and completely", () => {
    const queue = new PlayoutQueue();
    queue.push(frame(10), 0);
    queue.at(0);
    queue.push(frame(11), 10_000);
    expect(queue.at(10_000)?.frame.tick).toBe(11);
    expect(queue.at(10_200)?.blend).toBe(1);
  });

  it("cuts when time leaps or runs back", () => {
    const queue = new PlayoutQueue();
    queue.push(frame(600), 0);
    queue.at(0);
    queue.push(frame(30), 500);
    expect(queue.at(600)).toMatchObject({ cut: true, blend: 1 });
  });

  it("never lets frames pile up", () => {
    const queue = new PlayoutQueue();
    for (let tick = 0; tick < 1000; tick++) queue.push(frame(tick), tick);
    expect(queue.coming.length).toBeLessThan(10);
  });
});
