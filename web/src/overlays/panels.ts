import { element, sign } from "./dom";
import { SIGNS } from "./signs";

export interface Panel {
  name: string;
  title: string;
  body: HTMLElement;
  /** Called when it is opened. */
  opened?(): void;
}

/** The panels at the left edge, one open at a time. */
export class Panels {
  readonly element = element("div", { class: "bio-panels" });
  /** Called when a panel has been opened or closed. */
  changed: (name: string, open: boolean) => void = () => {};
  private open: string | null = null;
  private readonly cards = new Map<string, { panel: Panel; card: HTMLElement }>();

  add(panel: Panel): void {
    const close = element(
      "button",
      { class: "bio-close", ariaLabel: "close", onclick: () => this.close() },
      sign(SIGNS.close),
    );
    const head = element("header", {}, element("h2", { textContent: panel.title }), close);
    const card = element(
      "section",
      { class: "bio-card bio-panel", hidden: true, data: { panel: panel.name } },
      head,
      panel.body,
    );
    this.cards.set(panel.name, { panel, card });
    this.element.append(card);
  }

  isOpen(name: string): boolean {
    return this.open === name;
  }

  toggle(name: string): void {
    const again = this.open === name;
    this.close();
    if (again) return;
    const { panel, card } = this.cards.get(name)!;
    card.hidden = false;
    card.scrollTop = 0;
    this.open = name;
    panel.opened?.();
    this.changed(name, true);
  }

  /** Closes the open panel; says whether there was one. */
  close(): boolean {
    const name = this.open;
    if (name === null) return false;
    this.cards.get(name)!.card.hidden = true;
    this.open = null;
    this.changed(name, false);
    return true;
  }
}
