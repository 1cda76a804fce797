import { element } from "./dom";

export type Level = "info" | "warning" | "error";

/** Seconds after which a passing message goes. */
const STAY = { info: 5, warning: 12, error: 30 };
/** Messages shown at once. */
const MOST = 4;

export interface Notice {
  level: Level;
  text: string;
  /** What the person can do about it. */
  remedy?: string;
  /** A button that does it. */
  button?: { label: string; run: () => void };
}

/** Messages to the person at the top of the page: passing ones, and standing ones for a state that lasts. */
export class Notices {
  readonly element = element("div", { class: "bio-notices", role: "status", ariaLive: "polite" });
  private readonly standing = new Map<string, HTMLElement>();

  /** Says something that passes. */
  tell(notice: Notice): void {
    const card = this.card(notice);
    this.element.append(card);
    const timer = window.setTimeout(() => card.remove(), STAY[notice.level] * 1000);
    card.querySelector(".bio-close")?.addEventListener("click", () => {
      window.clearTimeout(timer);
      card.remove();
    });
    const passing = this.element.querySelectorAll(":scope > :not([data-standing])");
    if (passing.length > MOST) passing[0].remove();
  }

  /** Says something for as long as it is true; null: it no longer is. */
  stand(subject: string, notice: Notice | null): void {
    this.standing.get(subject)?.remove();
    this.standing.delete(subject);
    if (!notice) return;
    const card = this.card(notice);
    card.dataset.standing = subject;
    card.querySelector(".bio-close")?.addEventListener("click", () => card.remove());
    this.element.prepend(card);
    this.standing.set(subject, card);
  }

  private card({ level, text, remedy, button }: Notice): HTMLElement {
    const card = element(
      "div",
      { class: `bio-notice bio-${level}` },
      element("span", { class: "bio-text" }, text, remedy ? element("em", {}, ` ${remedy}`) : null),
      button ? element("button", { textContent: button.label, onclick: button.run }) : null,
      element("button", { class: "bio-close", textContent: "×", ariaLabel: "dismiss" }),
    );
    return card;
  }
}
