import type { BindingApi } from "@tweakpane/core";
import { Pane } from "tweakpane";
import type { Session } from "../messages/session";
import type { Owner, Parameter } from "../messages/types";
import { element } from "../overlays/dom";

/** Changes that can be undone. */
const MOST_UNDO = 200;
/** Sliders that are shown without unfolding anything. */
const MOST_OPEN = 14;

interface Change {
  owner: string;
  name: string;
  from: number;
}

/** What is known of the world's parameters, and the ways to change them. */
export class ParameterStore {
  owners: Owner[] = [];
  /** Called when values have come from the world; `shape` says whether the list itself is another. */
  readonly listeners: ((shape: boolean) => void)[] = [];
  private readonly changes: Change[] = [];
  /** Values with which the world began, as far as this page knows. */
  private readonly initial = new Map<string, number>();

  constructor(private readonly session: Session) {
    session.on("hello", () => {
      this.changes.length = 0;
      this.initial.clear();
    });
    session.on("parameters", ({ owners }) => {
      const shape = shapeOf(owners) !== shapeOf(this.owners);
      this.owners = owners;
      for (const owner of owners) for (const one of owner.parameters) this.remember(owner.name, one);
      for (const listener of this.listeners) listener(shape);
    });
  }

  get canUndo(): boolean {
    return this.changes.length > 0;
  }

  /** Changes a value; the last step of a drag is the one that can be undone. */
  set(owner: string, name: string, value: number, from: number): void {
    const last = this.changes.at(-1);
    if (last?.owner !== owner || last.name !== name || last.from !== from)
      this.changes.push({ owner, name, from });
    this.changes.splice(0, Math.max(0, this.changes.length - MOST_UNDO));
    this.session.send({ do: "set", owner, name, value });
  }

  undo(): void {
    const change = this.changes.pop();
    if (change) this.session.send({ do: "set", owner: change.owner, name: change.name, value: change.from });
  }

  /** Value with which the world began. */
  initialOf(owner: string, parameter: Parameter): number {
    return this.initial.get(`${owner}:${parameter.name}`) ?? parameter.default;
  }

  /** Sets everything of these owners back to where the world began. */
  reset(owners: Owner[]): void {
    for (const owner of owners) {
      for (const parameter of owner.parameters) {
        const { name, value } = parameter;
        const initial = this.initialOf(owner.name, parameter);
        if (value !== initial) this.set(owner.name, name, initial, value);
      }
    }
  }

  private remember(owner: string, { name, value, initial }: Parameter): void {
    const key = `${owner}:${name}`;
    if (initial !== undefined) this.initial.set(key, initial);
    else if (!this.initial.has(key)) this.initial.set(key, value);
  }
}

/** Sliders for the parameters of some owners, built from their descriptions. */
export class ParameterPane {
  readonly element = element("div", { class: "bio-parameters" });
  private pane: Pane | null = null;
  private readonly bindings = new Map<string, { values: Record<string, number>; binding: BindingApi }>();
  private receiving = false;

  constructor(
    private readonly store: ParameterStore,
    private readonly chosen: () => Owner[],
  ) {
    store.listeners.push((shape) => (shape ? this.build() : this.refresh()));
  }

  /** Makes the sliders anew, for other owners. */
  build(): void {
    this.pane?.dispose();
    this.bindings.clear();
    this.element.replaceChildren();
    const owners = this.chosen();
    if (owners.length === 0) {
      this.element.append(element("p", { class: "bio-quiet", textContent: "No parameters." }));
      return;
    }
    const pane = new Pane({ container: this.element });
    this.pane = pane;
    const few = owners.reduce((sum, owner) => sum + owner.parameters.length, 0) <= MOST_OPEN;
    for (const owner of owners) this.buildOwner(pane, owner, few);
    const buttons = element("div", { class: "bio-row" });
    const undo = element("button", {
      textContent: "undo",
      title: "take back the last change",
      onclick: () => this.store.undo(),
    });
    const reset = () => this.store.reset(this.chosen());
    buttons.append(
      undo,
      element("button", { textContent: "reset", title: "all back to where the world began", onclick: reset }),
    );
    this.element.append(buttons);
  }

  private buildOwner(pane: Pane, owner: Owner, open: boolean): void {
    const folder = pane.addFolder({ title: owner.name, expanded: open });
    for (const parameter of owner.parameters) {
      const { name, minimum: min, maximum: max, unit } = parameter;
      const values = { [name]: parameter.value };
      const label =
        unit && unit !== "1" ? `${name.replaceAll("_", " ")}, ${unit}` : name.replaceAll("_", " ");
      const binding = folder.addBinding(values, name, {
        label,
        format: shortest,
        ...rangeOf(min, max),
      }) as BindingApi;
      binding.element.title = describe(parameter);
      this.bindings.set(`${owner.name}:${name}`, { values, binding });
      let from = parameter.value;
      binding.on("change", (event) => {
        if (this.receiving) return;
        this.store.set(owner.name, name, event.value as number, from);
        if (event.last) from = event.value as number;
      });
    }
  }

  /** Shows the values that the world has told. */
  private refresh(): void {
    this.receiving = true;
    for (const owner of this.chosen()) {
      for (const { name, value } of owner.parameters) {
        const held = this.bindings.get(`${owner.name}:${name}`);
        if (!held || held.values[name] === value) continue;
        held.values[name] = value;
        held.binding.refresh();
      }
    }
    this.receiving = false;
  }
}

/** A number as short as its first five figures allow. */
function shortest(number: number): string {
  return String(Number(number.toPrecision(5)));
}

function rangeOf(min: number, max: number): { min?: number; max?: number; step?: number } {
  if (!Number.isFinite(min) || !Number.isFinite(max)) return {};
  return { min, max };
}

function describe({ meaning, source, default: usual, unit, minimum, maximum }: Parameter): string {
  const tail = unit && unit !== "1" ? ` ${unit}` : "";
  return `${meaning}\n${shortest(minimum)} to ${shortest(maximum)}${tail}, usually ${shortest(usual)}${tail}\nSource: ${source}`;
}

function shapeOf(owners: Owner[]): string {
  return JSON.stringify(
    owners.map((owner) => [owner.name, owner.parameters.map((one) => [one.name, one.minimum, one.maximum])]),
  );
}
