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
  group: "Time" | "Looking" | "Changing" | "Keeping" | "Page";
  sign?: SignName;
  run(viewer: Viewer): void;
}

/** Opens or closes a panel of the dock. */
function panelAction(name: PanelName, key: string, meaning: string): Action {
  return { name, key, meaning, group: "Changing", sign: name, run: (viewer) => viewer.panels.toggle(name) };
}

type PanelName = "numbers" | "layout" | "physics" | "behavior" | "habits" | "view";

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
    name: "become",
    key: "b",
    keyLabel: "B",
    meaning: "become the selected fish: steer it yourself; again: let go",
    group: "Changing",
    run: (viewer) => viewer.workshop.steering.toggle(),
  },
  panelAction("numbers", "1", "how many there are of each; newcomers"),
  panelAction("layout", "2", "a map on which things are dragged; scripts"),
  panelAction("physics", "3", "bodies, water, current, time step"),
  panelAction("behavior", "4", "drives, intention and temper of a fish"),
  panelAction("habits", "5", "habits and sex of a fish"),
  panelAction("view", "6", "what a fish sees; labels, views"),
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
  if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event)) return undefined;
  const target = event.composedPath()[0];
  const slides = target instanceof HTMLInputElement && target.type === "range";
  if (slides && event.key.startsWith("Arrow")) return undefined;
  const exact = ACTIONS.find((action) => action.key === event.key);
  return exact ?? ACTIONS.find((action) => action.key === event.key.toLowerCase());
}

/** Whether a key goes into a field of text. */
export function isTyping(event: KeyboardEvent): boolean {
  const target = event.composedPath()[0];
  if (target instanceof HTMLInputElement) return !["range", "checkbox", "button"].includes(target.type);
  return target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement;
}

/** The action of this name. */
export function actionNamed(name: string): Action {
  const action = ACTIONS.find((one) => one.name === name);
  if (!action) throw new Error(`no action ${name}`);
  return action;
}
