import { actionNamed } from "../actions";
import type { Frame } from "../messages/types";
import type { Viewer } from "../viewer";
import { element, sign } from "./dom";
import { SIGNS } from "./signs";
import { TimelineBar } from "./timeline_bar";

/** The bar at the lower edge. */
export class Controls {
  readonly element;
  readonly timeline: TimelineBar;
  private readonly buttons = new Map<string, HTMLButtonElement>();
  private readonly speed = element("span", {
    class: "bio-speed",
    title: "speed wanted; ticks per second achieved",
  });
  private readonly cameraName = element("span", { class: "bio-camera-name" });

  constructor(private readonly viewer: Viewer) {
    this.timeline = new TimelineBar(viewer.session);
    const camera = this.button("camera");
    camera.append(this.cameraName);
    this.element = element(
      "div",
      { class: "bio-bar" },
      this.group("restart", "back", "play", "step"),
      this.timeline.element,
      element("div", { class: "bio-group" }, this.button("slower"), this.speed, this.button("faster")),
      element("div", { class: "bio-group" }, camera),
      this.group("annotations"),
      this.group("screenshot", "video", "share", "page", "snapshot", "help"),
    );
  }

  show(frame: Frame): void {
    this.timeline.show(frame);
    const play = this.buttons.get("play")!;
    const running = String(frame.running);
    if (play.dataset.running !== running) {
      play.dataset.running = running;
      play.replaceChildren(sign(frame.running ? SIGNS.pause : SIGNS.play));
    }
    const wanted = frame.speed === null ? "max" : `${Number(frame.speed.toPrecision(2))}×`;
    const text = frame.running ? `${wanted} · ${Math.round(frame.rate)}/s` : `${wanted} · paused`;
    if (this.speed.textContent !== text) this.speed.textContent = text;
  }

  showCamera(name: string): void {
    this.cameraName.textContent = name;
  }

  mark(name: string, on: boolean): void {
    this.buttons.get(name)?.classList.toggle("bio-on", on);
  }

  private group(...names: string[]): HTMLElement {
    return element("div", { class: "bio-group" }, ...names.map((name) => this.button(name)));
  }

  private button(name: string): HTMLButtonElement {
    const action = actionNamed(name);
    const key = action.keyLabel ?? action.key;
    const title = key ? `${action.meaning} (${key})` : action.meaning;
    const button = element("button", { title, ariaLabel: action.meaning, data: { action: name } });
    if (action.sign) button.append(sign(SIGNS[action.sign]));
    button.onclick = () => {
      action.run(this.viewer);
      button.blur(); // so that Space goes on meaning play
    };
    this.buttons.set(name, button);
    return button;
  }
}
