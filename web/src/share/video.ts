import {
  BufferTarget,
  CanvasSource,
  getFirstEncodableVideoCodec,
  Mp4OutputFormat,
  Output,
  QUALITY_HIGH,
  WebMOutputFormat,
} from "mediabunny";
import type { Frame } from "../messages/types";

/** Pictures per second of world time. */
export const FRAMES_PER_SECOND = 30;
/** A video ends by itself after this many seconds, for it is kept in memory. */
const LONGEST = 120;
/** Milliseconds to wait for the world's next frame. */
const PATIENCE = 4000;

/** What a video needs of the page. */
export interface Studio {
  canvas: HTMLCanvasElement;
  /** Seconds per tick. */
  dt: number;
  /** Number of the tick on the screen. */
  tick: number;
  step(ticks: number): void;
  /** Draws a frame exactly as it is, this many seconds after the one before. */
  draw(frame: Frame, seconds: number): void;
  progress(seconds: number): void;
}

/** A video at a fixed rate: the world goes on by one picture's time, is drawn, encoded, and goes on. */
export class Video {
  private stopped = false;
  private arrived: ((frame: Frame) => void) | null = null;

  constructor(private readonly studio: Studio) {}

  stop(): void {
    this.stopped = true;
  }

  /** A frame has come from the world. */
  take(frame: Frame): void {
    this.arrived?.(frame);
  }

  /** Records until stopped; gives the file, null if this browser cannot encode video. */
  async record(): Promise<{ content: Blob; extension: string; seconds: number } | null> {
    const { canvas } = this.studio;
    const size = { width: canvas.width, height: canvas.height };
    const mp4 = await getFirstEncodableVideoCodec(["avc", "hevc"], size);
    const codec = mp4 ?? (await getFirstEncodableVideoCodec(["vp9", "vp8", "av1"], size));
    if (!codec) return null;
    const target = new BufferTarget();
    const format = mp4 ? new Mp4OutputFormat() : new WebMOutputFormat();
    const output = new Output({ format, target });
    const source = new CanvasSource(canvas, { codec, quality: QUALITY_HIGH, sizeChangeBehavior: "contain" });
    output.addVideoTrack(source, { frameRate: FRAMES_PER_SECOND });
    await output.start();
    let count = 0;
    while (!this.stopped && count < LONGEST * FRAMES_PER_SECOND) {
      const frame = await this.nextFrame();
      if (!frame) break;
      this.studio.draw(frame, 1 / FRAMES_PER_SECOND);
      await source.add(count / FRAMES_PER_SECOND, 1 / FRAMES_PER_SECOND);
      this.studio.progress(++count / FRAMES_PER_SECOND);
    }
    await output.finalize();
    const type = mp4 ? "video/mp4" : "video/webm";
    const content = new Blob([target.buffer ?? new ArrayBuffer(0)], { type });
    return { content, extension: mp4 ? "mp4" : "webm", seconds: count / FRAMES_PER_SECOND };
  }

  /** Asks the world for the next picture's time; null if it does not answer. */
  private nextFrame(): Promise<Frame | null> {
    const ticks = Math.max(1, Math.round(1 / (FRAMES_PER_SECOND * this.studio.dt)));
    const from = this.studio.tick;
    return new Promise((resolve) => {
      const timer = window.setTimeout(() => finish(null), PATIENCE);
      const finish = (frame: Frame | null) => {
        window.clearTimeout(timer);
        this.arrived = null;
        resolve(frame);
      };
      this.arrived = (frame) => {
        if (frame.tick > from && !frame.running) finish(frame);
      };
      this.studio.step(ticks);
    });
  }
}
