import type { Session } from "../messages/session";
import { element } from "./dom";

/** Asks with which seed to begin anew. */
export class RestartDialog {
  readonly element;
  private readonly seed = element("input", {
    type: "text",
    inputMode: "numeric",
    pattern: "\\d*",
    ariaLabel: "seed",
  });

  private readonly another = element("button", { type: "button", textContent: "with another" });

  constructor(private readonly session: Session) {
    this.another.onclick = () => this.restart(randomSeed());
    const form = element(
      "form",
      { class: "bio-card" },
      element("h2", { textContent: "Begin anew" }),
      element("label", {}, "seed ", this.seed),
      element(
        "div",
        { class: "bio-row" },
        element("button", { type: "submit", textContent: "with this seed" }),
        element("button", {
          type: "button",
          textContent: "with another",
          onclick: () => this.restart(randomSeed()),
        }),
        element("button", { type: "button", textContent: "cancel", onclick: () => this.close() }),
      ),
    );
    form.onsubmit = (event) => {
      event.preventDefault();
      this.restart(
        /^\d{1,15}$/.test(this.seed.value) ? Number(this.seed.value) : (this.session.hello?.seed ?? null),
      );
    };
    form.onkeydown = (event) => {
      event.stopPropagation();
      if (event.key === "Escape") this.close();
    };
    this.element = element("div", { class: "bio-help", hidden: true }, form);
  }

  open(): void {
    this.seed.value = String(this.session.hello?.seed ?? "");
    const free = this.session.hello?.page.includes("restart") ?? true;
    this.seed.disabled = !free; // a world made by a program knows no other seed
    this.another.hidden = !free;
    this.element.hidden = false;
    this.seed.focus();
    this.seed.select();
  }

  /** Closes it; says whether it was open. */
  close(): boolean {
    const open = !this.element.hidden;
    this.element.hidden = true;
    return open;
  }

  private restart(seed: number | null): void {
    this.session.send({ do: "restart", seed });
    this.close();
  }
}

function randomSeed(): number {
  return crypto.getRandomValues(new Uint32Array(1))[0] % 1_000_000;
}
