import { element } from "../overlays/dom";
import type { Grown, Problem } from "./messages";

/** Problems that are listed; the rest is counted. */
const MOST = 6;

/** Below the text: what is wrong, or what has grown. */
export class ProblemList {
  readonly element;
  private readonly list = element("ol");
  private readonly status = element("div", { class: "bio-status", role: "status", ariaLive: "polite" });

  constructor(private readonly goTo: (problem: Problem) => void) {
    this.element = element("footer", { class: "bio-problems" }, this.list, this.status);
  }

  show(problems: Problem[]): void {
    const rows = problems.slice(0, MOST).map((problem) => {
      const place = element("span", { class: "bio-place", textContent: `${problem.line}:${problem.column}` });
      const text = [problem.message, problem.help].filter(Boolean).join(" — ");
      return element(
        "li",
        { class: `bio-${problem.severity}` },
        element("button", { onclick: () => this.goTo(problem) }, place, text),
      );
    });
    if (problems.length > MOST) {
      rows.push(element("li", { class: "bio-quiet", textContent: `and ${problems.length - MOST} more` }));
    }
    this.list.replaceChildren(...rows);
  }

  /** Says what has grown, and how large it is in the plant's own metres. */
  tell({ modules, segments, mesh, seconds }: Grown, size: { height: number; breadth: number }): void {
    const facts = [
      `${count(modules)} modules`,
      `${count(segments)} strokes`,
      `${count(mesh.triangles.length / 3)} triangles`,
      mesh.triangles.length > 0
        ? `${length(size.height)} high, ${length(size.breadth)} wide`
        : "nothing is drawn",
      `${seconds < 0.0995 ? (1000 * seconds).toFixed(0) : Number((1000 * seconds).toPrecision(2))} ms`,
    ];
    this.say(facts.join(" · "));
  }

  say(text: string): void {
    this.status.textContent = text;
  }
}

const count = (number: number) => number.toLocaleString("en");

/** Metres in the unit that needs fewest letters. */
function length(metres: number): string {
  if (metres >= 1) return `${Number(metres.toPrecision(3))} m`;
  return metres >= 0.01
    ? `${Number((100 * metres).toPrecision(3))} cm`
    : `${Number((1000 * metres).toPrecision(2))} mm`;
}
