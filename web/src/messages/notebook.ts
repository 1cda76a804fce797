import type { Command } from "./commands";
import { decodeMessage } from "./decode";
import type { Listener, Transport } from "./transport";
import { VERSION } from "./types";

/** The part of an anywidget model that the page uses. */
export interface WidgetModel {
  on(event: "msg:custom", callback: (content: unknown, buffers: DataView[]) => void): void;
  off(event: "msg:custom", callback: (content: unknown, buffers: DataView[]) => void): void;
  send(content: unknown): void;
  /** Height of the view in pixels. */
  get(name: "height"): number;
}

/** A world in a notebook's kernel: every buffer of a custom message is one message of the stream. */
export class Notebook implements Transport {
  readonly kind = "notebook";
  private listener: Listener | null = null;

  constructor(private readonly model: WidgetModel) {}

  open(listener: Listener): void {
    this.listener = listener;
    this.model.on("msg:custom", this.receive);
    this.reconnect();
  }

  send(command: Command): void {
    this.model.send(command);
  }

  reconnect(): void {
    this.listener?.link({ state: "connecting" });
    this.send({ do: "join", version: VERSION });
    this.listener?.link({ state: "open" });
  }

  close(): void {
    this.model.off("msg:custom", this.receive);
  }

  private readonly receive = (_content: unknown, buffers: DataView[]): void => {
    for (const view of buffers) {
      const bytes = new Uint8Array(view.buffer as ArrayBuffer, view.byteOffset, view.byteLength);
      try {
        const message = decodeMessage(bytes);
        if (message) this.listener?.message(message, bytes);
      } catch (error) {
        this.listener?.unreadable(error as Error);
      }
    }
  };
}
