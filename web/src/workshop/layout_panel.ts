import { colorOfSpecies } from "../colors";
import type { Session } from "../messages/session";
import type { BatchLayout } from "../messages/types";
import { download, element, nameOf } from "../overlays/dom";
import type { Panel } from "../overlays/panels";
import { isBuiltInPlace } from "../scene/ground";
import type { Stage } from "../scene/stage";
import { drawMap, nearest, type Section, type Spot, sectionOf, spotsOf, toPicture, toWorld } from "./map";
import type { Residents } from "./residents";
import { Slider } from "./slider";

/** Side of the map, pixels. */
const SIZE = 270;
/** How near the mouse must be to what it takes, pixels. */
const REACH = 12;
/** Milliseconds between two moves of what is dragged. */
const PAUSE = 120;
/** Largest script that the world takes, bytes. */
const LARGEST_SCRIPT = 120_000;

interface Hooks {
  selected(): number;
  select(id: number): void;
  say(text: string): void;
}

/** A map from above on which things are dragged to other places; saves and loads the script of the world. */
export class LayoutPanel implements Panel {
  readonly name = "layout";
  readonly title = "Layout";
  readonly body = element("div", { class: "bio-layout" });
  private readonly canvas = element("canvas", { class: "bio-map", width: SIZE, height: SIZE });
  private readonly legend = element("div", { class: "bio-legend" });
  private readonly note = element("small", { class: "bio-quiet" });
  private readonly height: Slider;
  private readonly size: Slider;
  private readonly file = element("input", { type: "file", accept: ".json", hidden: true });
  private section: Section | null = null;
  private spots: Spot[] = [];
  private dragged: Spot | null = null;
  private lastMove = 0;
  private lastSize = 1;

  constructor(
    private readonly session: Session,
    private readonly stage: Stage,
    private readonly residents: Residents,
    private readonly hooks: Hooks,
  ) {
    this.canvas.title = "drag things to other places; turn the wheel to come nearer";
    this.height = new Slider({
      label: "height",
      unit: "m",
      meaning: "height of the selected one above the level 0",
      min: -12,
      max: 0,
      value: 0,
      change: (y) => this.lift(y),
    });
    this.size = new Slider({
      label: "size",
      meaning: "size of the selected plant or pillar, relative to what it was",
      min: 0.25,
      max: 4,
      value: 1,
      change: () => {},
    });
    this.size.element.querySelector("input")!.onchange = (event) =>
      this.resize(Number((event.target as HTMLInputElement).value));
    this.file.onchange = () => void this.load();
    const button = (textContent: string, title: string, onclick: () => void) =>
      element("button", { textContent, title, onclick });
    this.body.append(
      this.canvas,
      this.legend,
      this.note,
      this.height.element,
      this.size.element,
      element(
        "div",
        { class: "bio-row" },
        button("save script", "how this world was made and changed, as a text", () =>
          session.send({ do: "script" }),
        ),
        button("load script", "make the world of a script", () => this.file.click()),
        this.file,
      ),
    );
    this.canvas.addEventListener("pointerdown", (event) => this.grab(event));
    this.canvas.addEventListener("pointermove", (event) => this.drag(event));
    this.canvas.addEventListener("pointerup", (event) => this.release(event));
    this.canvas.addEventListener("pointercancel", () => {
      this.dragged = null;
    });
    this.canvas.addEventListener("wheel", (event) => this.zoom(event), { passive: false });
    session.on("script", ({ name, text }) => {
      download(name, new Blob([text], { type: "application/json" }));
      hooks.say(`Saved ${name}. bioscope live opens it.`);
    });
  }

  opened(): void {
    this.section = null;
    this.refresh();
  }

  /** Draws what has moved. */
  refresh(): void {
    if (!this.canvas.offsetParent) return;
    const canMove = ({ species }: BatchLayout) => this.residents.can(species, "place");
    const spots = spotsOf(this.stage, canMove);
    const standing = spotsOf(this.stage, (layout) => !canMove(layout) && !isBuiltInPlace(layout));
    const { dragged } = this;
    this.spots = spots.map((spot) => (spot.id === dragged?.id ? dragged : spot));
    this.section ??= sectionOf(this.spots);
    const context = this.canvas.getContext("2d");
    if (context) drawMap(context, this.spots, standing, this.section, SIZE, this.hooks.selected());
    const one = this.chosen();
    const text = one
      ? `${nameOf(one.species, one.id)} at ${[one.x, one.y, one.z].map((axis) => axis.toFixed(2)).join(", ")} m`
      : `${this.spots.length} things that can be dragged; the wheel comes nearer`;
    if (this.note.textContent !== text) this.note.textContent = text;
    this.height.element.hidden = one === undefined;
    this.size.element.hidden = one === undefined || this.residents.can(one.species, "steer");
    if (one) this.height.show(one.y);
    this.tellColors();
  }

  /** Says which color is whose. */
  private tellColors(): void {
    const species = [...new Set(this.spots.map((spot) => spot.species))].sort();
    if (this.legend.dataset.species === species.join()) return;
    this.legend.dataset.species = species.join();
    this.legend.replaceChildren(
      ...species.map((one) =>
        element("span", { style: `--color: ${colorOfSpecies(one)}`, textContent: one.replaceAll("_", " ") }),
      ),
    );
  }

  /** Where an individual is on the map, as shares of its sides; null if it is not on it. */
  placeOf(id: number): [number, number] | null {
    const spot = this.spots.find((one) => one.id === id);
    if (!spot || !this.section) return null;
    const [x, y] = toPicture(spot, this.section, 1);
    return [x, y];
  }

  private chosen(): Spot | undefined {
    return this.spots.find((spot) => spot.id === this.hooks.selected());
  }

  private point(event: MouseEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    return [((event.clientX - box.left) / box.width) * SIZE, ((event.clientY - box.top) / box.height) * SIZE];
  }

  private grab(event: PointerEvent): void {
    if (!this.section) return;
    const found = nearest(this.spots, this.point(event), this.section, SIZE, REACH);
    if (!found) return;
    this.hooks.select(found.id);
    this.size.show(1);
    this.lastSize = 1;
    this.dragged = { ...found };
    this.canvas.setPointerCapture(event.pointerId);
  }

  private drag(event: PointerEvent): void {
    if (!this.dragged || !this.section || event.buttons === 0) return;
    [this.dragged.x, this.dragged.z] = toWorld(this.point(event), this.section, SIZE);
    if (event.timeStamp - this.lastMove < PAUSE) return;
    this.lastMove = event.timeStamp;
    this.move(this.dragged);
  }

  private release(event: PointerEvent): void {
    const { dragged, section } = this;
    this.dragged = null;
    if (!dragged || !section) return;
    const before = this.stage.find(dragged.id);
    const [x, z] = toWorld(this.point(event), section, SIZE);
    const place = before?.batch.placeOf(before.slot);
    // A click that did not move is a selection only.
    if (this.lastMove === 0 && place && Math.hypot(x - place[0], z - place[2]) < 0.02 * section.half) return;
    this.lastMove = 0;
    this.move({ ...dragged, x, z });
  }

  /** Plants and pillars stay on the ground; the others keep their height. */
  private move(spot: Spot): void {
    const swims = this.residents.can(spot.species, "steer");
    const ground = this.stage.ground.heightAt(spot.x, spot.z);
    const y = swims ? Math.max(spot.y, ground + 0.05) : Number.isFinite(ground) ? ground : spot.y;
    this.session.send({ do: "place", id: spot.id, position: [spot.x, y, spot.z] });
  }

  private lift(y: number): void {
    const one = this.chosen();
    if (one) this.session.send({ do: "place", id: one.id, position: [one.x, y, one.z] });
  }

  private resize(size: number): void {
    const one = this.chosen();
    const scale = size / this.lastSize;
    this.lastSize = size;
    if (one && scale !== 1)
      this.session.send({ do: "place", id: one.id, position: [one.x, one.y, one.z], scale });
  }

  private zoom(event: WheelEvent): void {
    event.preventDefault();
    if (!this.section) return;
    const factor = event.deltaY > 0 ? 1.15 : 1 / 1.15;
    const at = toWorld(this.point(event), this.section, SIZE);
    const { x, z, half } = this.section;
    const wanted = Math.min(200, Math.max(0.5, half * factor));
    const share = wanted / half;
    this.section = { x: at[0] + (x - at[0]) * share, z: at[1] + (z - at[1]) * share, half: wanted };
    this.refresh();
  }

  private async load(): Promise<void> {
    const file = this.file.files?.[0];
    this.file.value = "";
    if (!file) return;
    if (file.size > LARGEST_SCRIPT) {
      this.hooks.say(`${file.name} is too long for the page. Open it with bioscope live.`);
      return;
    }
    this.session.send({ do: "play script", text: await file.text() });
  }
}
