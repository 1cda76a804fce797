import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching } from "@codemirror/language";
import { type Diagnostic, lintGutter, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { EditorState, type Text } from "@codemirror/state";
import {
  drawSelection,
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  keymap,
  lineNumbers,
} from "@codemirror/view";
import { lsystem } from "./language";
import type { Problem } from "./messages";

const theme = EditorView.theme(
  {
    "&": { height: "100%", fontSize: "13px", backgroundColor: "transparent" },
    "&.cm-focused": { outline: "none" },
    ".cm-scroller": {
      fontFamily: 'ui-monospace, "JetBrains Mono", "SF Mono", Menlo, Consolas, monospace',
      lineHeight: "1.6",
    },
    ".cm-content": { caretColor: "#7fd4e8", padding: "10px 0 40px" },
    ".cm-cursor": { borderLeftColor: "#7fd4e8", borderLeftWidth: "2px" },
    ".cm-gutters": { backgroundColor: "transparent", border: "none", color: "#46616d" },
    ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "rgb(255 255 255 / 4%)" },
    ".cm-activeLineGutter": { color: "#8fa9b4" },
    "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": {
      backgroundColor: "rgb(127 212 232 / 22%)",
    },
    ".cm-selectionMatch": { backgroundColor: "rgb(127 212 232 / 12%)" },
    "&.cm-focused .cm-matchingBracket": { backgroundColor: "rgb(127 212 232 / 25%)" },
    ".cm-tooltip, .cm-panels": {
      backgroundColor: "#0a1f2b",
      border: "1px solid rgb(180 220 235 / 18%)",
      color: "#d4e6ec",
    },
    ".cm-diagnostic": { padding: "4px 10px", whiteSpace: "pre-wrap", maxWidth: "480px" },
    ".cm-diagnostic-error": { borderLeftColor: "#e5703a" },
    ".cm-diagnostic-warning": { borderLeftColor: "#e69f00" },
  },
  { dark: true },
);

/** The text, with its problems in place. */
export class TextPane {
  readonly element = document.createElement("div");
  private readonly view: EditorView;
  /** Not to be told as a change by the person's hand. */
  private quiet = false;

  /** `changed` is called after each change by hand. */
  constructor(changed: () => void) {
    this.element.className = "bio-text";
    this.view = new EditorView({
      parent: this.element,
      state: EditorState.create({
        extensions: [
          lineNumbers(),
          lintGutter(),
          history(),
          drawSelection(),
          bracketMatching(),
          highlightActiveLine(),
          highlightActiveLineGutter(),
          highlightSelectionMatches(),
          keymap.of([...defaultKeymap, ...historyKeymap, ...searchKeymap, indentWithTab]),
          lsystem,
          theme,
          EditorView.contentAttributes.of({ "aria-label": "text of the L-system" }),
          EditorView.updateListener.of((update) => {
            if (update.docChanged && !this.quiet) changed();
          }),
        ],
      }),
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /** Takes another text, as one step that can be undone. */
  set text(text: string) {
    this.quiet = true;
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text } });
    this.quiet = false;
  }

  /** Replaces some letters, as a change by hand. */
  replace(from: number, to: number, insert: string): void {
    this.view.dispatch({ changes: { from, to, insert } });
  }

  /** Marks what is wrong where. */
  mark(problems: Problem[]): void {
    const { doc } = this.view.state;
    const marks = problems.map((problem): Diagnostic => {
      const [from, to] = stretch(doc, problem);
      const message = problem.help ? `${problem.message}\n${problem.help}` : problem.message;
      return { from, to, severity: problem.severity, message };
    });
    this.view.dispatch(setDiagnostics(this.view.state, marks));
  }

  /** Puts the cursor where a problem is. */
  goTo(problem: Problem): void {
    const [from] = stretch(this.view.state.doc, problem);
    this.view.dispatch({ selection: { anchor: from }, scrollIntoView: true });
    this.view.focus();
  }
}

/** The letters that a problem means. The server counts characters, the text half-words of sixteen bits. */
function stretch(doc: Text, problem: Problem): [number, number] {
  const line = doc.line(Math.min(Math.max(1, problem.line), doc.lines));
  const characters = [...line.text];
  const units = (count: number) => characters.slice(0, count).join("").length;
  const start = line.from + units(problem.column - 1);
  if (problem.width === 0) return [line.from + line.text.search(/\S|$/), line.to];
  return [start, Math.min(line.to, line.from + units(problem.column - 1 + problem.width))];
}
