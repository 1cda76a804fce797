import type { ParameterStore } from "../inspector/parameters";
import type { Session } from "../messages/session";
import type { Owner, Parameter } from "../messages/types";
import { element } from "../overlays/dom";
import type { Panel } from "../overlays/panels";
import { CurrentDial } from "./current_dial";
import type { Residents } from "./residents";
import { Slider, toggle } from "./slider";

/** Those of bodies that are moved by muscles. */
const BODY = "muscle_swimmer_";
const WATER = `${BODY}water`;
/** Time steps that the slider offers, seconds; the parameter list takes others. */
const STEPS = { min: 1 / 240, max: 1 / 15 };

/** Bodies and water, the current, the time step. */
export class PhysicsPanel implements Panel {
  readonly name = "physics";
  readonly title = "Physics";
  readonly body = element("div", { class: "bio-physics" });
  private readonly updates: (() => void)[] = [];
  private shape = "";

  constructor(
    private readonly session: Session,
    private readonly store: ParameterStore,
    private readonly residents: Residents,
  ) {
    store.listeners.push(() => this.refresh());
    residents.listeners.push(() => this.refresh());
  }

  opened(): void {
    this.refresh();
  }

  private refresh(): void {
    const shape = JSON.stringify(this.store.owners.map((owner) => [owner.name, owner.parameters.length]));
    if (shape !== this.shape) this.build(shape);
    for (const update of this.updates) update();
  }

  private build(shape: string): void {
    this.shape = shape;
    this.updates.length = 0;
    this.body.replaceChildren();
    this.buildBodies();
    for (const owner of this.store.owners) if (this.find(owner.name, "bearing")) this.buildCurrent(owner);
    this.buildTime();
  }

  private find(owner: string, name: string): Parameter | undefined {
    const found = this.store.owners.find((one) => one.name === owner);
    return found?.parameters.find((one) => one.name === name);
  }

  /** Sets a parameter of all owners that have it. */
  private setAll(name: string, value: number): void {
    for (const owner of this.store.owners) {
      const parameter = owner.parameters.find((one) => one.name === name);
      if (parameter && parameter.value !== value) this.store.set(owner.name, name, value, parameter.value);
    }
  }

  private buildBodies(): void {
    const owner = this.store.owners.find(({ parameters }) => parameters.some((one) => one.name === WATER));
    this.body.append(element("h4", { textContent: "Bodies and water" }));
    if (!owner) {
      const text = "No fish here is moved by muscles. Newcomers of the population panel are.";
      this.body.append(element("p", { class: "bio-quiet", textContent: text }));
      return;
    }
    let thickness = 1;
    const water = toggle("water pushes", "without it a beating tail gives no way", (on) =>
      this.setAll(WATER, on ? thickness : 0),
    );
    this.body.append(element("div", { class: "bio-row" }, water.element));
    this.updates.push(() => {
      const value = this.find(owner.name, WATER)?.value ?? 1;
      if (value > 0) thickness = value;
      water.show(value > 0);
    });
    for (const parameter of owner.parameters.filter((one) => one.name.startsWith(BODY)))
      this.add(owner.name, parameter, {
        label: parameter.name.slice(BODY.length),
        unit: "×",
        change: (value) => this.setAll(parameter.name, value),
      });
  }

  private buildCurrent({ name }: Owner): void {
    const set = (parameter: string, value: number) => {
      const from = this.find(name, parameter)?.value ?? value;
      this.store.set(name, parameter, value, from);
    };
    const dial = new CurrentDial((bearing) => set("bearing", bearing));
    const flows = toggle("flows", "switch the current on and off", (on) => set("strength", on ? 1 : 0));
    this.updates.push(() => {
      const strength = this.find(name, "strength")?.value ?? 1;
      dial.show(this.find(name, "bearing")?.value ?? 0, strength);
      flows.show(strength > 0);
    });
    const sliders = element("div", { class: "bio-grow" });
    this.body.append(
      element("h4", { textContent: name === "current" ? "Current" : `Current: ${name}` }),
      element("div", { class: "bio-beside" }, dial.element, sliders),
    );
    sliders.append(element("div", { class: "bio-row" }, flows.element));
    for (const one of ["speed", "surge", "turbulence"]) {
      const parameter = this.find(name, one);
      if (!parameter) continue;
      const max = Math.min(parameter.maximum, 1);
      this.add(name, parameter, { label: one, max, change: (value) => set(one, value) }, sliders);
    }
  }

  private buildTime(): void {
    const step = this.find("world", "time_step");
    this.body.append(element("h4", { textContent: "Time" }));
    if (step) {
      const change = (value: number) => this.setAll("time_step", value);
      this.add("world", step, { label: "time step", ...STEPS, change });
    }
    const stride = new Slider({
      label: "ticks per picture",
      meaning: "how many ticks are made from one picture to the next; smooth: as many pictures as can be",
      min: 0,
      max: 60,
      step: 1,
      value: this.residents.stride ?? 0,
      say: (ticks) => (ticks === 0 ? "smooth" : String(ticks)),
      change: (ticks) => this.session.send({ do: "display", ticks: ticks === 0 ? null : ticks }),
    });
    this.updates.push(() => stride.show(this.residents.stride ?? 0));
    this.body.append(stride.element);
  }

  private add(
    owner: string,
    parameter: Parameter,
    shown: { label: string; unit?: string; min?: number; max?: number; change: (value: number) => void },
    into: HTMLElement = this.body,
  ): void {
    const { name, unit, meaning, value, minimum: min, maximum: max } = parameter;
    const slider = new Slider({ unit, meaning, value, min, max, ...shown });
    this.updates.push(() => slider.show(this.find(owner, name)?.value ?? value));
    into.append(slider.element);
  }
}
