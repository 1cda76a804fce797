import type { Session } from "../messages/session";
import type { Catalog, OrderName, Resident } from "../messages/types";

/** Who lives in the world and what they can be told, as the world says it. */
export class Residents {
  all: Resident[] = [];
  catalog: Catalog = { fish: [], hunters: [], plants: [] };
  /** Ticks from one picture to the next; null for as many pictures as can be. */
  stride: number | null = null;
  /** Called when others live there, or other numbers of them. */
  readonly listeners: (() => void)[] = [];

  constructor(session: Session) {
    session.on("hello", ({ catalog }) => {
      if (catalog) this.catalog = catalog;
    });
    session.on("populations", ({ populations, stride }) => {
      this.all = populations;
      this.stride = stride;
      this.tell();
    });
    session.on("statistics", ({ values }) => {
      let changed = false;
      for (const one of this.all) {
        const count = values[`${one.name}.count`] ?? one.count;
        changed ||= count !== one.count;
        one.count = count;
      }
      if (changed) this.tell();
    });
  }

  named(name: string): Resident | undefined {
    return this.all.find((one) => one.name === name);
  }

  /** Whether individuals of this species can be told this. */
  can(species: string, order: OrderName): boolean {
    return this.all.some((one) => one.species === species && one.orders.includes(order));
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
