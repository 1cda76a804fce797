import { type Action, actionNamed } from "../actions";
import { element, sign } from "../overlays/dom";
import { SIGNS } from "../overlays/signs";
import type { Viewer } from "../viewer";

/** The panels that the dock opens, by the names of their actions. */
const PANELS = ["numbers", "layout", "physics", "behavior", "habits", "view"];
const OTHERS = ["parameters", "populations", "events"];

/** The general control panel: a strip at the left edge with a sign for every panel. */
export class Dock {
  readonly element = element("nav", { class: "bio-dock", ariaLabel: "panels" });
  private readonly buttons = new Map<string, HTMLButtonElement>();

  constructor(private readonly viewer: Viewer) {
    if (viewer.session.transport.kind !== "recording") {
      for (const name of PANELS) this.add(actionNamed(name));
      this.element.append(element("hr"));
    }
    for (const name of OTHERS) this.add(actionNamed(name));
  }

  mark(name: string, on: boolean): void {
    this.buttons.get(name)?.classList.toggle("bio-on", on);
  }

  private add(action: Action): void {
    const key = action.keyLabel ?? action.key;
    const button = element("button", {
      title: key ? `${action.meaning} (${key})` : action.meaning,
      ariaLabel: action.meaning,
      data: { panel: action.name },
    });
    if (action.sign) button.append(sign(SIGNS[action.sign]));
    button.onclick = () => {
      action.run(this.viewer);
      button.blur(); // so that Space goes on meaning play
    };
    this.buttons.set(action.name, button);
    this.element.append(button);
  }
}
