import type { Frame } from "../messages/types";

/** A pause between frames longer than this (milliseconds) is no rhythm: the next frame follows at once. */
const LONGEST_GAP = 110;
/** Play-out delay in mean intervals between frames. */
const DELAY = 1.6;
/** Frames waiting at most; older ones are skipped. */
const MOST_WAITING = 6;
/** A leap in world time of more than this many seconds is shown as a cut. */
const LONGEST_BLEND = 1.5;

interface Stamped {
  frame: Frame;
  /** Milliseconds at which it should be on the screen, delay not included. */
  stamp: number;
}

/** What to draw now. */
export interface Moment {
  frame: Frame;
  /** 0: where things were in the frame before; 1: where they are in this one. */
  blend: number;
  /** This frame was not drawn before. */
  fresh: boolean;
  /** The frame before must not be blended with this one. */
  cut: boolean;
}

/** Evens out the arrival of frames and says how far to blend between the last two. */
export class PlayoutQueue {
  private waiting: Stamped[] = [];
  private current: Stamped | null = null;
  private before = 0;
  private interval = 1000 / 30;
  private lastArrival = 0;
  private lastStamp = 0;

  /** A frame has come at `now` milliseconds. */
  push(frame: Frame, now: number): void {
    const gap = now - this.lastArrival;
    this.lastArrival = now;
    const steady = gap < LONGEST_GAP;
    if (steady) this.interval += 0.08 * (gap - this.interval);
    const expected = this.lastStamp + this.interval;
    const stamp = steady ? Math.max(this.lastStamp + 1, expected + 0.12 * (now - expected)) : now;
    this.lastStamp = stamp;
    this.waiting.push({ frame, stamp });
    if (this.waiting.length > MOST_WAITING) this.waiting.shift();
  }

  /** Forgets everything: the next frame is a cut. */
  clear(): void {
    this.waiting = [];
    this.current = null;
  }

  /** Frames received that have not been drawn. */
  get coming(): Frame[] {
    return this.waiting.map(({ frame }) => frame);
  }

  /** What to draw at `now` milliseconds; null before the first frame. */
  at(now: number): Moment | null {
    const playhead = now - DELAY * this.interval;
    let fresh = false;
    let cut = false;
    while (this.waiting.length > 0 && this.due(playhead)) {
      const next = this.waiting.shift() as Stamped;
      cut = !this.current || isLeap(this.current.frame, next.frame) || (fresh && cut);
      this.before = this.current ? Math.max(this.current.stamp, next.stamp - LONGEST_GAP) : next.stamp;
      this.current = next;
      fresh = true;
    }
    if (!this.current) return null;
    const span = this.current.stamp - this.before;
    const blend = cut || span <= 0 ? 1 : Math.min(1, Math.max(0, (playhead - this.before) / span));
    return { frame: this.current.frame, blend, fresh, cut };
  }

  /** The frame on the screen gives way once the playhead has passed it. */
  private due(playhead: number): boolean {
    return !this.current || playhead >= this.current.stamp;
  }
}

function isLeap(from: Frame, to: Frame): boolean {
  return to.time < from.time || to.time - from.time > LONGEST_BLEND * Math.max(1, to.speed ?? 8);
}
