import type { Command } from "./commands";
import { decodeMessage, unpack } from "./decode";
import type { Listener, Transport } from "./transport";
import { VERSION } from "./types";

/** Shortest and longest wait between attempts to connect, seconds. */
const FIRST_WAIT = 0.5;
const LONGEST_WAIT = 8;

/** What the world's reasons to close a connection mean for the person. */
export const REFUSALS: Record<number, { reason: string; remedy: string }> = {
  4001: {
    reason: "The world asks for a token.",
    remedy: "Open the address that the command line printed, with ?token=… at its end.",
  },
  4002: {
    reason: "This page is of another version than the world.",
    remedy: "Reload the page; if that does not help, reinstall bioscope so that both are of one version.",
  },
  4003: {
    reason: "The world does not answer pages of this address.",
    remedy: "Open the address that the command line printed.",
  },
};

/** Seconds to wait before attempt number `attempt` (0 for the first after a loss). */
export function backoff(attempt: number): number {
  return Math.min(LONGEST_WAIT, FIRST_WAIT * 2 ** attempt);
}

/** A world behind a WebSocket; connects again by itself whenever the connection is lost. */
export class Socket implements Transport {
  readonly kind = "socket";
  private socket: WebSocket | null = null;
  private listener: Listener | null = null;
  private attempt = 0;
  private timer: number | undefined;
  private closed = false;

  constructor(
    private readonly address: string,
    private readonly token: string | null,
  ) {}

  open(listener: Listener): void {
    this.listener = listener;
    this.closed = false;
    this.connect();
  }

  send(command: Command): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
  }

  reconnect(): void {
    window.clearTimeout(this.timer);
    this.drop();
    if (!this.closed) this.connect();
  }

  close(): void {
    this.closed = true;
    window.clearTimeout(this.timer);
    this.drop();
  }

  private drop(): void {
    const socket = this.socket;
    this.socket = null;
    if (!socket) return;
    socket.onopen = socket.onclose = socket.onmessage = null;
    socket.close();
  }

  private connect(): void {
    this.listener?.link({ state: "connecting" });
    const socket = new WebSocket(this.address);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.send({ do: "join", version: VERSION, ...(this.token ? { token: this.token } : {}) });
      this.listener?.link({ state: "open" });
    };
    socket.onmessage = (event) => this.receive(event.data);
    socket.onclose = (event) => this.lost(event);
  }

  private receive(data: unknown): void {
    if (!(data instanceof ArrayBuffer)) return;
    this.attempt = 0;
    const bytes = new Uint8Array(data);
    try {
      for (const part of unpack(bytes)) {
        const message = decodeMessage(part);
        if (message) this.listener?.message(message, part);
      }
    } catch (error) {
      this.listener?.unreadable(error as Error);
    }
  }

  private lost(event: CloseEvent): void {
    this.socket = null;
    const refusal = REFUSALS[event.code];
    if (refusal) {
      const reason = event.reason || refusal.reason;
      this.listener?.link({ state: "refused", reason, remedy: refusal.remedy });
      return;
    }
    const retry = backoff(this.attempt++);
    const reason = event.reason || "The connection to the world is lost.";
    this.listener?.link({ state: "lost", retry, reason });
    this.timer = window.setTimeout(() => this.connect(), retry * 1000);
  }
}
