import { element, sign } from "../overlays/dom";
import { SIGNS } from "../overlays/signs";
import type { Grown } from "./messages";

/** The string behind the plant. */
export class StringSheet {
  readonly element;
  /** Whether the string is shown as the turtle reads it. */
  homomorphism = false;
  private readonly count = element("span", { class: "bio-quiet" });
  private readonly text = element("pre", { tabIndex: 0 });
  private readonly choice = element("input", { type: "checkbox", onchange: () => this.choose() });

  /** `changed` is called when the other string is wanted, or the sheet opens or closes. */
  constructor(private readonly changed: () => void) {
    const close = element("button", {
      class: "bio-close",
      ariaLabel: "close",
      onclick: () => this.toggle(),
    });
    close.append(sign(SIGNS.close));
    const label = element(
      "label",
      { title: "after the productions of the homomorphism part" },
      this.choice,
      " homomorphism",
    );
    const head = element("header", {}, element("h2", { textContent: "String" }), this.count, label, close);
    this.element = element("section", { class: "bio-card bio-string", hidden: true }, head, this.text);
  }

  toggle(): void {
    this.element.hidden = !this.element.hidden;
    this.changed();
  }

  show({ string, letters, modules, steps }: Grown): void {
    const rest = letters - string.length;
    const shown = rest > 0 ? `the first ${string.length.toLocaleString("en")} of ` : "";
    this.count.textContent = `step ${steps} · ${modules.toLocaleString("en")} modules · ${shown}${letters.toLocaleString("en")} letters`;
    this.text.textContent = rest > 0 ? `${string} …` : string;
  }

  private choose(): void {
    this.homomorphism = this.choice.checked;
    this.changed();
  }
}
