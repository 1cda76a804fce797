import type { SignName } from "./overlays/signs";
import type { Viewer } from "./viewer";

/** Something a person can do with a key or a button. */
export interface Action {
  name: string;
  /** As `KeyboardEvent.key`; letters in lower case. */
  key?: string;
  /** How the key is written in the help. */
  keyLabel?: string;
  /** What it does, for help and tooltips. */
  meaning: string;
  group: "Time" | "Looking" | "Keeping" | "Page";
  sign?: SignName;
  run(viewer: Viewer): void;
}

/** All actions, in the order of the help overlay. */
export const ACTIONS: Action[] = [
  {
    name: "play",
    key: " ",
    keyLabel: "Space",
    meaning: "run or stand still",
    group: "Time",
    sign: "play",
    run: (viewer) => viewer.toggleRunning(),
  },
  {
    name: "step",
    key: "ArrowRight",
    keyLabel: "→",
    meaning: "one step forward",
    group: "Time",
    sign: "step",
    run: (viewer) => viewer.session.send({ do: "step", ticks: 1 }),
  },
  {
    name: "back",
    key: "ArrowLeft",
    keyLabel: "←",
    meaning: "one step back",
    group: "Time",
    sign: "back",
    run: (viewer) => viewer.session.send({ do: "back", ticks: 1 }),
  },
  {
    name: "restart",
    key: "r",
    keyLabel: "R",
    meaning: "restart, with the same seed or another",
    group: "Time",
    sign: "restart",
    run: (viewer) => viewer.askRestart(),
  },
  {
    name: "slower",
    key: "[",
    meaning: "slower",
    group: "Time",
    sign: "slower",
    run: (viewer) => viewer.changeSpeed(-1),
  },
  {
    name: "faster",
    key: "]",
    meaning: "faster",
    group: "Time",
    sign: "faster",
    run: (viewer) => viewer.changeSpeed(1),
  },
  {
    name: "fastest",
    key: "f",
    keyLabel: "F",
    meaning: "as fast as possible, or back to real time",
    group: "Time",
    run: (viewer) => viewer.toggleFastest(),
  },
  {
    name: "next",
    key: "s",
    keyLabel: "S",
    meaning: "select the next animal",
    group: "Looking",
    run: (viewer) => viewer.selection.next(1),
  },
  {
    name: "next species",
    key: "S",
    keyLabel: "Shift S",
    meaning: "select an animal of the next species",
    group: "Looking",
    run: (viewer) => viewer.selection.nextSpecies(),
  },
  {
    name: "camera",
    key: "c",
    keyLabel: "C",
    meaning: "next camera: free, follow, eye, top, the world's own",
    group: "Looking",
    sign: "camera",
    run: (viewer) => viewer.cameras.next(viewer.selection.id),
  },
  {
    name: "annotations",
    key: "a",
    keyLabel: "A",
    meaning: "show what animals sense and decide",
    group: "Looking",
    sign: "annotations",
    run: (viewer) => viewer.toggleAnnotations(),
  },
  {
    name: "screenshot",
    key: "p",
    keyLabel: "P",
    meaning: "save a picture",
    group: "Keeping",
    sign: "screenshot",
    run: (viewer) => viewer.saveScreenshot(),
  },
  {
    name: "video",
    key: "v",
    keyLabel: "V",
    meaning: "record a video, picture by picture; again: stop",
    group: "Keeping",
    sign: "video",
    run: (viewer) => viewer.toggleVideo(),
  },
  {
    name: "share",
    meaning: "copy a link to this moment",
    group: "Keeping",
    sign: "share",
    run: (viewer) => viewer.copyLink(),
  },
  {
    name: "page",
    meaning: "save what was seen lately as a page that plays by itself",
    group: "Keeping",
    sign: "page",
    run: (viewer) => viewer.savePage(),
  },
  {
    name: "snapshot",
    meaning: "save the state of the world",
    group: "Keeping",
    sign: "snapshot",
    run: (viewer) => viewer.session.send({ do: "snapshot" }),
  },
  {
    name: "parameters",
    meaning: "parameters of the world",
    group: "Page",
    sign: "parameters",
    run: (viewer) => viewer.panels.toggle("parameters"),
  },
  {
    name: "populations",
    meaning: "charts of the populations",
    group: "Page",
    sign: "populations",
    run: (viewer) => viewer.panels.toggle("populations"),
  },
  {
    name: "events",
    meaning: "what has happened",
    group: "Page",
    sign: "events",
    run: (viewer) => viewer.panels.toggle("events"),
  },
  {
    name: "help",
    key: "?",
    meaning: "this help",
    group: "Page",
    sign: "help",
    run: (viewer) => viewer.help.toggle(),
  },
  {
    name: "close",
    key: "Escape",
    keyLabel: "Esc",
    meaning: "close what is open, select nothing",
    group: "Page",
    run: (viewer) => viewer.dismiss(),
  },
];

/** The action of a key press; undefined for keys without one and while text is being typed. */
export function actionFor(event: KeyboardEvent): Action | undefined {
  if (event.ctrlKey || event.metaKey || event.altKey) return undefined;
  const target = event.composedPath()[0];
  if (target instanceof HTMLInputElement && !["range", "checkbox", "button"].includes(target.type))
    return undefined;
  if (target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return undefined;
  const exact = ACTIONS.find((action) => action.key === event.key);
  return exact ?? ACTIONS.find((action) => action.key === event.key.toLowerCase());
}

/** The action of this name. */
export function actionNamed(name: string): Action {
  const action = ACTIONS.find((one) => one.name === name);
  if (!action) throw new Error(`no action ${name}`);
  return action;
}
