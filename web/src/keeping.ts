import { Vector3 } from "three";
import type { Hello } from "./messages/types";
import { download } from "./overlays/dom";
import { changedSettings, formatHash, parseHash, type Shared } from "./share/link";
import { createPage, type PageSource } from "./share/page_copy";
import { Video } from "./share/video";
import type { Viewer } from "./viewer";

/** Metres ahead of the camera at which a shared link says it looks. */
const AHEAD = 5;

/** What can be kept and passed on: pictures, videos, links, recordings, snapshots. */
export class Keeping {
  /** The video being made. */
  video: Video | null = null;
  /** A share link says from where to look. */
  restoresCamera = false;
  private shared: Shared | null;

  constructor(
    private readonly viewer: Viewer,
    private readonly source: PageSource,
  ) {
    this.shared = viewer.session.transport.kind === "socket" ? parseHash(location.hash) : null;
    this.restoresCamera = this.shared !== null;
    viewer.session.on("hello", (hello) => this.greet(hello));
  }

  saveScreenshot(): void {
    const { stage, loop, notices } = this.viewer;
    loop.drawFinely(true);
    loop.drawAgain();
    stage.renderer.domElement.toBlob((content) => {
      if (!content)
        return notices.tell({
          level: "error",
          text: "The browser gave no picture.",
          remedy: "Try a smaller window.",
        });
      download(`${this.fileName()}.png`, content);
    }, "image/png");
    loop.drawFinely(false);
  }

  saveSnapshot(name: string, bytes: Uint8Array): void {
    download(name, new Blob([bytes as BlobPart]));
    this.viewer.notices.tell({
      level: "info",
      text: `Saved ${name}.`,
      remedy: "bio.World.restore reads it.",
    });
  }

  async copyLink(): Promise<void> {
    const { notices, session } = this.viewer;
    if (session.transport.kind !== "socket") {
      notices.tell({
        level: "info",
        text: "A link leads to a world with an address of its own.",
        remedy: "Run it with bioscope live.",
      });
      return;
    }
    const shared = this.describe();
    if (!shared) return;
    const address = new URL(location.href);
    address.hash = formatHash(shared);
    try {
      await navigator.clipboard.writeText(address.href);
      notices.tell({ level: "info", text: "Link to this moment copied." });
    } catch {
      history.replaceState(null, "", address);
      notices.tell({
        level: "info",
        text: "The link to this moment is in the address bar.",
        remedy: "Copy it from there.",
      });
    }
  }

  async savePage(): Promise<void> {
    const { recorder, notices, session } = this.viewer;
    const recording = recorder.save();
    const scripts = recording ? await this.source() : null;
    if (!recording || !scripts) {
      const text = recording ? "The page's own code cannot be read here." : "There is nothing recorded yet.";
      notices.tell({
        level: "warning",
        text,
        remedy: recording ? "Save from the page of bioscope live." : "Let the world run.",
      });
      return;
    }
    const page = await createPage(session.hello?.title ?? "Bioscope", recording, scripts);
    download(`${this.fileName()}.html`, page);
    const size = (page.size / 1e6).toFixed(1);
    notices.tell({
      level: "info",
      text: `Saved ${recorder.length} frames as a page (${size} MB).`,
      remedy: "It plays by itself, offline.",
    });
  }

  async toggleVideo(): Promise<void> {
    if (this.video) return this.video.stop();
    const { session, notices, loop, controls, stage } = this.viewer;
    if (!("VideoEncoder" in window)) {
      notices.tell({
        level: "error",
        text: "This browser cannot encode video.",
        remedy: "Use a current Chrome, Edge, Firefox or Safari on localhost or https.",
      });
      return;
    }
    const wasRunning = loop.frame?.running ?? false;
    this.video = new Video({
      canvas: stage.renderer.domElement,
      dt: session.hello?.dt ?? 1 / 60,
      get tick() {
        return loop.frame?.tick ?? 0;
      },
      step: (ticks) => session.send({ do: "step", ticks }),
      draw: (frame, seconds) => loop.drawExactly(frame, seconds),
      progress: (seconds) =>
        notices.stand("video", {
          level: "info",
          text: `Recording ${seconds.toFixed(1)} s.`,
          remedy: "V ends it.",
        }),
    });
    controls.mark("video", true);
    loop.drawFinely(true);
    const made = await this.video.record().catch((error: Error) => error);
    this.video = null;
    controls.mark("video", false);
    loop.drawFinely(false);
    notices.stand("video", null);
    if (wasRunning) session.send({ do: "play" });
    this.finishVideo(made);
  }

  private finishVideo(made: Awaited<ReturnType<Video["record"]>> | Error): void {
    const { notices } = this.viewer;
    if (made instanceof Error || !made) {
      const text = made
        ? `The video failed: ${made.message}`
        : "This browser has no encoder for video of this size.";
      notices.tell({ level: "error", text, remedy: "Try a smaller window." });
    } else {
      download(`${this.fileName()}.${made.extension}`, made.content);
      notices.tell({ level: "info", text: `Saved ${made.seconds.toFixed(1)} s of video.` });
    }
  }

  /** What a link to this moment restores. */
  private describe(): Shared | null {
    const { session, loop, parameters } = this.viewer;
    if (!session.hello || !loop.frame) return null;
    return {
      world: session.hello.world,
      seed: session.hello.seed,
      tick: loop.frame.tick,
      settings: [...changedSettings(parameters.owners, (owner, one) => parameters.initialOf(owner, one))],
      ...this.view(),
    };
  }

  /** How and from where one looks. */
  view(): Pick<Shared, "camera" | "eye" | "target"> {
    const { cameras } = this.viewer;
    const { position, rotation } = cameras.view;
    const target = new Vector3(0, 0, -AHEAD).applyQuaternion(rotation).add(position);
    return { camera: cameras.name, eye: position.toArray(), target: target.toArray() };
  }

  /** At the first greeting: what a share link asks for, else the world's own cameras. */
  private greet(hello: Hello): void {
    const { cameras, session, notices } = this.viewer;
    const first = cameras.names.length === 4 && cameras.name === "free" && this.viewer.loop.pictures === 0;
    const { shared } = this;
    this.shared = null;
    cameras.offer(hello, first && !shared);
    if (!shared) return;
    history.replaceState(null, "", location.pathname + location.search);
    if (shared.world !== hello.world) {
      const remedy = `Run bioscope live ${shared.world} and open it there.`;
      notices.tell({
        level: "warning",
        text: `The link is of the world ${shared.world}, this is ${hello.world}.`,
        remedy,
      });
      return;
    }
    session.send({ do: "restart", seed: shared.seed, set: shared.settings, tick: shared.tick });
    session.send({ do: "pause" });
    if (cameras.names.includes(shared.camera) && !["free", "follow", "eye"].includes(shared.camera))
      cameras.use(shared.camera);
    else cameras.lookFrom(shared.eye, shared.target);
    notices.tell({
      level: "info",
      text: `Shared moment: seed ${shared.seed}, tick ${shared.tick}.`,
      remedy: "Space lets it run.",
    });
  }

  /** Name for a file to keep, without its ending. */
  private fileName(): string {
    const { hello } = this.viewer.session;
    const name = (hello?.title ?? "world").replace(/[^\p{L}\p{N}]+/gu, "-");
    return `${name}-${hello?.seed ?? 0}-${this.viewer.loop.frame?.tick ?? 0}`;
  }
}
