import type { LinkState } from "../messages/transport";
import type { Viewer } from "../viewer";

/** Seconds without a frame from a running world after which we say so. */
const SILENCE = 5;
/** A page that has drawn fewer pictures than this in the silence is itself what is slow. */
const PICTURES = 10;
/** Unreadable messages after which we say so. */
const UNREADABLE = 1;

/** Says what is wrong with the connection, the world or the graphics, and what helps. */
export class LinkWatch {
  private readonly timer: number;
  /** Looks at the clock, a second apart, since the last frame: a page that is held up itself makes fewer. */
  private silent = 0;
  private running = false;
  private unreadable = 0;

  constructor(private readonly viewer: Viewer) {
    const { session, notices } = viewer;
    session.linked = (state) => this.linked(state);
    session.failed = (error) => this.failed(error);
    session.on("hello", () => {
      notices.stand("link", null);
      notices.stand("world", null);
      this.silent = 0;
    });
    session.on("frame", (frame) => {
      this.silent = 0;
      this.running = frame.running;
      notices.stand("silence", null);
    });
    session.on("notice", ({ level, text }) => {
      if (level === "error") notices.stand("world", { level, text });
      else notices.tell({ level, text });
    });
    this.timer = window.setInterval(() => this.look(), 1000);
  }

  stop(): void {
    window.clearInterval(this.timer);
  }

  /** The graphics processor has dropped everything it held. */
  graphicsLost(): void {
    this.viewer.notices.stand("graphics", {
      level: "error",
      text: "The graphics driver has dropped the picture.",
      remedy: "Reload the page.",
      button: { label: "reload", run: () => location.reload() },
    });
  }

  private linked(state: LinkState): void {
    const { notices, session, loop } = this.viewer;
    if (state.state === "connecting") loop.begin();
    if (state.state === "open") notices.stand("link", null);
    if (state.state === "lost") {
      const again = `Trying again in ${state.retry < 1 ? "a moment" : `${Math.round(state.retry)} s`}.`;
      const button = { label: "now", run: () => session.transport.reconnect() };
      const remedy = `${again} If it stays away, start bioscope live again.`;
      notices.stand("link", { level: "warning", text: state.reason, remedy, button });
    }
    if (state.state === "refused") {
      const button = { label: "reload", run: () => location.reload() };
      notices.stand("link", { level: "error", text: state.reason, remedy: state.remedy, button });
    }
  }

  private failed(error: Error): void {
    if (++this.unreadable !== UNREADABLE) return;
    this.viewer.notices.tell({
      level: "error",
      text: `A message from the world cannot be read (${error.message}).`,
      remedy: "Reload the page; if it happens again, page and world are of different versions.",
    });
  }

  private look(): void {
    const { session, notices, keeping, loop } = this.viewer;
    if (document.visibilityState !== "visible" || keeping.video) this.silent = 0;
    if (!session.connected || !this.running || ++this.silent < SILENCE) return;
    if (loop.picturesSinceFrame < PICTURES) return;
    notices.stand("silence", {
      level: "warning",
      text: `The world has sent nothing for ${this.silent} s.`,
      remedy: "It may be busy; the window in which it runs says more.",
      button: { label: "connect anew", run: () => session.transport.reconnect() },
    });
  }
}
