import type { Frame, Layout } from "./messages/types";
import { type Moment, PlayoutQueue } from "./playout/queue";
import { isSoftware } from "./scene/graphics";
import { QUALITIES, QualityGovernor } from "./scene/quality";
import type { Viewer } from "./viewer";

/** Milliseconds between refreshes of charts and lists. */
const PANEL_PAUSE = 250;
/** Milliseconds between connections anew because an asset was missing. */
const RECONNECT_PAUSE = 4000;

/** Takes frames from the world and makes pictures of them, as often as the screen wants one. */
export class FrameLoop {
  /** The frame on the screen. */
  frame: Frame | null = null;
  /** Pictures drawn. */
  pictures = 0;
  /** Times that the screen wanted a picture since the world's last frame. */
  picturesSinceFrame = 0;
  readonly governor: QualityGovernor;
  private readonly queue = new PlayoutQueue();
  /** The layout received last. */
  private layout: Layout | null = null;
  /** The layout that each frame belongs to. */
  private readonly layouts = new WeakMap<Frame, Layout>();
  private readonly observer: ResizeObserver;
  private request = 0;
  private lastTime = 0;
  private lastPanels = 0;
  private lastReconnect = 0;
  private readonly unseen: number[] = [];
  private inspected = false;
  private fine = false;
  /** What is on the screen. */
  private moment: Moment | null = null;
  private renewed = false;
  private wasBroken = false;
  private visible = false;
  private size = { width: 1, height: 1 };

  constructor(private readonly viewer: Viewer) {
    const { session, stage } = viewer;
    this.governor = new QualityGovernor(isSoftware(stage.renderer));
    this.observer = new ResizeObserver(() => this.resize());
    session.on("hello", () => this.queue.clear());
    session.on("layout", (layout) => {
      if (this.renewed) {
        this.queue.clear();
        viewer.stage.outdate();
        this.renewed = false;
      }
      this.layout = layout;
      viewer.stage.assets.settle();
    });
    session.on("frame", (frame) => this.take(frame));
    session.on("inspection", () => {
      this.inspected = true;
    });
    for (const kind of ["mesh", "material", "texture"] as const) {
      session.on(kind, (message) => viewer.stage.takeAsset(message));
    }
  }

  start(): void {
    this.observer.observe(this.viewer.root);
    this.resize();
    this.request = requestAnimationFrame((now) => this.draw(now));
  }

  stop(): void {
    cancelAnimationFrame(this.request);
    this.observer.disconnect();
  }

  /** Draws a frame exactly as it is, for a video. */
  drawExactly(frame: Frame, seconds: number): void {
    const cut = !this.frame || frame.tick < this.frame.tick;
    this.show({ frame, blend: 1, fresh: true, cut }, seconds);
  }

  /** Draws as finely as can be, whatever it costs, for a picture or video to keep. */
  drawFinely(on: boolean): void {
    this.fine = on;
    this.resize();
  }

  /** Draws the picture on the screen again, so that it can be read from the canvas. */
  drawAgain(): void {
    const { stage, cameras } = this.viewer;
    if (this.moment) stage.prepare(cameras.camera, this.moment); // meshes as fine as the quality is now
    stage.render(cameras.camera);
  }

  /** A new connection brings everything anew; until it has, the last picture stays. */
  begin(): void {
    this.layout = null;
    this.unseen.length = 0;
    this.renewed = true;
  }

  private take(frame: Frame): void {
    this.unseen.push(frame.tick);
    this.picturesSinceFrame = 0;
    if (frame.layout !== this.layout?.revision) {
      this.missing(new Error("a layout"));
      return;
    }
    this.layouts.set(frame, this.layout);
    if (this.viewer.keeping.video) {
      this.acknowledge();
      this.viewer.keeping.video.take(frame);
    } else this.queue.push(frame, performance.now());
  }

  private draw(now: number): void {
    this.request = requestAnimationFrame((next) => this.draw(next));
    this.acknowledge();
    this.picturesSinceFrame += 1;
    const passed = this.lastTime === 0 ? 16 : now - this.lastTime;
    this.lastTime = now;
    if (this.viewer.keeping.video) return;
    const moment = this.queue.at(now);
    if (!moment) return;
    try {
      this.show(moment, Math.min(0.1, passed / 1000));
    } catch (error) {
      this.broken(error as Error);
    }
    if (this.visible && this.governor.note(passed)) this.lowerQuality();
    this.visible = document.visibilityState === "visible";
    if (now - this.lastPanels > PANEL_PAUSE) {
      this.lastPanels = now;
      this.viewer.refreshPanels();
    }
  }

  /** Tells the world that its frames and inspections have arrived where pictures are made, each once. */
  private acknowledge(): void {
    const { session } = this.viewer;
    for (const tick of this.unseen.splice(0)) session.send({ do: "seen", tick });
    if (this.inspected) session.send({ do: "inspected" });
    this.inspected = false;
  }

  private show(moment: Moment, dt: number): void {
    const { stage, cameras, selection, controls } = this.viewer;
    if (moment.fresh && !this.advance(moment)) return;
    if (!stage.layout) return;
    this.moment = moment;
    const time = moment.frame.time;
    const scenery = { stage, time, selected: selection.id, dt };
    cameras.update(scenery, this.size.width / this.size.height);
    stage.hidden = cameras.name === "eye" ? selection.id : 0;
    stage.prepare(cameras.camera, moment);
    stage.render(cameras.camera);
    this.drawMarks(moment.frame);
    controls.show(moment.frame);
    this.pictures += 1;
  }

  /** Takes a new frame to the stage, and its layout before it; says whether it can be drawn. */
  private advance({ frame, cut }: Moment): boolean {
    const { stage, selection, cameras } = this.viewer;
    const layout = this.layouts.get(frame);
    if (!layout) return false;
    if (layout !== stage.layout) {
      const first = stage.layout === null;
      const coming = new Set(this.queue.coming.flatMap((one) => this.layouts.get(one) ?? []));
      if (this.layout) coming.add(this.layout);
      try {
        stage.setLayout(layout, [...coming]);
      } catch (error) {
        this.missing(error as Error);
        return false;
      }
      selection.check();
      if (first && cameras.name === "free" && !this.viewer.keeping.restoresCamera)
        cameras.frame(layout.bounds);
    }
    stage.setFrame(frame, cut);
    this.frame = frame;
    return true;
  }

  /** A picture could not be drawn: said once, while the next are tried. */
  private broken(error: Error): void {
    if (this.wasBroken) return;
    this.wasBroken = true;
    console.error(error);
    this.viewer.notices.stand("picture", {
      level: "error",
      text: `The picture cannot be drawn (${error.message}).`,
      remedy: "Reload the page; if it happens again, page and world are of different versions.",
    });
  }

  /** Something that a layout needs never came, or was forgotten: a new connection brings everything. */
  private missing(error: Error): void {
    const now = performance.now();
    if (now - this.lastReconnect < RECONNECT_PAUSE) return;
    this.lastReconnect = now;
    this.viewer.notices.tell({
      level: "warning",
      text: `Part of the scene is missing (${error.message}).`,
      remedy: "Connecting anew.",
    });
    this.viewer.session.transport.reconnect();
  }

  private drawMarks(frame: Frame): void {
    const { stage, cameras, selection, marks, inspector, annotations } = this.viewer;
    const found = cameras.name === "eye" ? null : stage.find(selection.id);
    let ring = null;
    if (found) {
      const place = found.batch.placeOf(found.slot);
      const radius = found.batch.asset.radius * place[3];
      ring = {
        place: [place[0], place[1], place[2]] as [number, number, number],
        radius,
        behavior: inspector.latest?.behavior ?? null,
      };
    }
    marks.draw(cameras.camera, ring, annotations ? frame.annotations : undefined);
    if (marks.labels) marks.drawLabels(cameras.camera, stage.labels());
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.viewer.root;
    if (width === 0 || height === 0) return;
    this.size = { width, height };
    const quality = QUALITIES[this.fine ? 0 : this.governor.level];
    this.viewer.stage.resize(width, height, window.devicePixelRatio, quality);
    this.viewer.marks.resize(width, height);
  }

  private lowerQuality(): void {
    this.resize();
    const { name } = QUALITIES[this.governor.level];
    const last = this.governor.level === QUALITIES.length - 1;
    if (last) {
      this.viewer.notices.tell({
        level: "warning",
        text: "This machine draws slowly, so the picture is coarse.",
        remedy: "A smaller window helps, or hardware acceleration switched on in the browser.",
      });
    } else this.viewer.notices.tell({ level: "info", text: `Drawing at lower cost (${name}) to keep up.` });
  }
}
