import { ACTIONS, type Action } from "../actions";
import { element } from "./dom";

/** The page of keys. */
export class Help {
  readonly element = element("div", { class: "bio-help", hidden: true });

  constructor() {
    const groups = [...new Set(ACTIONS.map((action) => action.group))];
    const card = element("div", { class: "bio-card" }, element("h2", { textContent: "Keys" }));
    const columns = element("div", { class: "bio-columns" });
    for (const group of groups)
      columns.append(
        section(
          group,
          ACTIONS.filter((action) => action.group === group),
        ),
      );
    const mouse =
      "Click an animal to select it. Drag to turn, drag with the right button to move sideways, turn the wheel to come nearer.";
    card.append(columns, element("p", { textContent: mouse }));
    this.element.append(card);
    this.element.addEventListener("click", () => this.close());
  }

  toggle(): void {
    this.element.hidden = !this.element.hidden;
  }

  /** Closes it; says whether it was open. */
  close(): boolean {
    const open = !this.element.hidden;
    this.element.hidden = true;
    return open;
  }
}

function section(title: string, actions: Action[]): HTMLElement {
  const list = element("dl");
  for (const { key, keyLabel, meaning } of actions) {
    if (!key) continue;
    list.append(
      element("dt", {}, element("kbd", { textContent: keyLabel ?? key })),
      element("dd", { textContent: meaning }),
    );
  }
  return element("section", {}, element("h3", { textContent: title }), list);
}
