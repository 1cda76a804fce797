import type { Addition } from "../messages/commands";
import type { Session } from "../messages/session";
import type { Resident } from "../messages/types";
import { element } from "../overlays/dom";
import type { Panel } from "../overlays/panels";
import type { Residents } from "./residents";

type Role = NonNullable<Addition["role"]>;

const ROLES: Record<Role, string> = {
  prey: "schools and flees",
  pacifist: "feeds and courts",
  predator: "hunts",
  generic: "does all of it",
};

/** Leaves of a plant at most. */
const MOST_LEAVES = 100;

/** How many of each there are, and who else could come. */
export class PopulationPanel implements Panel {
  readonly name = "numbers";
  readonly title = "Population";
  readonly body = element("div", { class: "bio-population" });
  private readonly list = element("table", { class: "bio-values" });
  private readonly what = element("select", { ariaLabel: "what comes" });
  private readonly role = element("select", { ariaLabel: "how it lives" });
  private readonly count = numberField(5, 2000, "how many come");
  private readonly leaves = numberField(1, MOST_LEAVES, "leaves of each", {}, 1);
  private readonly foliage = element("label", { class: "bio-row" }, this.leaves, "leaves on each of them");
  private shape = "";

  constructor(
    private readonly session: Session,
    private readonly residents: Residents,
    /** Where newcomers are put: what one looks at. */
    private readonly place: () => [number, number, number],
    /** The selected individual, 0 for none. */
    private readonly selected: () => number,
  ) {
    for (const [role, meaning] of Object.entries(ROLES))
      this.role.append(element("option", { value: role, textContent: meaning }));
    this.what.onchange = () => this.suggest();
    const add = element("button", { textContent: "add", title: "they come where you look" });
    add.onclick = () => this.add();
    const remove = element("button", {
      textContent: "remove the selected animal",
      onclick: () => this.remove(),
    });
    this.body.append(
      this.list,
      element("h4", { textContent: "Newcomers" }),
      element("div", { class: "bio-row" }, this.count, this.what),
      this.foliage,
      element("div", { class: "bio-row" }, this.role, add),
      element("div", { class: "bio-row" }, remove),
    );
    residents.listeners.push(() => this.refresh());
  }

  opened(): void {
    this.refresh();
  }

  private refresh(): void {
    const shape = this.residents.all.map((one) => one.name).join(" ");
    if (shape !== this.shape || this.list.rows.length === 0) this.build(shape);
    for (const one of this.residents.all) {
      const cell = this.list.querySelector<HTMLElement>(`[data-population="${CSS.escape(one.name)}"]`);
      if (cell instanceof HTMLInputElement) {
        if (document.activeElement !== cell) cell.value = String(one.count);
      } else if (cell) cell.textContent = String(one.count);
    }
  }

  private build(shape: string): void {
    this.shape = shape;
    const lasting = (one: Resident) => !one.orders.includes("number");
    const all = [...this.residents.all].sort((a, b) => Number(lasting(a)) - Number(lasting(b)));
    this.list.replaceChildren(...all.map((one) => this.row(one)));
    const { fish, plants } = this.residents.catalog;
    const group = (label: string, kind: string, names: string[]) => {
      const made = element("optgroup", { label });
      for (const name of names)
        made.append(
          element("option", { value: `${kind}:${name}`, textContent: (name || kind).replaceAll("_", " ") }),
        );
      return made;
    };
    const chosen = this.what.value;
    this.what.replaceChildren(
      group("fishes", "fish", fish),
      group("plants", "plants", plants),
      group("others", "plankton", [""]),
    );
    this.what.lastElementChild?.append(element("option", { value: "pillars:", textContent: "pillars" }));
    if (chosen) this.what.value = chosen;
    this.suggest();
  }

  private row(one: Resident): HTMLElement {
    const changeable = one.orders.includes("number");
    const data = { population: one.name };
    const shown = changeable
      ? numberField(one.count, one.most, `how many ${one.name}`, data)
      : element("span", { data });
    if (shown instanceof HTMLInputElement) {
      shown.onchange = () => {
        const count = wanted(shown);
        if (count !== null) this.session.send({ do: "resize", population: one.name, count });
      };
    }
    const title = one.species && one.species !== one.name ? `species: ${one.species}` : one.kind;
    return element(
      "tr",
      {},
      element("th", { textContent: one.name.replaceAll("_", " "), title }),
      element("td", {}, shown),
    );
  }

  /** Proposes how the chosen species lives, or how many leaves it has. */
  private suggest(): void {
    const [kind, species] = this.what.value.split(":");
    const leaves = kind === "plants" ? this.residents.catalog.leaves?.[species] : undefined;
    this.foliage.hidden = leaves === undefined;
    if (leaves !== undefined) this.leaves.value = String(leaves);
    this.role.hidden = kind !== "fish";
    this.role.value = this.residents.catalog.hunters.includes(species) ? "predator" : "prey";
  }

  private add(): void {
    const count = wanted(this.count);
    if (count === null || !this.what.value) return;
    const [kind, species] = this.what.value.split(":") as [Addition["kind"], string];
    const addition: Addition = { change: "add", kind, count, position: this.place() };
    if (species) addition.species = species;
    if (kind === "fish") addition.role = this.role.value as Role;
    if (!this.foliage.hidden) {
      const leaves = wanted(this.leaves);
      if (leaves === null) return;
      addition.leaves = leaves;
    }
    this.session.send({ do: "add", addition });
  }

  private remove(): void {
    const id = this.selected();
    if (id !== 0) this.session.send({ do: "remove", id });
  }
}

/** What is typed, if it is a number that the field takes. */
function wanted(field: HTMLInputElement): number | null {
  const count = Number(field.value);
  const good = field.value !== "" && Number.isInteger(count) && field.checkValidity();
  field.classList.toggle("bio-bad", !good);
  return good ? count : null;
}

function numberField(value: number, max: number, label: string, data: Record<string, string> = {}, min = 0) {
  return element("input", {
    type: "number",
    min: String(min),
    max: String(max),
    value: String(value),
    ariaLabel: label,
    title: `${min} to ${max}`,
    data,
  });
}
