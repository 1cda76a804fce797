import type { Steering as Motor } from "../messages/commands";
import type { Session } from "../messages/session";

/** What each key adds to the commands, by `KeyboardEvent.key` in lower case. */
const KEYS: Record<string, Partial<Motor>> = {
  a: { turn: 0.9 },
  arrowleft: { turn: 0.9 },
  d: { turn: -0.9 },
  arrowright: { turn: -0.9 },
  r: { pitch: 0.7 },
  arrowup: { pitch: 0.7 },
  f: { pitch: -0.7 },
  arrowdown: { pitch: -0.7 },
  w: { speed: 2.5 },
  s: { speed: -1.4, brake: 1 },
  e: { mouth: 1 },
};
/** Speed with no key held, body lengths per second: it glides on. */
const GLIDE = 1;
/** Angles at the edge of the picture when steered by mouse, radians. */
const AT_EDGE: [number, number] = [1.2, 0.9];
/** Milliseconds between two commands. */
const PAUSE = 60;

/** What the keys held and the mouse (from the middle of the picture, −1 to 1, right and down) command. */
export function commands(keys: ReadonlySet<string>, mouse: readonly [number, number] | null): Motor {
  const sum: Motor = { turn: 0, pitch: 0, speed: GLIDE, brake: 0, mouth: 0 };
  for (const key of keys) {
    const added = KEYS[key] ?? {};
    for (const name of Object.keys(added) as (keyof Motor)[]) sum[name] += added[name] ?? 0;
  }
  if (mouse) {
    sum.turn -= AT_EDGE[0] * mouse[0];
    sum.pitch -= AT_EDGE[1] * mouse[1];
  }
  const within = (value: number, most: number) => Math.min(most, Math.max(-most, value));
  return {
    turn: within(sum.turn, 1.5),
    pitch: within(sum.pitch, 1.2),
    speed: within(sum.speed, 4),
    brake: within(sum.brake, 1),
    mouth: within(sum.mouth, 1),
  };
}

/** A person in place of a fish's mind. */
export class Steering {
  /** Who is steered; 0 for nobody. */
  id = 0;
  /** Called when somebody is steered or released. */
  changed: (id: number) => void = () => {};
  private readonly keys = new Set<string>();
  private mouse: [number, number] | null = null;
  private sent = "";
  private timer: number | undefined;

  constructor(
    private readonly session: Session,
    private readonly selected: () => number,
  ) {
    session.on("hello", () => this.stop());
  }

  /** Takes the place of the selected animal's mind. */
  begin(): void {
    const id = this.selected();
    if (id === 0 || id === this.id) return;
    this.end();
    this.id = id;
    this.timer = window.setInterval(() => this.send(), PAUSE);
    this.send();
    this.changed(id);
  }

  /** Gives the animal back to its mind; says whether one was steered. */
  end(): boolean {
    if (this.id === 0) return false;
    this.session.send({ do: "steer", id: this.id, steering: null });
    this.stop();
    return true;
  }

  toggle(): void {
    if (!this.end()) this.begin();
  }

  /** The steered animal is no more, or the world is another one. */
  stop(): void {
    window.clearInterval(this.timer);
    this.keys.clear();
    this.mouse = null;
    this.sent = "";
    if (this.id === 0) return;
    this.id = 0;
    this.changed(0);
  }

  /** Takes a key; says whether it steers. */
  press(event: KeyboardEvent, down: boolean): boolean {
    const key = event.key.toLowerCase();
    if (this.id === 0 || !(key in KEYS)) return false;
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    if (down) this.keys.add(key);
    else this.keys.delete(key);
    return true;
  }

  /** Keys that are let go elsewhere would stay held. */
  letGo(): void {
    this.keys.clear();
    this.mouse = null;
  }

  /** Steers towards a point in the picture, from its middle, −1 to 1 right and down; null: keys alone. */
  point(at: [number, number] | null): void {
    if (this.id !== 0) this.mouse = at;
  }

  private send(): void {
    const steering = commands(this.keys, this.mouse);
    const text = JSON.stringify(steering);
    if (text === this.sent) return;
    this.sent = text;
    this.session.send({ do: "steer", id: this.id, steering });
  }
}
