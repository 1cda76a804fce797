import { colorOf } from "../colors";
import { formatValue } from "../inspector/values";
import type { Session } from "../messages/session";
import type { BatchLayout, WorldEvent } from "../messages/types";
import { element } from "./dom";
import type { Panel } from "./panels";
import { clock } from "./timeline_bar";

/** Events kept, and rows drawn. */
const MOST = 2000;
const ROWS = 120;

/** What has happened, newest first, by kind. */
export class EventList implements Panel {
  readonly name = "events";
  readonly title = "Events";
  readonly body = element("div", { class: "bio-events" });
  private readonly kinds = element("div", { class: "bio-chips" });
  private readonly list = element("ol");
  private readonly events: WorldEvent[] = [];
  private readonly hidden = new Set<string>();
  private stale = true;
  /** What the living are, also those that have gone. */
  private readonly species = new Map<number, string>();
  private known = new WeakSet<BatchLayout>();

  constructor(
    private readonly session: Session,
    private readonly select: (id: number) => void,
  ) {
    this.body.append(this.kinds, this.list);
    session.on("hello", () => {
      this.events.length = 0;
      this.species.clear();
      this.known = new WeakSet();
      this.stale = true;
    });
    session.on("layout", ({ batches }) => this.remember(batches));
    session.on("events", ({ events }) => {
      for (const { subject, data } of events)
        if (typeof data.species === "string") this.species.set(subject, data.species.replaceAll("_", " "));
      this.events.push(...events);
      this.events.splice(0, Math.max(0, this.events.length - MOST));
      this.stale = true;
    });
  }

  opened(): void {
    this.stale = true;
    this.refresh();
  }

  /** Draws what is new, if it can be seen. */
  refresh(): void {
    if (!this.stale || !this.body.offsetParent) return;
    this.stale = false;
    const kinds = [...new Set(this.events.map((event) => event.kind))].sort();
    this.kinds.replaceChildren(...kinds.map((kind) => this.chip(kind)));
    const shown = this.events.filter((event) => !this.hidden.has(event.kind)).slice(-ROWS);
    this.list.replaceChildren(...shown.reverse().map((event) => this.row(event)));
    if (shown.length === 0)
      this.list.append(element("li", { class: "bio-quiet", textContent: "Nothing yet." }));
  }

  private remember(batches: BatchLayout[]): void {
    for (const batch of batches) {
      if (!batch.alive || this.known.has(batch)) continue;
      this.known.add(batch);
      const name = batch.species.replaceAll("_", " ");
      for (const id of batch.ids) this.species.set(id, name);
    }
  }

  private chip(kind: string): HTMLElement {
    const count = this.events.filter((event) => event.kind === kind).length;
    const chip = element("button", { class: "bio-chip", textContent: `${kind} ${count}` });
    chip.style.setProperty("--color", colorOf(kind));
    chip.classList.toggle("bio-off", this.hidden.has(kind));
    chip.onclick = () => {
      if (!this.hidden.delete(kind)) this.hidden.add(kind);
      this.stale = true;
      this.refresh();
    };
    return chip;
  }

  private row(event: WorldEvent): HTMLElement {
    const { kind, subject, object, data } = event;
    const details = Object.entries(data)
      .filter(([name]) => name !== "species")
      .map(([name, value]) => `${name} ${formatValue(name, value).text}`);
    const line = element(
      "li",
      {},
      element("button", {
        class: "bio-time",
        textContent: clock(event.time),
        title: "go to this moment",
        onclick: () => this.session.send({ do: "seek", tick: event.tick }),
      }),
      element("b", { textContent: kind, style: `color:${colorOf(kind)}` }),
      this.individual(subject),
      object ? this.individual(object) : null,
      element("small", { textContent: details.join(", ") }),
    );
    return line;
  }

  private individual(id: number): HTMLElement {
    const species = this.species.get(id);
    return element("button", {
      class: "bio-link",
      textContent: species ? `${species} #${id}` : `#${id}`,
      title: "select",
      onclick: () => this.select(id),
    });
  }
}
