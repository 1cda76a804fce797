import type { Session } from "../messages/session";
import type { Frame } from "../messages/types";
import type { Batch } from "../scene/batch";
import type { Stage } from "../scene/stage";

/** Size of the retina that is asked for. */
const RETINA: [number, number] = [128, 128];

/** How the eyes of the selected one are turned (degrees, to the left and up), and whether each is shown. */
export interface Gaze {
  pan: number;
  tilt: number;
  both: boolean;
}

/** Which individual is selected. */
export class Selection {
  id = 0;
  gaze: Gaze = { pan: 0, tilt: 0, both: false };
  /** Called when another individual is selected. */
  changed: (id: number, species: string) => void = () => {};
  /** Called when the selected individual is no longer in the world. */
  lost: (species: string) => void = () => {};
  private species = "";
  private frame: Frame | null = null;

  constructor(
    private readonly session: Session,
    private readonly stage: Stage,
  ) {
    session.on("frame", (frame) => {
      this.frame = frame;
    });
    session.on("hello", () => {
      if (this.id !== 0) this.tell();
    });
  }

  /** Selects an individual; 0 for none. */
  select(id: number): void {
    if (id === this.id) return;
    this.id = id;
    this.species = this.stage.find(id)?.batch.layout.species ?? "";
    this.tell();
    this.changed(id, this.species);
  }

  /** Selects the next animal of the same species, then of the next. */
  next(step: number): void {
    const all = this.animals().flatMap((batch) => [...batch.layout.ids]);
    if (all.length === 0) return;
    const index = all.indexOf(this.id);
    this.select(all[(index + step + all.length) % all.length]);
  }

  nextSpecies(): void {
    const batches = this.animals();
    const species = [...new Set(batches.map((batch) => batch.layout.species))];
    if (species.length === 0) return;
    const wanted = species[(species.indexOf(this.species) + 1) % species.length];
    this.select(batches.find((batch) => batch.layout.species === wanted)!.layout.ids[0]);
  }

  /** After a change of layout: is the selected one still there? */
  check(): void {
    if (this.id === 0 || this.stage.find(this.id)) return;
    const { species } = this;
    this.select(0);
    this.lost(species);
  }

  /** Batches of what lives and moves about, else of what lives. */
  private animals(): Batch[] {
    const alive = [...this.stage.batches.values()].filter(
      (batch) => batch.layout.alive && batch.layout.count > 0,
    );
    const moving = alive.filter((batch) => this.frame?.moving[batch.layout.name]?.positions);
    return moving.length > 0 ? moving : alive;
  }

  /** Turns the eyes of the selected one, for the picture of what it sees. */
  look(gaze: Partial<Gaze>): void {
    this.gaze = { ...this.gaze, ...gaze };
    this.tell();
  }

  private tell(): void {
    const [width, height] = RETINA;
    const retina: [number, number] = this.gaze.both ? [2 * width, height] : [width, height];
    this.session.send({ do: "select", id: this.id, retina, ...this.gaze });
  }
}
