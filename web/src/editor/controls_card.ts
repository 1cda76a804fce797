import type { BindingApi } from "@tweakpane/core";
import { Pane } from "tweakpane";
import { element } from "../overlays/dom";
import { type ModelParameter, written } from "./parameters";

/** Seeds that the slider offers; others can be typed. */
const SEEDS = 100;
/** Choice of no other surroundings than the text names. */
export const ALONE = "as the text says";

export interface Choices {
  seed: number;
  environment: string;
}

/** Seed, surroundings, and a slider for every parameter of the text. */
export class ControlsCard {
  readonly element = element("section", { class: "bio-card bio-controls bio-parameters" });
  readonly choices: Choices = { seed: 1, environment: ALONE };
  private pane: Pane | null = null;
  private shape = "";
  private environments: string[] = [];
  private present: ModelParameter[] = [];
  private readonly values: Record<string, number> = {};
  private readonly bindings: BindingApi[] = [];
  private receiving = false;

  /** `set` is called to write a value into the text, `chosen` when seed or surroundings have changed. */
  constructor(
    private readonly set: (parameter: ModelParameter, value: string) => void,
    private readonly chosen: () => void,
  ) {}

  /** The surroundings there are. */
  offer(environments: string[]): void {
    this.environments = environments;
    this.shape = "";
    this.show(this.present);
  }

  /** Shows the parameters as the text has them now. */
  show(parameters: ModelParameter[]): void {
    const shape = JSON.stringify(
      parameters.map(({ name, low, high, unit, meaning }) => [name, low, high, unit, meaning]),
    );
    this.present = parameters;
    this.receiving = true;
    for (const { name, value } of parameters) this.values[name] = value;
    if (shape === this.shape) for (const binding of this.bindings) binding.refresh();
    else this.build(shape);
    this.receiving = false;
  }

  /** Takes over a seed from elsewhere. */
  setSeed(seed: number): void {
    this.receiving = true;
    this.choices.seed = seed;
    for (const binding of this.bindings) binding.refresh();
    this.receiving = false;
  }

  private build(shape: string): void {
    const top = this.element.scrollTop;
    this.shape = shape;
    this.pane?.dispose();
    this.bindings.length = 0;
    const pane = new Pane({ container: this.element });
    this.pane = pane;
    const plant = pane.addFolder({ title: "Plant" });
    const seed = plant.addBinding(this.choices, "seed", { min: 1, max: SEEDS, step: 1 }) as BindingApi;
    seed.element.title = "seed of the random numbers: another number, another plant of the same kind";
    this.bindings.push(seed.on("change", () => this.choose()) as BindingApi);
    if (this.environments.length > 0) {
      const options = Object.fromEntries([ALONE, ...this.environments].map((name) => [name, name]));
      const field = plant.addBinding(this.choices, "environment", { options }) as BindingApi;
      this.bindings.push(field.on("change", () => this.choose()) as BindingApi);
    }
    if (this.present.length > 0) this.buildParameters(pane.addFolder({ title: "Parameters" }));
    this.element.scrollTop = top;
  }

  private buildParameters(folder: ReturnType<Pane["addFolder"]>): void {
    for (const { name, low: min, high: max, unit, meaning, declared } of this.present) {
      const label = unit ? `${name}, ${unit}` : name;
      const format = (value: number) => String(Number(value.toPrecision(5)));
      const binding = folder.addBinding(this.values, name, { label, min, max, format }) as BindingApi;
      binding.element.title = `${meaning || name}\n${format(min)} to ${format(max)}${unit ? ` ${unit}` : ""}${declared ? "" : " (guessed; a comment behind the value says more)"}`;
      binding.on("change", (event) => {
        const parameter = this.present.find((one) => one.name === name);
        if (this.receiving || !parameter) return;
        const value = written(event.value as number, parameter);
        if (Number(value) !== parameter.value) this.set(parameter, value);
      });
      this.bindings.push(binding);
    }
  }

  private choose(): void {
    if (!this.receiving) this.chosen();
  }
}
