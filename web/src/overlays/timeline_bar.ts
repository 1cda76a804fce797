import { colorOf } from "../colors";
import type { Session } from "../messages/session";
import type { Frame, WorldEvent } from "../messages/types";
import { element } from "./dom";

/** Events marked on the bar at most, the latest. */
const MOST_MARKS = 160;
/** Milliseconds between seeks while dragging. */
const SEEK_PAUSE = 80;

/** Where we are in time, how far one may go back, and what happened when. */
export class TimelineBar {
  readonly element;
  private readonly clock = element("span", { class: "bio-clock" });
  private readonly track = element("div", { class: "bio-track" });
  private readonly fill = element("div", { class: "bio-fill" });
  private readonly knob = element("div", { class: "bio-knob" });
  private readonly marks = element("div", { class: "bio-marks" });
  private readonly events: WorldEvent[] = [];
  private first = 0;
  private last = 0;
  private tick = 0;
  private dragging = false;
  private lastSeek = 0;
  private stale = false;

  constructor(private readonly session: Session) {
    this.track.append(this.marks, this.fill, this.knob);
    this.track.title = "drag to go to another time";
    this.element = element("div", { class: "bio-timeline" }, this.clock, this.track);
    session.on("timeline", ({ first, last }) => {
      [this.first, this.last, this.stale] = [first, last, true];
    });
    session.on("events", ({ events }) => {
      this.events.push(...events);
      this.events.splice(0, Math.max(0, this.events.length - MOST_MARKS));
      this.stale = true;
    });
    session.on("hello", () => {
      this.events.length = 0;
      this.first = this.last = 0;
    });
    this.track.addEventListener("pointerdown", (event) => this.grab(event));
    this.track.addEventListener("pointermove", (event) => this.drag(event));
    this.track.addEventListener("pointerup", (event) => this.release(event));
  }

  show(frame: Frame): void {
    this.tick = frame.tick;
    this.last = Math.max(this.last, frame.tick);
    this.clock.textContent = `${clock(frame.time)} · tick ${frame.tick}`;
    if (!this.dragging) this.place(this.share(frame.tick));
    if (this.stale) this.drawMarks();
  }

  private share(tick: number): number {
    return this.last > this.first ? (tick - this.first) / (this.last - this.first) : 1;
  }

  private place(share: number): void {
    const percent = `${(100 * Math.min(1, Math.max(0, share))).toFixed(2)}%`;
    this.fill.style.width = this.knob.style.left = percent;
  }

  private drawMarks(): void {
    this.stale = false;
    const seen = this.events.filter((event) => event.tick >= this.first && event.tick <= this.last);
    this.marks.replaceChildren(
      ...seen.map((event) => {
        const left = (100 * this.share(event.tick)).toFixed(2);
        return element("i", { style: `left:${left}%;background:${colorOf(event.kind)}`, title: event.kind });
      }),
    );
  }

  private grab(event: PointerEvent): void {
    this.dragging = true;
    this.track.setPointerCapture(event.pointerId);
    this.drag(event);
  }

  private drag(event: PointerEvent): void {
    if (!this.dragging) return;
    const box = this.track.getBoundingClientRect();
    const share = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    this.place(share);
    const now = performance.now();
    if (event.type !== "pointerup" && now - this.lastSeek < SEEK_PAUSE) return;
    this.lastSeek = now;
    const tick = Math.round(this.first + share * (this.last - this.first));
    if (tick !== this.tick) this.session.send({ do: "seek", tick });
  }

  private release(event: PointerEvent): void {
    this.drag(event);
    this.dragging = false;
  }
}

/** Seconds as minutes and seconds. */
export function clock(time: number): string {
  const seconds = Math.floor(time);
  const [hours, minutes] = [Math.floor(seconds / 3600), Math.floor(seconds / 60) % 60];
  const two = (number: number) => String(number).padStart(2, "0");
  return `${hours > 0 ? `${hours}:${two(minutes)}` : minutes}:${two(seconds % 60)}`;
}
