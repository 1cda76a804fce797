import { colorOf } from "../colors";
import type { Session } from "../messages/session";
import type { Inspection, Owner } from "../messages/types";
import { element, nameOf, sign } from "../overlays/dom";
import { SIGNS } from "../overlays/signs";
import { Chart } from "./chart";
import { ParameterPane, type ParameterStore } from "./parameters";
import { RetinaView } from "./retina";
import { flatten, formatValue, unitOf } from "./values";

/** Samples of a plotted value that are kept: five minutes at ten a second. */
const CAPACITY = 3000;
/** Things seen that are listed. */
const MOST_SEEN = 6;

/** All about the selected individual, at the right edge. */
export class Inspector {
  readonly element;
  readonly retina;
  /** The last inspection of the selected individual. */
  latest: Inspection | null = null;
  private readonly title = element("h2");
  private readonly behavior = element("span", { class: "bio-chip" });
  private readonly values = element("table", { class: "bio-values" });
  private readonly percepts = element("table", { class: "bio-values" });
  private readonly charts = element("div", { class: "bio-charts" });
  private readonly plots = new Map<string, Chart>();
  private readonly rows = new Map<string, HTMLTableCellElement>();
  private readonly pane;
  private population = "";
  private id = 0;
  private time = 0;

  constructor(
    session: Session,
    private readonly store: ParameterStore,
    private readonly select: (id: number) => void,
    species: (id: number) => string,
  ) {
    this.retina = new RetinaView(select, species);
    this.pane = new ParameterPane(store, () => this.owners());
    const close = element(
      "button",
      { class: "bio-close", ariaLabel: "close", onclick: () => select(0) },
      sign(SIGNS.close),
    );
    this.element = element(
      "section",
      { class: "bio-card bio-inspector", hidden: true },
      element("header", {}, this.title, this.behavior, close),
      this.retina.element,
      fold("Values", this.values, true),
      this.charts,
      fold("Percepts", this.percepts, false),
      fold("Population", this.pane.element, false),
    );
    session.on("frame", (frame) => {
      this.time = frame.time;
    });
    session.on("inspection", (inspection) => this.take(inspection));
  }

  /** Opens for an individual of which only this much is known yet; 0 closes. */
  open(id: number, species: string): void {
    this.id = id;
    this.latest = null;
    this.element.hidden = id === 0;
    this.title.textContent = nameOf(species, id);
    this.behavior.hidden = true;
    this.retina.show(null);
    this.rows.clear();
    this.values.replaceChildren();
    this.percepts.replaceChildren();
    for (const chart of this.plots.values()) chart.destroy();
    this.plots.clear();
  }

  /** Draws charts that have new values. */
  refresh(): void {
    for (const chart of this.plots.values()) chart.refresh();
  }

  private take(inspection: Inspection): void {
    if (inspection.id !== this.id || this.element.hidden) return;
    this.latest = inspection;
    const { behavior, population } = inspection;
    this.title.textContent = nameOf(inspection.species, inspection.id);
    this.behavior.hidden = !behavior;
    if (behavior) {
      this.behavior.textContent = behavior;
      this.behavior.style.setProperty("--color", colorOf(behavior));
    }
    this.retina.show(inspection.retina);
    this.fill(this.values, inspection.values);
    this.fillPercepts(inspection.percepts);
    if (population !== this.population) {
      this.population = population;
      this.pane.build();
    }
  }

  private fillPercepts(percepts: Record<string, unknown>): void {
    const { seen, ...others } = percepts;
    this.fill(this.percepts, others);
    let list = this.percepts.querySelector<HTMLElement>("tfoot");
    if (!Array.isArray(seen)) return;
    if (!list) {
      list = element("tfoot");
      this.percepts.append(list);
    }
    const nearest = seen.slice(0, MOST_SEEN).map((one) => this.sighting(one as Record<string, unknown>));
    list.replaceChildren(row(`sees ${seen.length}`, ""), ...nearest);
  }

  private sighting(one: Record<string, unknown>): HTMLElement {
    const id = Number(one.id ?? 0);
    const away = Array.isArray(one.position) ? Math.hypot(...(one.position as number[])) : Number.NaN;
    const link = element("button", {
      class: "bio-link",
      textContent: nameOf(String(one.species ?? ""), id),
      onclick: () => this.select(id),
    });
    return row(link, Number.isNaN(away) ? "" : `${away.toFixed(2)} m`);
  }

  private fill(table: HTMLTableElement, values: Record<string, unknown>): void {
    const section = table === this.values ? "value" : "percept";
    for (const [name, value] of flatten(values)) {
      const key = `${section}:${name}`;
      const { text, number } = formatValue(name, value);
      let cell = this.rows.get(key);
      if (!cell) {
        cell = element("td");
        this.rows.set(key, cell);
        const label = element("button", {
          class: "bio-link",
          textContent: unitOf(name).label.replaceAll("_", " "),
          title: "plot this value",
        });
        label.onclick = () => this.togglePlot(key, name);
        table.append(element("tr", {}, element("th", {}, label), cell));
      }
      if (cell.textContent !== text) cell.textContent = text;
      if (number !== undefined) this.plots.get(key)?.push(this.time, [number]);
    }
  }

  private togglePlot(key: string, name: string): void {
    const open = this.plots.get(key);
    if (open) {
      open.destroy();
      this.plots.delete(key);
      return;
    }
    const { label, unit } = unitOf(name);
    const chart = new Chart(label, unit, [{ label, color: colorOf(name) }], CAPACITY);
    chart.element.title = "click to close";
    chart.element.onclick = () => this.togglePlot(key, name);
    this.plots.set(key, chart);
    this.charts.append(chart.element);
  }

  private owners(): Owner[] {
    return this.store.owners.filter((owner) => owner.name === this.population);
  }
}

function fold(title: string, body: HTMLElement, open: boolean): HTMLElement {
  return element("details", { open }, element("summary", { textContent: title }), body);
}

function row(head: Node | string, text: string): HTMLElement {
  return element("tr", {}, element("th", {}, head), element("td", { textContent: text }));
}
