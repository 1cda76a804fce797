import { element } from "../overlays/dom";

/** Least and greatest share of the width that the text has. */
const LEAST = 0.2;
const MOST = 0.75;

/** The line between text and plant, which can be dragged. */
export class Splitter {
  readonly element = element("div", {
    class: "bio-splitter",
    role: "separator",
    ariaLabel: "width of the text",
  });

  constructor(root: HTMLElement) {
    this.element.onpointerdown = (down) => this.element.setPointerCapture(down.pointerId);
    this.element.onpointermove = (move) => {
      if (!this.element.hasPointerCapture(move.pointerId)) return;
      const share = Math.min(MOST, Math.max(LEAST, move.clientX / root.clientWidth));
      root.style.setProperty("--text-width", `${(100 * share).toFixed(2)}%`);
    };
  }
}
