import { Vector3 } from "three";
import type { Viewer } from "../viewer";
import { BehaviorPanel } from "./behavior_panel";
import { drawingControls } from "./drawing";
import { EyePanel } from "./eye_panel";
import { HabitPanel } from "./habit_panel";
import { LayoutPanel } from "./layout_panel";
import { PhysicsPanel } from "./physics_panel";
import { PopulationPanel } from "./population_panel";
import { Residents } from "./residents";
import { Steering } from "./steering";
import { Subject } from "./subject";

/** Metres ahead of the camera at which newcomers are put. */
const AHEAD = 3;

/** The panels with which a world is changed while it runs (Tu 1996, appendix on the graphical interface). */
export class Workshop {
  readonly residents: Residents;
  readonly subject: Subject;
  readonly steering: Steering;
  readonly behavior: BehaviorPanel;
  readonly view: EyePanel;
  readonly layout: LayoutPanel;

  constructor(private readonly viewer: Viewer) {
    const { session, selection, parameters, stage, panels } = viewer;
    this.residents = new Residents(session);
    this.subject = new Subject(session, parameters);
    this.steering = new Steering(session, () => selection.id);
    this.behavior = new BehaviorPanel(this.subject, this.steering);
    const species = (id: number) => stage.find(id)?.batch.layout.species ?? "";
    this.view = new EyePanel(this.subject, selection, species, drawingControls(viewer));
    this.layout = new LayoutPanel(session, stage, this.residents, {
      selected: () => selection.id,
      select: (id) => selection.select(id),
      say: (text) => viewer.notices.tell({ level: "info", text }),
    });
    panels.add(
      new PopulationPanel(
        session,
        this.residents,
        () => this.ahead(),
        () => selection.id,
      ),
    );
    panels.add(this.layout);
    panels.add(new PhysicsPanel(session, parameters, this.residents));
    panels.add(this.behavior);
    panels.add(new HabitPanel(this.subject));
    panels.add(this.view);
    this.steering.changed = (id) => this.steered(id);
  }

  /** Draws what is new. */
  refresh(): void {
    this.behavior.refresh();
    this.layout.refresh();
  }

  /** Another individual is selected, or none. */
  selected(id: number): void {
    if (this.steering.id !== 0 && this.steering.id !== id) this.steering.end();
    this.subject.forget();
  }

  /** Where one looks, above the ground. */
  private ahead(): [number, number, number] {
    const { position, rotation } = this.viewer.cameras.view;
    const place = new Vector3(0, 0, -AHEAD).applyQuaternion(rotation).add(position);
    const ground = this.viewer.stage.ground.heightAt(place.x, place.z);
    const surface = this.viewer.stage.layout?.medium.surface ?? Infinity;
    place.y = Math.min(Math.max(place.y, ground + 0.3), surface - 0.3);
    return [place.x, place.y, place.z].map((axis) => Number(axis.toFixed(3))) as [number, number, number];
  }

  private steered(id: number): void {
    const { viewer } = this;
    if (id !== 0 && !["follow", "eye"].includes(viewer.cameras.name)) viewer.cameras.use("follow");
    viewer.root.classList.toggle("bio-steering", id !== 0);
    viewer.notices.stand(
      "steering",
      id === 0
        ? null
        : {
            level: "info",
            text: "You are the fish.",
            remedy:
              "A D or ← → turn, R F or ↑ ↓ rise and dive, W faster, S brakes, E bites; or drag on the picture. Esc lets go.",
          },
    );
  }
}
