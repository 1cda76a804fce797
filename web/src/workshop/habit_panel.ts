import { element, nameOf } from "../overlays/dom";
import type { Panel } from "../overlays/panels";
import { type Toggle, toggle } from "./slider";
import type { Subject } from "./subject";

/** Habits by the names of their parameters, in pairs that cancel each other. */
const PAIRS: [string, string][][] = [
  [
    ["likes_bright", "brightness"],
    ["likes_dark", "darkness"],
  ],
  [
    ["likes_cold", "cold"],
    ["likes_warm", "warmth"],
  ],
  [["likes_company", "company of its kind"]],
];

/** What a fish likes, and its sex. */
export class HabitPanel implements Panel {
  readonly name = "habits";
  readonly title = "Habits";
  readonly body = element("div", { class: "bio-habits" });
  private readonly whom = element("p", { class: "bio-quiet" });
  private readonly mind = element("div");
  private readonly note = element("p", { class: "bio-quiet" });
  private readonly buttons = new Map<string, Toggle>();
  private readonly sexes: Toggle[] = [];

  constructor(private readonly subject: Subject) {
    this.mind.append(subject.scope(), element("h4", { textContent: "It likes" }));
    for (const pair of PAIRS) {
      const row = element("div", { class: "bio-row" });
      for (const [name, label] of pair) {
        const button = toggle(label, "", (on) => subject.set(name, on ? 1 : 0));
        button.element.dataset.habit = name;
        this.buttons.set(name, button);
        row.append(button.element);
      }
      this.mind.append(row);
    }
    const sex = element("div", { class: "bio-row" });
    for (const [female, label] of [
      [1, "female"],
      [0, "male"],
    ] as const) {
      const button = toggle(label, "", () => subject.set("female", female));
      this.sexes.push(button);
      sex.append(button.element);
    }
    this.mind.append(this.note, element("h4", { textContent: "It is" }), sex);
    this.body.append(this.whom, this.mind);
    subject.listeners.push(() => this.take());
  }

  opened(): void {
    this.take();
  }

  private take(): void {
    const { now, mind } = this.subject;
    const minded = now !== null && mind !== "";
    this.mind.hidden = !minded;
    const text = now === null ? "Click a fish." : nameOf(now.species, now.id);
    this.whom.textContent = now === null || minded ? text : `${text} has no habits.`;
    if (!minded) return;
    const has = (name: string) => (this.subject.value(name) ?? 0) >= 0.5;
    for (const [name, button] of this.buttons) button.show(has(name));
    this.sexes[0].show(has("female"));
    this.sexes[1].show(!has("female"));
    const both = PAIRS.filter((pair) => pair.length === 2 && pair.every(([name]) => has(name)));
    const words = both.map((pair) => pair.map(([, label]) => label).join(" and "));
    this.note.textContent =
      words.length > 0 ? `Indifferent to ${words.join(" and to ")}: it likes both.` : "";
  }
}
