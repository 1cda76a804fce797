import { element } from "../overlays/dom";

export interface SliderOptions {
  label: string;
  unit?: string;
  /** Said when the mouse rests on it. */
  meaning?: string;
  min: number;
  max: number;
  step?: number;
  value: number;
  /** What the number is called; itself with its unit if not given. */
  say?(value: number): string;
  /** Called with what the person has chosen. */
  change(value: number): void;
}

/** A slider with its name and its number. */
export class Slider {
  readonly element;
  private readonly input;
  private readonly number = element("output");
  private readonly words: (value: number) => string;
  private held = false;

  constructor({ label, unit = "", meaning = "", min, max, step, value, say, change }: SliderOptions) {
    const suffix = unit && unit !== "1" ? ` ${unit}` : "";
    this.words = say ?? ((value) => `${Number(value.toPrecision(3))}${suffix}`);
    this.input = element("input", {
      type: "range",
      min: String(min),
      max: String(max),
      step: String(step ?? "any"),
      ariaLabel: label,
      title: meaning,
    });
    this.input.oninput = () => {
      this.say(Number(this.input.value));
      change(Number(this.input.value));
    };
    this.input.onpointerdown = () => {
      this.held = true;
    };
    for (const end of ["pointerup", "pointercancel", "change"] as const)
      this.input.addEventListener(end, () => {
        this.held = false;
        if (end === "pointerup") this.input.blur(); // so that arrow keys go on meaning steps
      });
    this.element = element(
      "label",
      { class: "bio-slider", title: meaning },
      element("span", { textContent: label }),
      this.number,
      this.input,
    );
    this.show(value);
  }

  /** Shows what the world has, unless a hand holds the slider. */
  show(value: number): void {
    if (this.held) return;
    if (value > Number(this.input.max)) this.input.max = String(value);
    if (value < Number(this.input.min)) this.input.min = String(value);
    this.input.value = String(value);
    this.say(value);
  }

  private say(value: number): void {
    const text = this.words(value);
    if (this.number.textContent !== text) this.number.textContent = text;
  }
}

/** A button that is on or off. */
export function toggle(label: string, meaning: string, change: (on: boolean) => void): Toggle {
  const button = element("button", { class: "bio-toggle", textContent: label, title: meaning });
  button.setAttribute("aria-pressed", "false");
  button.onclick = () => change(button.getAttribute("aria-pressed") !== "true");
  return {
    element: button,
    show: (on) => button.setAttribute("aria-pressed", String(on)),
  };
}

export interface Toggle {
  element: HTMLButtonElement;
  show(on: boolean): void;
}
