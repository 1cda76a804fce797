import type { ParameterStore } from "../inspector/parameters";
import type { Session } from "../messages/session";
import type { Inspection, Parameter } from "../messages/types";
import { element } from "../overlays/dom";
import { toggle } from "./slider";

/** The selected animal as the panels see it: its own parameters, and the ways to change them. */
export class Subject {
  /** The last inspection of the selected animal; null without one. */
  now: Inspection | null = null;
  /** Whether changes are for all of its population. */
  all = false;
  /** Called with every inspection, and when another is selected. */
  readonly listeners: (() => void)[] = [];

  constructor(
    private readonly session: Session,
    private readonly store: ParameterStore,
  ) {
    session.on("inspection", (inspection) => {
      this.now = inspection.population ? inspection : null;
      this.tell();
    });
  }

  /** Another individual is selected, or none. */
  forget(): void {
    this.now = null;
    this.tell();
  }

  /** Word for its mind, with which names of its mind's parameters begin; empty without a mind of habits. */
  get mind(): string {
    const female = Object.keys(this.now?.traits ?? {}).find((name) => name.endsWith("_female"));
    return female?.slice(0, -"_female".length) ?? "";
  }

  /** Its own value of a parameter of its mind. */
  value(name: string): number | undefined {
    return this.now?.traits[`${this.mind}_${name}`];
  }

  /** How its population describes a parameter of its mind. */
  described(name: string): Parameter | undefined {
    const owner = this.store.owners.find((one) => one.name === this.now?.population);
    return owner?.parameters.find((one) => one.name === `${this.mind}_${name}`);
  }

  /** Sets a parameter of its mind, or of all minds of its population. */
  set(name: string, value: number): void {
    if (!this.now) return;
    const full = `${this.mind}_${name}`;
    const { id, population } = this.now;
    if (this.all) this.store.set(population, full, value, this.now.traits[full] ?? value);
    else this.session.send({ do: "trait", id, name: full, value });
  }

  /** Two buttons: changes are for this one alone, or for all of its population. */
  scope(): HTMLElement {
    const one = toggle("this one", "changes are for the selected animal alone", () => this.widen(false));
    const all = toggle("all of its kind", "changes are for its whole population", () => this.widen(true));
    this.listeners.push(() => {
      one.show(!this.all);
      all.show(this.all);
    });
    return element("div", { class: "bio-row" }, one.element, all.element);
  }

  private widen(all: boolean): void {
    this.all = all;
    this.tell();
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
