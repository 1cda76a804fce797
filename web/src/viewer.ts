import type { WebGLRenderer } from "three";
import { actionFor, isTyping } from "./actions";
import { Cameras } from "./camera/cameras";
import { Inspector } from "./inspector/inspector";
import { ParameterPane, ParameterStore } from "./inspector/parameters";
import { Populations } from "./inspector/populations";
import { Selection } from "./inspector/selection";
import { Keeping } from "./keeping";
import { FrameLoop } from "./loop";
import { Recorder } from "./messages/recorder";
import { Session } from "./messages/session";
import type { Transport } from "./messages/transport";
import { Controls } from "./overlays/controls";
import { element } from "./overlays/dom";
import { EventList } from "./overlays/event_list";
import { Help } from "./overlays/help";
import { LinkWatch } from "./overlays/link_watch";
import { Marks } from "./overlays/marks";
import { Notices } from "./overlays/notices";
import { Panels } from "./overlays/panels";
import { RestartDialog } from "./overlays/restart_dialog";
import { Picker } from "./scene/picker";
import { Stage } from "./scene/stage";
import type { PageSource } from "./share/page_copy";
import { injectStyles } from "./styles";
import { Dock } from "./workshop/dock";
import { Workshop } from "./workshop/workshop";

/** Steps of the world's speed, times real time. */
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 32, 64, 100];
/** Seconds without the mouse after which the controls fade. */
const IDLE = 3.5;
/** A press that moves less than this (pixels) and is shorter than this (milliseconds) is a click. */
const CLICK_WAY = 5;
const CLICK_TIME = 450;

/** The whole live view in one element of a page. */
export class Viewer {
  readonly root = element("div", { class: "bioscope bio-idle", tabIndex: 0 });
  readonly session: Session;
  readonly stage: Stage;
  readonly cameras: Cameras;
  readonly selection: Selection;
  readonly inspector: Inspector;
  readonly parameters: ParameterStore;
  readonly notices = new Notices();
  readonly marks = new Marks();
  readonly help = new Help();
  readonly panels = new Panels();
  readonly recorder = new Recorder();
  readonly controls: Controls;
  readonly keeping: Keeping;
  readonly workshop: Workshop;
  readonly loop: FrameLoop;
  /** Whether what animals sense and decide is shown. */
  annotations = false;
  private readonly dock: Dock;
  private readonly dialog: RestartDialog;
  private readonly populations: Populations;
  private readonly events: EventList;
  private readonly picker: Picker;
  private readonly watch: LinkWatch;
  private readonly stopping = new AbortController();
  private idleTimer: number | undefined;

  constructor(
    private readonly host: HTMLElement,
    renderer: WebGLRenderer,
    transport: Transport,
    source: PageSource,
  ) {
    injectStyles();
    this.session = new Session(transport);
    this.session.onAny((message, bytes) => this.recorder.note(message, bytes));
    this.stage = new Stage(renderer);
    const select = (id: number) => this.selection.select(id);
    this.cameras = new Cameras(renderer.domElement);
    this.selection = new Selection(this.session, this.stage);
    this.parameters = new ParameterStore(this.session);
    const species = (id: number) => this.stage.find(id)?.batch.layout.species ?? "";
    this.inspector = new Inspector(this.session, this.parameters, select, species);
    this.populations = new Populations(this.session);
    this.events = new EventList(this.session, select);
    this.controls = new Controls(this);
    this.dialog = new RestartDialog(this.session);
    this.picker = new Picker(this.stage);
    this.keeping = new Keeping(this, source);
    this.workshop = new Workshop(this);
    this.dock = new Dock(this);
    this.loop = new FrameLoop(this);
    this.watch = new LinkWatch(this);
    this.assemble(renderer.domElement);
    this.connectParts();
  }

  start(): void {
    this.host.append(this.root);
    this.listen();
    this.session.open();
    this.loop.start();
  }

  stop(): void {
    this.stopping.abort();
    window.clearTimeout(this.idleTimer);
    this.loop.stop();
    this.watch.stop();
    this.session.transport.close();
    this.picker.dispose();
    this.stage.dispose();
    this.root.remove();
  }

  toggleRunning(): void {
    this.session.send({ do: this.loop.frame?.running ? "pause" : "play" });
  }

  changeSpeed(steps: number): void {
    const now = this.loop.frame?.speed ?? SPEEDS.at(-1)!;
    const nearest = SPEEDS.reduce((best, one) => (Math.abs(one - now) < Math.abs(best - now) ? one : best));
    const index = Math.min(SPEEDS.length - 1, Math.max(0, SPEEDS.indexOf(nearest) + steps));
    this.session.send({ do: "speed", factor: SPEEDS[index] });
  }

  toggleFastest(): void {
    this.session.send({ do: "speed", factor: this.loop.frame?.speed === null ? 1 : null });
  }

  toggleAnnotations(): void {
    this.annotations = !this.annotations;
    this.session.send({ do: "annotations", on: this.annotations });
    this.controls.mark("annotations", this.annotations);
  }

  askRestart(): void {
    this.dialog.open();
  }

  saveScreenshot(): void {
    this.keeping.saveScreenshot();
  }

  toggleVideo(): void {
    void this.keeping.toggleVideo();
  }

  copyLink(): void {
    void this.keeping.copyLink();
  }

  savePage(): void {
    void this.keeping.savePage();
  }

  /** Closes the topmost thing that is open; then selects nothing. */
  dismiss(): void {
    const { steering } = this.workshop;
    if (this.help.close() || this.dialog.close()) return;
    if (steering.end() || this.panels.close()) return;
    this.selection.select(0);
  }

  /** Draws in the side panels what is new. */
  refreshPanels(): void {
    this.populations.refresh();
    this.events.refresh();
    this.inspector.refresh();
    this.workshop.refresh();
  }

  private assemble(canvas: HTMLCanvasElement): void {
    canvas.className = "bio-picture";
    const right = element("div", { class: "bio-right" }, this.inspector.element);
    this.root.append(canvas, this.marks.element, this.controls.element);
    this.root.append(this.dock.element, this.panels.element, right);
    this.root.append(this.notices.element, this.help.element, this.dialog.element);
    const pane = new ParameterPane(this.parameters, () => this.parameters.owners);
    this.panels.add({ name: "parameters", title: "Parameters", body: pane.element });
    this.panels.add(this.populations);
    this.panels.add(this.events);
  }

  private connectParts(): void {
    const { session, selection, cameras } = this;
    session.on("hello", (hello) => {
      document.title = this.host === document.body ? `${hello.title} · Bioscope` : document.title;
      if (this.annotations) session.send({ do: "annotations", on: true });
    });
    session.on("snapshot", ({ name, bytes }) => this.keeping.saveSnapshot(name, bytes));
    selection.changed = (id, species) => {
      this.inspector.open(id, species);
      this.workshop.selected(id);
      if (id === 0 && ["eye", "follow"].includes(cameras.name)) cameras.use("free");
    };
    selection.lost = (species) =>
      this.notices.tell({ level: "info", text: `The selected ${species} is no longer in the world.` });
    cameras.changed = (name) => this.controls.showCamera(name);
    this.panels.changed = (name, open) => {
      this.controls.mark(name, open);
      this.dock.mark(name, open);
      if (name === "view" && !open) selection.look({ pan: 0, tilt: 0, both: false });
    };
  }

  private listen(): void {
    const { signal } = this.stopping;
    const keys: EventTarget = this.host === document.body ? window : this.root;
    const { steering } = this.workshop;
    keys.addEventListener("keydown", (event) => this.press(event as KeyboardEvent), { signal });
    keys.addEventListener("keyup", (event) => void steering.press(event as KeyboardEvent, false), { signal });
    window.addEventListener("blur", () => steering.letGo(), { signal });
    for (const kind of ["pointermove", "pointerdown", "keydown"]) {
      this.root.addEventListener(kind, () => this.wake(), { signal });
    }
    const canvas = this.stage.renderer.domElement;
    let from: PointerEvent | null = null;
    const down = (event: PointerEvent) => {
      from = event;
      if (steering.id !== 0) return this.steer(event);
      if (event.button !== 0 || event.pointerType === "touch") this.cameras.touched();
    };
    const moved = (event: PointerEvent) => {
      if (steering.id !== 0) return this.steer(event);
      if (from && event.buttons && wayBetween(from, event) > CLICK_WAY) this.cameras.touched();
    };
    const up = (event: PointerEvent) => {
      if (steering.id !== 0) {
        from = null;
        return steering.point(null);
      }
      if (!from || event.button !== 0) return;
      const click = wayBetween(from, event) <= CLICK_WAY && event.timeStamp - from.timeStamp < CLICK_TIME;
      from = null;
      if (click) this.pick(event);
    };
    canvas.addEventListener("pointerdown", down, { signal, capture: true });
    canvas.addEventListener("pointermove", moved, { signal });
    canvas.addEventListener("pointerup", up, { signal });
    canvas.addEventListener("wheel", () => this.cameras.touched(), { signal, capture: true, passive: true });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault(), { signal });
    canvas.addEventListener("webglcontextlost", () => this.watch.graphicsLost(), { signal });
  }

  /** Steers towards the mouse while its button is held; the camera stays. */
  private steer(event: PointerEvent): void {
    event.stopImmediatePropagation();
    if ((event.buttons & 1) === 0) return;
    const box = this.stage.renderer.domElement.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    this.workshop.steering.point([2 * x - 1, 2 * y - 1]);
  }

  private press(event: KeyboardEvent): void {
    const steers = !isTyping(event) && this.workshop.steering.press(event, true);
    const action = steers ? undefined : actionFor(event);
    if (steers || action) event.preventDefault();
    action?.run(this);
  }

  private pick(event: PointerEvent): void {
    const box = this.stage.renderer.domElement.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    this.selection.select(this.picker.pick(this.cameras.camera, x, y, box.width, box.height));
  }

  private wake(): void {
    this.root.classList.remove("bio-idle");
    window.clearTimeout(this.idleTimer);
    this.idleTimer = window.setTimeout(() => this.root.classList.add("bio-idle"), IDLE * 1000);
  }
}

function wayBetween(from: PointerEvent, to: PointerEvent): number {
  return Math.hypot(to.clientX - from.clientX, to.clientY - from.clientY);
}
