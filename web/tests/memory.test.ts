import { decode, encode } from "@msgpack/msgpack";
import { describe, expect, it } from "vitest";
import { decodeMessage } from "../src/messages/decode";
import { Playback } from "../src/messages/playback";
import { Recorder, type Recording } from "../src/messages/recorder";
import type { Frame, Message } from "../src/messages/types";
import { Ring } from "../src/ring";

describe("Ring", () => {
  it("keeps the last rows, in order", () => {
    const ring = new Ring(3, 2);
    for (let row = 0; row < 5; row++) ring.push([row, 10 * row]);
    expect(ring.column(0)).toEqual([2, 3, 4]);
    expect(ring.column(1)).toEqual([20, 30, 40]);
    expect(ring.last(1)).toBe(40);
  });
});

function feed(recorder: Recorder, message: Record<string, unknown>): void {
  const bytes = encode(message);
  recorder.note(decodeMessage(bytes) as Message, bytes);
}

const mesh = (key: number, size = 3) => ({
  type: "mesh",
  key,
  box: [0, 0, 0, 1, 1, 1],
  positions: new Uint8Array(6 * size),
  normals: new Uint8Array(6 * size),
  brightest: 1,
  triangles: new Uint8Array(12),
  levels: [],
});
const layout = (revision: number, key: number) => ({
  type: "layout",
  revision,
  batches: [{ key: -key, name: "x", mesh: key, material: 1 }],
  points: [],
});
const frame = (tick: number, revision: number, size = 0) => ({
  type: "frame",
  layout: revision,
  tick,
  time: tick / 60,
  moving: size ? { x: { box: [0, 0, 0, 1, 1, 1], positions: new Uint8Array(size) } } : {},
  drifting: {},
});

describe("Recorder", () => {
  it("forgets assets that no kept layout uses", () => {
    const recorder = new Recorder();
    feed(recorder, { type: "hello", world: "reef" });
    for (let revision = 1; revision < 3000; revision++) {
      feed(recorder, mesh(revision));
      feed(recorder, layout(revision, revision));
      feed(recorder, frame(revision, revision));
    }
    const saved = decode(recorder.save() as Uint8Array) as Recording;
    expect(saved.assets.length).toBeLessThan(2100);
    expect(saved.layouts.length).toBeLessThan(2100);
    expect(saved.entries.length).toBeLessThan(2100);
  });

  it("stays within its memory however large frames are", () => {
    const recorder = new Recorder();
    feed(recorder, { type: "hello", world: "reef" });
    feed(recorder, layout(1, 1));
    for (let tick = 0; tick < 200; tick++) feed(recorder, frame(tick, 1, 600_000));
    expect(recorder.size).toBeLessThan(75e6);
    expect(recorder.length).toBeGreaterThan(90);
  });

  it("begins anew after a step back in time", () => {
    const recorder = new Recorder();
    feed(recorder, { type: "hello", world: "reef" });
    feed(recorder, layout(1, 1));
    for (const tick of [10, 12, 14, 4, 6]) feed(recorder, frame(tick, 1));
    expect(recorder.length).toBe(2);
  });
});

describe("Playback", () => {
  it("gives back the frames of a recording, forward, back and by seeking", () => {
    const recorder = new Recorder();
    feed(recorder, { type: "hello", world: "reef" });
    feed(recorder, mesh(1));
    feed(recorder, layout(1, 1));
    for (let tick = 0; tick < 20; tick += 2) feed(recorder, frame(tick, 1));
    const seen: Message[] = [];
    const playback = new Playback(recorder.save() as Uint8Array);
    const frames = () => seen.filter((one): one is Frame => one.type === "frame").map((one) => one.tick);
    globalThis.window ??= globalThis as never; // timers
    playback.open({
      message: (message) => seen.push(message),
      link: () => {},
      unreadable: (error) => expect.fail(error.message),
    });
    expect(seen.map((one) => one.type)).toEqual(["hello", "mesh", "timeline", "layout", "frame"]);
    playback.send({ do: "seek", tick: 9 });
    playback.send({ do: "step", ticks: 1 });
    playback.send({ do: "back", ticks: 3 });
    expect(frames()).toEqual([0, 10, 12, 8]);
    expect((seen.at(-1) as Frame).running).toBe(false);
    playback.close();
  });
});
