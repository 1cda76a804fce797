import uPlot from "uplot";
import { colorAt } from "../colors";
import { element } from "../overlays/dom";
import { Ring } from "../ring";
import { formatNumber } from "./values";

/** A small calm chart of some series over world time, in bounded memory. */
export class Chart {
  readonly element = element("div", { class: "bio-chart" });
  private readonly ring: Ring;
  private readonly plot: uPlot;
  private stale = false;

  constructor(
    title: string,
    unit: string,
    series: { label: string; color: string }[],
    capacity: number,
    width = 268,
  ) {
    this.ring = new Ring(capacity, series.length + 1);
    const axis = {
      stroke: "#7f9aa6",
      grid: { stroke: "#ffffff12", width: 1 },
      ticks: { show: false },
      font: "10px system-ui",
    };
    const options: uPlot.Options = {
      width,
      height: 96,
      legend: { show: series.length > 1, live: false },
      cursor: { y: false, drag: { x: false, y: false } },
      scales: { x: { time: false } },
      axes: [
        { ...axis, size: 20, values: (_plot, ticks) => ticks.map((tick) => `${formatNumber(tick)} s`) },
        { ...axis, size: 44, values: (_plot, ticks) => ticks.map(formatNumber) },
      ],
      series: [
        {},
        ...series.map(({ label, color }) => ({ label, stroke: color, width: 1.5, points: { show: false } })),
      ],
    };
    const heading = element("h4", {}, title, unit ? element("small", { textContent: ` ${unit}` }) : null);
    this.element.append(heading);
    this.plot = new uPlot(options, this.columns() as uPlot.AlignedData, this.element);
  }

  /** Adds values at a world time in seconds; going back in time begins anew. */
  push(time: number, values: readonly number[]): void {
    if (time <= this.ring.last(0)) {
      if (time === this.ring.last(0)) return;
      this.ring.clear();
    }
    this.ring.push([time, ...values]);
    this.stale = true;
  }

  /** Forgets everything. */
  clear(): void {
    this.ring.clear();
    this.stale = true;
  }

  /** The values added last, their time first; null without any. */
  get latest(): number[] | null {
    const last = Array.from({ length: this.ring.columns }, (_, column) => this.ring.last(column));
    return Number.isFinite(last[0]) ? last : null;
  }

  /** Draws what is new, if it can be seen. */
  refresh(): void {
    if (!this.stale || !this.element.offsetParent) return;
    this.stale = false;
    this.plot.setData(this.columns() as uPlot.AlignedData);
  }

  destroy(): void {
    this.plot.destroy();
    this.element.remove();
  }

  private columns(): number[][] {
    return Array.from({ length: this.ring.columns }, (_, column) => this.ring.column(column));
  }
}

/** Colors of the series of a chart whose lines have no color of their own. */
export function seriesOf(labels: string[]): { label: string; color: string }[] {
  return labels.map((label, index) => ({ label, color: colorAt(index) }));
}
