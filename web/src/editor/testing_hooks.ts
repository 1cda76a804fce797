import type { Editor } from "./editor";
import type { Problem } from "./messages";

/** Read-only view of the page for tests in a browser: `window.bioscopeEditor`. */
export interface EditorHooks {
  readonly text: string;
  readonly problems: Problem[];
  /** Numbers of what is shown; null before the first plant. */
  readonly plant: { steps: number; modules: number; triangles: number; height: number } | null;
  readonly seed: number;
  readonly unsaved: boolean;
  /** Whether the newest plant is still growing. */
  readonly busy: boolean;
  /** Pictures drawn. */
  readonly pictures: number;
}

declare global {
  interface Window {
    bioscopeEditor?: EditorHooks;
  }
}

export function exposeForTests(editor: Editor): void {
  window.bioscopeEditor = {
    get text() {
      return editor.text.text;
    },
    get problems() {
      return editor.problems;
    },
    get plant() {
      if (!editor.grown) return null;
      const { steps, modules, mesh } = editor.grown;
      return { steps, modules, triangles: mesh.triangles.length / 3, height: editor.plant.size.height };
    },
    get seed() {
      return editor.seed;
    },
    get unsaved() {
      return editor.unsaved;
    },
    get busy() {
      return editor.orders.busy;
    },
    get pictures() {
      return editor.plant.pictures;
    },
  };
}
