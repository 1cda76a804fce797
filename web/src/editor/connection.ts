import { backoff, REFUSALS } from "../messages/socket";
import { VERSION } from "../messages/types";
import { type Answer, decodeAnswer, type Request } from "./messages";

/** What a connection tells. */
export interface Listener {
  answer(answer: Answer): void;
  /** The connection is lost and tried again, or refused for good (with what helps). */
  lost(reason: string, remedy: string | null): void;
}

/** The server behind a WebSocket; connects again by itself. */
export class Connection {
  private socket: WebSocket | null = null;
  private attempt = 0;

  constructor(
    private readonly address: string,
    private readonly token: string | null,
    private readonly listener: Listener,
  ) {}

  get open(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  connect(): void {
    const socket = new WebSocket(this.address);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () =>
      this.send({ do: "join", version: VERSION, ...(this.token ? { token: this.token } : {}) });
    socket.onmessage = (event) => {
      this.attempt = 0;
      this.listener.answer(decodeAnswer(new Uint8Array(event.data as ArrayBuffer)));
    };
    socket.onclose = (event) => this.lost(event);
  }

  send(request: Request): void {
    if (this.open) this.socket?.send(JSON.stringify(request));
  }

  private lost(event: CloseEvent): void {
    this.socket = null;
    const refusal = REFUSALS[event.code];
    if (refusal) {
      this.listener.lost(event.reason || refusal.reason, refusal.remedy);
      return;
    }
    this.listener.lost(event.reason || "The connection to the editor's server is lost.", null);
    window.setTimeout(() => this.connect(), backoff(this.attempt++) * 1000);
  }
}
