import { element, sign } from "../overlays/dom";
import { SIGNS } from "../overlays/signs";

/** Seconds that growth takes from the axiom to the complete plant, if every step comes at once. */
const GROWTH = 5;
/** Shortest and longest time between steps, milliseconds. */
const PAUSE = [60, 400];

/** The step slider and its play button. */
export class GrowthBar {
  readonly element;
  /** Step that is shown; null for the complete plant, whatever number of steps that is. */
  step: number | null = null;
  private length = 0;
  private timer: number | undefined;
  private readonly button = element("button", {
    title: "let it grow, from the axiom to the complete plant (Ctrl-Enter)",
    ariaLabel: "grow",
    data: { action: "grow" },
    onclick: () => this.toggle(),
  });
  private readonly slider = element("input", {
    type: "range",
    min: "0",
    max: "1",
    step: "1",
    ariaLabel: "derivation step",
    oninput: () => this.slide(),
  });
  private readonly label = element("span", { class: "bio-step" });

  /** `changed` is called when another step is to be shown. */
  constructor(private readonly changed: () => void) {
    this.button.append(sign(SIGNS.play));
    this.element = element("div", { class: "bio-growth" }, this.button, this.slider, this.label);
    this.refresh();
  }

  get playing(): boolean {
    return this.timer !== undefined;
  }

  /** How many steps the plant has. */
  setLength(length: number): void {
    this.length = length;
    if (this.step !== null && this.step >= length) this.step = null;
    this.refresh();
  }

  /** Takes the number of steps from a text of which nothing has grown yet. */
  guessLength(text: string): void {
    if (this.length > 0) return;
    const said = /^\s*derivation length:\s*(\w+)/m.exec(text)?.[1] ?? "";
    const named = new RegExp(`^\\s*#define\\s+${said || "-"}\\s+(\\d+)`, "m").exec(text)?.[1];
    this.setLength(Number(named ?? said) || 0);
  }

  /** Goes to half of the steps; says to which. */
  halve(): number {
    this.step = Math.floor((this.step ?? this.length) / 2);
    this.refresh();
    return this.step;
  }

  /** A step has been shown: the next may follow. */
  shown(): void {
    if (!this.playing) return;
    if (this.step === null) this.stop();
    else this.wait();
  }

  toggle(): void {
    if (this.playing) {
      this.stop();
      return;
    }
    if (this.length === 0) return;
    this.button.replaceChildren(sign(SIGNS.pause));
    if (this.step === null) {
      this.step = 0;
      this.refresh();
      this.changed();
    }
    this.wait();
  }

  stop(): void {
    window.clearTimeout(this.timer);
    this.timer = undefined;
    this.button.replaceChildren(sign(SIGNS.play));
  }

  private wait(): void {
    window.clearTimeout(this.timer);
    const pause = Math.min(PAUSE[1], Math.max(PAUSE[0], (1000 * GROWTH) / Math.max(1, this.length)));
    this.timer = window.setTimeout(() => this.advance(), pause);
  }

  private advance(): void {
    const next = (this.step ?? this.length) + 1;
    this.step = next >= this.length ? null : next;
    this.refresh();
    this.changed();
  }

  private slide(): void {
    this.stop();
    const step = Number(this.slider.value);
    this.step = step >= this.length ? null : step;
    this.refresh();
    this.changed();
  }

  private refresh(): void {
    this.slider.max = String(Math.max(1, this.length));
    this.slider.value = String(this.step ?? this.slider.max);
    this.slider.disabled = this.length === 0;
    this.label.textContent = `step ${this.step ?? this.length} of ${this.length}`;
  }
}
