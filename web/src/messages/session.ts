import type { Command } from "./commands";
import type { LinkState, Listener, Transport } from "./transport";
import type { BatchLayout, Hello, Layout, Message } from "./types";

type Kind = Message["type"];
type Of<K extends Kind> = Extract<Message, { type: K }>;
type Handler = (message: Message, bytes: Uint8Array) => void;

/** The conversation with a world: hands each message to whoever asked for its kind. */
export class Session implements Listener {
  hello: Hello | null = null;
  state: LinkState = { state: "connecting" };
  /** Called when the link changes. */
  linked: (state: LinkState) => void = () => {};
  /** Called when a message cannot be read. */
  failed: (error: Error) => void = () => {};
  private readonly handlers = new Map<Kind, Handler[]>();
  private readonly everything: Handler[] = [];
  private batches = new Map<number, BatchLayout>();

  constructor(readonly transport: Transport) {
    this.on("hello", (hello) => {
      this.hello = hello;
    });
  }

  get connected(): boolean {
    return this.state.state === "open" && this.hello !== null;
  }

  open(): void {
    this.transport.open(this);
  }

  on<K extends Kind>(kind: K, handler: (message: Of<K>, bytes: Uint8Array) => void): void {
    const list = this.handlers.get(kind) ?? [];
    list.push(handler as Handler);
    this.handlers.set(kind, list);
  }

  onAny(handler: Handler): void {
    this.everything.push(handler);
  }

  send(command: Command): void {
    this.transport.send(command);
  }

  message(message: Message, bytes: Uint8Array): void {
    if (message.type === "batch") this.batches.set(message.key, message);
    else if (message.type === "layout") this.gather(message);
    for (const handler of this.everything) handler(message, bytes);
    for (const handler of this.handlers.get(message.type) ?? []) handler(message, bytes);
  }

  /** Puts the batches that a layout means in the place of their keys. */
  private gather(layout: Layout): void {
    const keys = layout.batches as unknown as number[];
    layout.batches = keys.map((key) => {
      const batch = this.batches.get(key);
      if (!batch) throw new Error("a batch of the layout is missing");
      return batch;
    });
    // A recording goes back to earlier layouts; a world sends again what comes back.
    if (this.transport.kind === "recording") return;
    this.batches = new Map(keys.map((key, at) => [key, layout.batches[at]]));
  }

  link(state: LinkState): void {
    this.state = state;
    if (state.state === "connecting") {
      this.hello = null;
      this.batches.clear();
    }
    this.linked(state);
  }

  unreadable(error: Error): void {
    this.failed(error);
  }
}
