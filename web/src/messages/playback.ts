import { decode } from "@msgpack/msgpack";
import type { Command } from "./commands";
import { decodeMessage } from "./decode";
import type { Recording } from "./recorder";
import type { Listener, Transport } from "./transport";
import type { Frame, Message } from "./types";

/** Milliseconds between looks at the clock. */
const BEAT = 15;

/** A recording that plays by itself, in place of a world. */
export class Playback implements Transport {
  readonly kind = "recording";
  private readonly recording: Recording;
  /** Numbers of the entries that are frames. */
  private readonly frames: number[] = [];
  private readonly layouts: Map<number, Uint8Array>;
  private listener: Listener | null = null;
  private timer: number | undefined;
  private running = true;
  private speed = 1;
  /** World time, seconds. */
  private time = 0;
  /** First entry not yet shown. */
  private next = 0;
  private revision = -1;
  private clock = 0;

  constructor(bytes: Uint8Array) {
    this.recording = decode(bytes) as Recording;
    this.recording.entries.forEach((entry, index) => {
      if (entry[1] !== null) this.frames.push(index);
    });
    this.layouts = new Map(this.recording.layouts);
  }

  open(listener: Listener): void {
    this.listener = listener;
    listener.link({ state: "open" });
    this.emit(this.recording.hello);
    for (const asset of this.recording.assets) this.emit(asset);
    if (this.recording.parameters) this.emit(this.recording.parameters);
    const tick = (index: number) => this.recording.entries[this.frames[index]][1] as number;
    const last = tick(this.frames.length - 1);
    listener.message({ type: "timeline", first: tick(0), last }, new Uint8Array());
    this.show(0);
    this.clock = performance.now();
    this.timer = window.setInterval(() => this.beat(), BEAT);
  }

  send(command: Command): void {
    (ANSWERS[command.do] as ((playback: Playback, command: Command) => void) | undefined)?.(this, command);
  }

  reconnect(): void {}

  close(): void {
    window.clearInterval(this.timer);
  }

  play(): void {
    if (this.next >= this.recording.entries.length) this.show(0);
    this.running = true;
    this.again();
  }

  pause(): void {
    this.running = false;
    this.again();
  }

  setSpeed(factor: number): void {
    this.speed = factor;
    this.again();
  }

  /** Goes to the frame at or after a tick. */
  seek(tick: number): void {
    const index = this.frames.findIndex((one) => (this.recording.entries[one][1] as number) >= tick);
    this.show(index < 0 ? this.frames.length - 1 : index);
  }

  /** Stands still and goes by some frames. */
  step(ticks: number): void {
    this.running = false;
    const entry = this.recording.entries[this.current()];
    const target = (entry[1] as number) + ticks;
    if (ticks >= 0) this.seek(target);
    else {
      const index = this.frames.findLastIndex((one) => (this.recording.entries[one][1] as number) <= target);
      this.show(Math.max(0, index));
    }
  }

  tell(text: string): void {
    this.listener?.message({ type: "notice", level: "info", text }, new Uint8Array());
  }

  private current(): number {
    return this.frames.findLast((one) => one < this.next) ?? this.frames[0];
  }

  private show(frame: number): void {
    const index = this.frames[frame];
    this.time = this.recording.entries[index][0];
    this.next = index + 1;
    this.frame(index);
  }

  private again(): void {
    this.frame(this.current());
  }

  private beat(): void {
    const now = performance.now();
    const passed = Math.min(0.25, (now - this.clock) / 1000);
    this.clock = now;
    if (!this.running) return;
    this.time += passed * this.speed;
    const entries = this.recording.entries;
    while (this.next < entries.length && entries[this.next][0] <= this.time) {
      const index = this.next++;
      if (entries[index][1] === null) this.emit(entries[index][3]);
      else this.frame(index);
    }
    if (this.next >= entries.length) this.pause();
  }

  private frame(index: number): void {
    const [, , revision, bytes] = this.recording.entries[index];
    if (revision !== this.revision) {
      const layout = this.layouts.get(revision);
      if (layout) this.emit(layout);
      this.revision = revision;
    }
    const frame = decodeMessage(bytes) as Frame;
    const changed: Message = { ...frame, running: this.running, speed: this.speed };
    this.listener?.message(changed, bytes);
  }

  private emit(bytes: Uint8Array): void {
    const message = decodeMessage(bytes);
    if (message) this.listener?.message(message, bytes);
  }
}

const fixed = (playback: Playback) =>
  playback.tell("This is a recording: its world cannot be changed. Run it with bioscope live.");

/** How a recording answers each command; commands that are missing need no answer. */
const ANSWERS: { [K in Command["do"]]?: (playback: Playback, command: Extract<Command, { do: K }>) => void } =
  {
    play: (playback) => playback.play(),
    pause: (playback) => playback.pause(),
    step: (playback, { ticks }) => playback.step(ticks),
    back: (playback, { ticks }) => playback.step(-ticks),
    seek: (playback, { tick }) => playback.seek(tick),
    speed: (playback, { factor }) => playback.setSpeed(factor ?? 16),
    restart: (playback) => playback.seek(0),
    set: fixed,
    resize: fixed,
    remove: fixed,
    place: fixed,
    trait: fixed,
    steer: fixed,
    add: fixed,
    display: fixed,
    script: fixed,
    "play script": fixed,
    snapshot: fixed,
  };
