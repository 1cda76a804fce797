import type { Viewer } from "./viewer";

/** An individual as it stands on the screen. */
export interface OnScreen {
  id: number;
  species: string;
  /** Pixels from the upper left of the picture; null behind the camera. */
  screen: [number, number] | null;
  /** Metres. */
  position: [number, number, number];
}

/** Read-only view of the page for tests in a browser: `window.bioscope`. */
export interface Hooks {
  readonly connected: boolean;
  readonly tick: number;
  readonly time: number;
  readonly running: boolean;
  readonly speed: number | null;
  /** Identity of the selected individual, 0 for none. */
  readonly selected: number;
  /** Pictures drawn. */
  readonly frames: number;
  readonly camera: { name: string; names: string[]; position: number[] };
  readonly quality: number;
  readonly behavior: string | null;
  readonly recorded: { frames: number; bytes: number };
  readonly held: { meshes: number; materials: number; textures: number; batches: number };
  readonly notices: string[];
  /** How many there are of each population. */
  readonly counts: Record<string, number>;
  /** The last point of the chart of drives: seconds, hunger, libido, fear; null without one. */
  readonly drives: number[] | null;
  /** Whom the person steers, 0 for nobody. */
  readonly steered: number;
  /** Present value of a parameter; undefined where there is none. */
  parameter(owner: string, name: string): number | undefined;
  /** A parameter of the selected individual itself. */
  trait(name: string): number | undefined;
  /** A value of the inner life of the selected individual. */
  value(name: string): unknown;
  /** All that is alive. */
  instances(): OnScreen[];
  /** Where an individual is on the map of the layout panel, as shares of its sides; null if it is not on it. */
  onMap(id: number): [number, number] | null;
  /** Pixels of the retina that is shown, four bytes each; null if none is. */
  retinaPixels(): number[] | null;
}

declare global {
  interface Window {
    bioscope?: Hooks;
  }
}

/** Offers the hooks of a viewer; of several in one page, the last. */
export function exposeForTests(viewer: Viewer): void {
  const { session, loop, cameras, stage, selection, inspector, recorder } = viewer;
  window.bioscope = {
    get connected() {
      return session.connected;
    },
    get tick() {
      return loop.frame?.tick ?? -1;
    },
    get time() {
      return loop.frame?.time ?? 0;
    },
    get running() {
      return loop.frame?.running ?? false;
    },
    get speed() {
      return loop.frame?.speed ?? null;
    },
    get selected() {
      return selection.id;
    },
    get frames() {
      return loop.pictures;
    },
    get camera() {
      return { name: cameras.name, names: cameras.names, position: cameras.view.position.toArray() };
    },
    get quality() {
      return loop.governor.level;
    },
    get behavior() {
      return inspector.latest?.behavior ?? null;
    },
    get recorded() {
      return { frames: recorder.length, bytes: recorder.size };
    },
    get held() {
      return { ...stage.assets.count, batches: stage.batches.size };
    },
    get notices() {
      return [...viewer.notices.element.children].map(
        (card) => card.querySelector(".bio-text")?.textContent ?? "",
      );
    },
    get counts() {
      return Object.fromEntries(viewer.workshop.residents.all.map((one) => [one.name, one.count]));
    },
    get drives() {
      return viewer.workshop.behavior.latest;
    },
    get steered() {
      return viewer.workshop.steering.id;
    },
    parameter: (owner, name) =>
      viewer.parameters.owners.find((one) => one.name === owner)?.parameters.find((one) => one.name === name)
        ?.value,
    trait: (name) => inspector.latest?.traits[name],
    value: (name) => inspector.latest?.values[name],
    instances: () => instancesOf(viewer),
    onMap: (id) => viewer.workshop.layout.placeOf(id),
    retinaPixels: () => {
      const open = viewer.panels.isOpen("view");
      const pixels = (open ? viewer.workshop.view.retina : inspector.retina).pixels();
      return pixels ? [...pixels] : null;
    },
  };
}

function instancesOf({ stage, marks, cameras }: Viewer): OnScreen[] {
  return [...stage.batches.values()]
    .filter((batch) => batch.layout.alive)
    .flatMap((batch) =>
      [...batch.layout.ids].map((id, slot) => {
        const [x, y, z] = batch.placeOf(slot);
        const screen = marks.project(cameras.camera, x, y, z);
        return { id, species: batch.layout.species, screen, position: [x, y, z] as [number, number, number] };
      }),
    );
}
