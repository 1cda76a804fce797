import {
  HighlightStyle,
  LanguageSupport,
  StreamLanguage,
  type StreamParser,
  type StringStream,
  syntaxHighlighting,
} from "@codemirror/language";
import { tags } from "@lezer/highlight";

/** Words that begin a statement, before its colon. */
const STATEMENT =
  /^(ring l-?system|lsystem|seed|axiom|derivation ?length|angle|ignore|consider|decomposition|homomorphism|maximum depth|productions?|define|start ?each|start|end ?each|end|context|environment|table|select|modules|order|endlsystem)\b/i;
const CONTROL = /^(if|else|while|for|do|return|int|float|array|produce)\b/;
const NUMBER = /^(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?/;

interface State {
  /** Inside a comment of several lines. */
  comment: boolean;
  /** How many parentheses are open: inside them signs calculate, outside they move the turtle. */
  depth: number;
  /** Behind the colon of a production, before its arrow: a condition. */
  condition: boolean;
  /** Names that the text defines. */
  defined: ReadonlySet<string>;
}

function comment(stream: StringStream, state: State): string {
  state.comment = !stream.skipTo("*/");
  if (state.comment) stream.skipToEnd();
  else stream.match("*/");
  return "comment";
}

/** A line that begins with a number sign. */
function directive(stream: StringStream, state: State): string {
  const definition = stream.match(/^#\s*define\s+(\w+)/, false) as RegExpMatchArray | null;
  stream.match(/^#\s*\w*/);
  if (definition) state.defined = new Set([...state.defined, definition[1]]);
  return "meta";
}

function word(stream: StringStream, state: State): string | null {
  if (stream.match(CONTROL)) return "keyword";
  const found = stream.match(/^[A-Za-z_]\w*/, false) as RegExpMatchArray | null;
  if (!found) return null;
  const [name] = found;
  // Modules of one letter stand side by side; longer names are macros, functions and parameters.
  const known = state.defined.has(name);
  const calculating = state.depth > 0 || state.condition;
  const single = !known && !calculating && /^[A-Z][A-Z_\d(]|^[A-Z]$/.test(name.slice(0, 2));
  for (let letters = single ? 1 : name.length; letters > 0; letters--) stream.next();
  if (known) return "macroName";
  if (!calculating && !/^[a-z]\w/.test(name)) return "typeName";
  return stream.peek() === "(" ? "function" : "variableName";
}

function sign(stream: StringStream, state: State): string {
  if (stream.match("-->") || stream.match(/^-\w>/)) {
    state.condition = false;
    return "definitionOperator";
  }
  const letter = stream.next();
  if (letter === ":" && state.depth === 0) state.condition = true;
  if (letter === "(") state.depth += 1;
  if (letter === ")") state.depth = Math.max(0, state.depth - 1);
  if (letter && "()[]{}".includes(letter)) return "bracket";
  if (letter === "@" && state.depth === 0) {
    stream.match(/^[A-Za-z#][a-z]?/);
    return "atom";
  }
  return state.depth > 0 || state.condition ? "operator" : "atom";
}

function token(stream: StringStream, state: State): string | null {
  if (state.comment) return comment(stream, state);
  if (stream.sol()) {
    stream.eatSpace();
    if (!stream.eol()) [state.depth, state.condition] = [0, false];
    if (stream.peek() === "#") return directive(stream, state);
    if (stream.match(STATEMENT)) {
      stream.match(/^\s*:/);
      return "keyword";
    }
  }
  if (stream.eatSpace()) return null;
  if (stream.match("/*")) return comment(stream, state);
  if (stream.match(/^"[^"]*"?/)) return "string";
  if (stream.match(NUMBER)) return "number";
  return word(stream, state) ?? sign(stream, state);
}

const parser: StreamParser<State> = {
  name: "lsystem",
  startState: () => ({ comment: false, depth: 0, condition: false, defined: new Set() }),
  copyState: (state) => ({ ...state }),
  token,
  tokenTable: { function: tags.function(tags.variableName), definitionOperator: tags.definitionOperator },
  languageData: {
    commentTokens: { block: { open: "/*", close: "*/" } },
    closeBrackets: { brackets: ["(", "["] },
  },
};

const style = HighlightStyle.define([
  { tag: tags.comment, color: "#6f8b96", fontStyle: "italic" },
  { tag: tags.keyword, color: "#7fd4e8" },
  { tag: tags.meta, color: "#cc79a7" },
  { tag: tags.macroName, color: "#e6a86e" },
  { tag: tags.typeName, color: "#9fe0a8", fontWeight: "600" },
  { tag: tags.function(tags.variableName), color: "#8fb4f5" },
  { tag: tags.variableName, color: "#d4e6ec" },
  { tag: tags.number, color: "#f0dc82" },
  { tag: tags.string, color: "#e6a86e" },
  { tag: tags.atom, color: "#9db7c2" },
  { tag: tags.operator, color: "#9db7c2" },
  { tag: tags.bracket, color: "#b9d0d9" },
  { tag: tags.definitionOperator, color: "#e5703a", fontWeight: "600" },
]);

/** The L-system language: its words in color. */
export const lsystem = new LanguageSupport(StreamLanguage.define(parser), syntaxHighlighting(style));
