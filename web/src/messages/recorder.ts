import { encode } from "@msgpack/msgpack";
import type { Layout, Message } from "./types";
import { usedAssets } from "./usage";

/** Frames kept: one minute at 30 a second. */
const MOST_FRAMES = 1800;
/** Bytes kept at most, assets not counted. */
const MOST_BYTES = 64 * 1024 * 1024;
/** Old entries go when there are this many times too many, all at once. */
const SLACK = 1.1;
/** Layouts between two searches for assets that are no longer needed. */
const LAYOUTS_BETWEEN = 32;

/** A recording as it is stored: the world's own messages, each with the world time at which it came. */
export interface Recording {
  hello: Uint8Array;
  assets: Uint8Array[];
  layouts: [number, Uint8Array][];
  parameters: Uint8Array | null;
  entries: [number, number | null, number, Uint8Array][];
}

/** World time in seconds, tick (null: no frame), layout revision of the frame, message. */
type Entry = [number, number | null, number, Uint8Array];

interface Asset {
  bytes: Uint8Array;
  /** Keys of meshes or of the texture it needs. */
  needs: number[];
  /** Came after the latest layout, so its first use is still ahead. */
  fresh: boolean;
}

/** Keeps what was received lately, in bounded memory, so that it can be saved at any moment. */
export class Recorder {
  private hello: Uint8Array | null = null;
  private parameters: Uint8Array | null = null;
  private assets = new Map<string, Asset>();
  private layouts = new Map<number, { layout: Layout; bytes: Uint8Array }>();
  private entries: Entry[] = [];
  private frames = 0;
  private bytes = 0;
  private changes = 0;
  private time = 0;
  private tick = -1;

  /** Frames that a recording saved now would hold. */
  get length(): number {
    return this.frames;
  }

  /** Bytes held, assets included. */
  get size(): number {
    let size = this.bytes;
    for (const asset of this.assets.values()) size += asset.bytes.byteLength;
    return size;
  }

  note(message: Message, bytes: Uint8Array): void {
    const rule = RULES[message.type] as
      | ((recorder: Recorder, message: Message, bytes: Uint8Array) => void)
      | undefined;
    rule?.(this, message, bytes);
  }

  /** The recording as one MessagePack map; null before the first frame. */
  save(): Uint8Array | null {
    if (!this.hello || this.frames === 0) return null;
    this.forget();
    const recording: Recording = {
      hello: this.hello,
      assets: [...this.assets.values()].map((asset) => asset.bytes),
      layouts: [...this.layouts].map(([revision, one]) => [revision, one.bytes]),
      parameters: this.parameters,
      entries: this.entries,
    };
    return encode(recording);
  }

  /** A new session with the world: nothing of the old one fits it. */
  begin(bytes: Uint8Array): void {
    this.hello = bytes;
    this.assets.clear();
    this.layouts.clear();
    this.restart();
  }

  keepAsset(name: string, bytes: Uint8Array, needs: number[]): void {
    this.assets.set(name, { bytes, needs, fresh: true });
  }

  keepLayout(layout: Layout, bytes: Uint8Array): void {
    this.layouts.set(layout.revision, { layout, bytes });
    for (const asset of this.assets.values()) asset.fresh = false;
    if (++this.changes % LAYOUTS_BETWEEN === 0) this.forget();
  }

  keepParameters(bytes: Uint8Array): void {
    this.parameters = bytes;
  }

  keepFrame(tick: number, time: number, layout: number, bytes: Uint8Array): void {
    if (tick === this.tick) return;
    if (tick < this.tick) this.restart();
    this.tick = tick;
    this.time = time;
    this.frames += 1;
    this.add([time, tick, layout, bytes]);
  }

  keepOther(bytes: Uint8Array): void {
    this.add([this.time, null, 0, bytes]);
  }

  private restart(): void {
    this.entries = [];
    this.frames = 0;
    this.bytes = 0;
    this.tick = -1;
  }

  private add(entry: Entry): void {
    this.entries.push(entry);
    this.bytes += entry[3].byteLength;
    if (this.frames <= SLACK * MOST_FRAMES && this.bytes <= SLACK * MOST_BYTES) return;
    let first = 0;
    while (first < this.entries.length - 1 && (this.frames > MOST_FRAMES || this.bytes > MOST_BYTES)) {
      const old = this.entries[first++];
      this.bytes -= old[3].byteLength;
      if (old[1] !== null) this.frames -= 1;
    }
    this.entries.splice(0, first);
  }

  private forget(): void {
    const latest = Math.max(...this.layouts.keys());
    const shown = new Set(this.entries.map((entry) => entry[2]));
    for (const revision of this.layouts.keys()) {
      if (revision !== latest && !shown.has(revision)) this.layouts.delete(revision);
    }
    const needs = (name: string) => this.assets.get(name)?.needs ?? [];
    const links = {
      meshLevels: (key: number) => needs(`mesh:${key}`),
      materialTexture: (key: number) => needs(`material:${key}`)[0] ?? null,
    };
    const used = new Set<string>();
    for (const { layout } of this.layouts.values()) {
      for (const name of usedAssets(layout, links)) used.add(name);
    }
    for (const [name, asset] of this.assets) {
      if (!asset.fresh && !used.has(name)) this.assets.delete(name);
    }
  }
}

type Of<K extends Message["type"]> = Extract<Message, { type: K }>;

/** What to do with each kind of message; kinds that are missing are not recorded. */
const RULES: { [K in Message["type"]]?: (recorder: Recorder, message: Of<K>, bytes: Uint8Array) => void } = {
  hello: (recorder, _message, bytes) => recorder.begin(bytes),
  mesh: (recorder, mesh, bytes) =>
    recorder.keepAsset(
      `mesh:${mesh.key}`,
      bytes,
      mesh.levels.map(([, key]) => key),
    ),
  texture: (recorder, texture, bytes) => recorder.keepAsset(`texture:${texture.key}`, bytes, []),
  material: (recorder, material, bytes) =>
    recorder.keepAsset(
      `material:${material.key}`,
      bytes,
      material.texture === null ? [] : [material.texture],
    ),
  batch: (recorder, batch, bytes) => recorder.keepAsset(`batch:${batch.key}`, bytes, []),
  layout: (recorder, layout, bytes) => recorder.keepLayout(layout, bytes),
  frame: (recorder, frame, bytes) => recorder.keepFrame(frame.tick, frame.time, frame.layout, bytes),
  parameters: (recorder, _message, bytes) => recorder.keepParameters(bytes),
  events: (recorder, _message, bytes) => recorder.keepOther(bytes),
  statistics: (recorder, _message, bytes) => recorder.keepOther(bytes),
  inspection: (recorder, _message, bytes) => recorder.keepOther(bytes),
};
