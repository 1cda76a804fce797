import { RetinaView } from "../inspector/retina";
import type { Selection } from "../inspector/selection";
import { element, nameOf } from "../overlays/dom";
import type { Panel } from "../overlays/panels";
import { Slider, toggle } from "./slider";
import type { Subject } from "./subject";

/** How far eyes can be turned, degrees. */
const REACH = 90;

/** What can be drawn besides. */
export interface Drawing {
  labels: boolean;
  wireframe: boolean;
}

/** What a fish sees, with eyes that can be turned; and what is drawn to look at animals. */
export class EyePanel implements Panel {
  readonly name = "view";
  readonly title = "Fish view";
  readonly body = element("div", { class: "bio-eye" });
  readonly retina: RetinaView;
  private readonly whom = element("p", { class: "bio-quiet" });
  private readonly pan: Slider;
  private readonly tilt: Slider;
  private readonly one;
  private readonly both;

  constructor(
    private readonly subject: Subject,
    private readonly selection: Selection,
    species: (id: number) => string,
    drawing: HTMLElement,
  ) {
    this.retina = new RetinaView((id) => selection.select(id), species);
    const turned = (axis: "pan" | "tilt", label: string) =>
      new Slider({
        label,
        unit: "°",
        meaning: axis === "pan" ? "to the left" : "up",
        min: -REACH,
        max: REACH,
        step: 1,
        value: 0,
        change: (angle) => selection.look({ [axis]: angle }),
      });
    this.pan = turned("pan", "pan, to the left");
    this.tilt = turned("tilt", "tilt, up");
    this.one = toggle("one picture", "as of one eye in the middle", () => selection.look({ both: false }));
    this.both = toggle("both eyes", "the left eye's at the left", () => selection.look({ both: true }));
    const center = element("button", {
      textContent: "ahead",
      title: "look straight ahead",
      onclick: () => {
        selection.look({ pan: 0, tilt: 0 });
        this.take();
      },
    });
    const next = element("button", {
      textContent: "next fish",
      onclick: () => selection.next(1),
    });
    this.body.append(
      element("div", { class: "bio-row" }, this.whom, next),
      this.retina.element,
      element("div", { class: "bio-row" }, this.one.element, this.both.element, center),
      this.pan.element,
      this.tilt.element,
      element("h4", { textContent: "Drawing" }),
      drawing,
    );
    subject.listeners.push(() => this.take());
  }

  opened(): void {
    this.take();
  }

  private take(): void {
    if (!this.body.offsetParent) return;
    const { now } = this.subject;
    const { pan, tilt, both } = this.selection.gaze;
    this.whom.textContent = now ? nameOf(now.species, now.id) : "Click a fish.";
    this.retina.show(now?.retina ?? null);
    this.pan.show(pan);
    this.tilt.show(tilt);
    this.one.show(!both);
    this.both.show(both);
  }
}
