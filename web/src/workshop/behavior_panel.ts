import { colorOf } from "../colors";
import { Chart } from "../inspector/chart";
import { element, nameOf } from "../overlays/dom";
import type { Panel } from "../overlays/panels";
import { Slider, toggle } from "./slider";
import type { Steering } from "./steering";
import type { Subject } from "./subject";

/** What a fish may intend, the most urgent first. */
const INTENTIONS = ["avoid", "escape", "school", "eat", "mate", "leave", "wander"];
const DRIVES = ["hunger", "libido", "fear"];
const DRIVE_COLORS = ["#f0e442", "#cc79a7", "#e5703a"];
/** The mental parameters that have sliders here; the others are among the parameters of the population. */
const MENTAL = [
  "appetite",
  "digestion",
  "libido_growth",
  "fear_distance",
  "drive_threshold",
  "fear_threshold",
  "persistence",
  "timidity",
  "cruise_speed",
  "full_speed",
];
/** How far beyond its default a slider goes. */
const REACH = 5;
/** Samples kept: five minutes at ten a second. */
const CAPACITY = 3000;

/** What moves a fish: its drives as a chart, its intention as a lamp, its temper as sliders. */
export class BehaviorPanel implements Panel {
  readonly name = "behavior";
  readonly title = "Behavior";
  readonly body = element("div", { class: "bio-behavior" });
  private readonly whom = element("p", { class: "bio-quiet" });
  private readonly lamps = element("div", { class: "bio-chips" });
  private readonly sliders = element("div");
  private readonly mind = element("div");
  private readonly shown = new Map<string, Slider>();
  private readonly become;
  private chart: Chart | null = null;
  private id = 0;

  constructor(
    private readonly subject: Subject,
    private readonly steering: Steering,
  ) {
    for (const name of INTENTIONS)
      this.lamps.append(
        element("span", {
          class: "bio-chip bio-lamp",
          textContent: name,
          data: { intention: name },
          style: `--color: ${colorOf(name)}`,
        }),
      );
    this.become = toggle("become this fish (B)", "steer it yourself; its mind only goes on feeling", (on) =>
      on ? this.steering.begin() : this.steering.end(),
    );
    const charts = element("div", { class: "bio-drives" });
    this.mind.append(this.lamps, charts, subject.scope(), this.sliders);
    this.body.append(this.whom, element("div", { class: "bio-row" }, this.become.element), this.mind);
    this.makeChart(charts);
    subject.listeners.push(() => this.take());
  }

  opened(): void {
    this.take();
  }

  refresh(): void {
    this.chart?.refresh();
  }

  /** The last values in the chart: time, hunger, libido, fear. */
  get latest(): number[] | null {
    return this.chart?.latest ?? null;
  }

  private makeChart(into: HTMLElement): void {
    const series = DRIVES.map((label, index) => ({ label, color: DRIVE_COLORS[index] }));
    this.chart = new Chart("drives", "0 to 1", series, CAPACITY);
    into.append(this.chart.element);
  }

  private take(): void {
    const { now, mind } = this.subject;
    const minded = now !== null && mind !== "";
    this.mind.hidden = !minded;
    this.become.element.hidden = now?.values.steered === undefined;
    this.become.show(this.steering.id !== 0 && this.steering.id === now?.id);
    const text = now === null ? "Click a fish." : nameOf(now.species, now.id);
    this.whom.textContent = now === null || minded ? text : `${text} follows no drives.`;
    if (!now || !minded) return;
    if (now.id !== this.id) this.begin(now.id);
    this.chart?.push(
      now.time,
      DRIVES.map((name) => Number(now.values[name] ?? 0)),
    );
    for (const lamp of this.lamps.children as HTMLCollectionOf<HTMLElement>)
      lamp.classList.toggle("bio-lit", lamp.dataset.intention === now.behavior);
    for (const [name, slider] of this.shown) slider.show(this.subject.value(name) ?? 0);
  }

  private begin(id: number): void {
    this.id = id;
    this.chart?.clear();
    this.shown.clear();
    this.sliders.replaceChildren();
    for (const name of MENTAL) {
      const parameter = this.subject.described(name);
      if (!parameter) continue;
      const { unit, meaning, source, minimum: min, maximum, default: usual } = parameter;
      const slider = new Slider({
        label: name.replaceAll("_", " "),
        unit,
        meaning: `${meaning}\nSource: ${source}`,
        min,
        max: Math.min(maximum, REACH * usual),
        value: this.subject.value(name) ?? usual,
        change: (value) => this.subject.set(name, value),
      });
      this.shown.set(name, slider);
      this.sliders.append(slider.element);
    }
  }
}
