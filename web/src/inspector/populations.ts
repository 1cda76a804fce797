import type { Session } from "../messages/session";
import type { Statistics } from "../messages/types";
import { element } from "../overlays/dom";
import type { Panel } from "../overlays/panels";
import { Chart, seriesOf } from "./chart";
import { unitOf } from "./values";

/** Samples kept: one hour at two a second. */
const CAPACITY = 7200;

/** One chart per figure (`count`, `energy`), one line per population. */
export class Populations implements Panel {
  readonly name = "populations";
  readonly title = "Populations";
  readonly body = element(
    "div",
    { class: "bio-charts" },
    element("p", { class: "bio-quiet", textContent: "No figures yet." }),
  );
  private charts = new Map<string, { chart: Chart; names: string[] }>();
  private shape = "";

  constructor(session: Session) {
    session.on("statistics", (statistics) => this.take(statistics));
    session.on("hello", () => this.clear());
  }

  opened(): void {
    this.refresh();
  }

  refresh(): void {
    for (const { chart } of this.charts.values()) chart.refresh();
  }

  private take({ time, values }: Statistics): void {
    const shape = Object.keys(values).sort().join(" ");
    if (shape !== this.shape) this.build(values, shape);
    for (const { chart, names } of this.charts.values()) {
      chart.push(
        time,
        names.map((name) => values[name]),
      );
    }
  }

  private build(values: Record<string, number>, shape: string): void {
    this.clear();
    this.shape = shape;
    const figures = new Map<string, string[]>();
    for (const name of Object.keys(values).sort()) {
      const figure = name.slice(name.lastIndexOf(".") + 1);
      figures.set(figure, [...(figures.get(figure) ?? []), name]);
    }
    this.body.replaceChildren();
    for (const [figure, names] of figures) {
      const labels = names.map((name) => name.slice(0, Math.max(0, name.lastIndexOf("."))) || name);
      const { label, unit } = unitOf(figure);
      const title = labels.length === 1 ? `${labels[0]} ${label}` : label;
      const chart = new Chart(title, unit, seriesOf(labels), CAPACITY);
      this.charts.set(figure, { chart, names });
      this.body.append(chart.element);
    }
  }

  private clear(): void {
    for (const { chart } of this.charts.values()) chart.destroy();
    this.charts.clear();
    this.shape = "";
  }
}
