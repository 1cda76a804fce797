import type { Command } from "./commands";
import type { Message } from "./types";

/** Where a transport stands. `retry` is the number of seconds until the next attempt. */
export type LinkState =
  | { state: "connecting" }
  | { state: "open" }
  | { state: "lost"; retry: number; reason: string }
  | { state: "refused"; reason: string; remedy: string };

/** Who listens to a transport. */
export interface Listener {
  /** A message has come; `bytes` is what it was decoded from. */
  message(message: Message, bytes: Uint8Array): void;
  /** The link has changed. */
  link(state: LinkState): void;
  /** A message could not be read. */
  unreadable(error: Error): void;
}

/** What the page does not know of how it is connected to a world: socket, notebook or recording. */
export interface Transport {
  /** How it is called in messages to the person. */
  readonly kind: "socket" | "notebook" | "recording";
  open(listener: Listener): void;
  send(command: Command): void;
  /** Gives up now and connects anew; does nothing where that has no meaning. */
  reconnect(): void;
  close(): void;
}
