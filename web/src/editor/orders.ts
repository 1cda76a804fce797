import type { Order } from "./messages";

/** Milliseconds that an order may take before a newer one is sent all the same, which ends it. */
const PATIENCE = 400;

/** Sends orders to grow: one at a time while they are quick, always the newest, none twice. */
export class Orders {
  private number = 0;
  private answered = 0;
  private waiting: Order | null = null;
  private last = "";
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly send: (number: number, order: Order) => void) {}

  /** Whether the newest order is not answered yet. */
  get busy(): boolean {
    return this.waiting !== null || this.answered < this.number;
  }

  ask(order: Order): void {
    const key = JSON.stringify(order);
    if (key === this.last) return;
    this.last = key;
    this.waiting = order;
    if (this.answered === this.number) this.sendWaiting();
    else this.timer ??= setTimeout(() => this.sendWaiting(), PATIENCE);
  }

  /** An answer has come; says whether it is worth showing: the newest so far. */
  take(number: number): boolean {
    if (number <= this.answered) return false;
    this.answered = number;
    if (number === this.number) this.sendWaiting();
    return true;
  }

  /** Nothing sent before will be answered: the connection is new. */
  restart(): void {
    this.answered = this.number;
    this.last = "";
    this.waiting = null;
  }

  private sendWaiting(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    if (!this.waiting) return;
    const order = this.waiting;
    this.waiting = null;
    this.send(++this.number, order);
  }
}
