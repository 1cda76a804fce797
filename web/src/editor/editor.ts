import type { WebGLRenderer } from "three";
import { VERSION } from "../messages/types";
import { download, element, sign } from "../overlays/dom";
import { Notices } from "../overlays/notices";
import { SIGNS, type SignName } from "../overlays/signs";
import { Connection } from "./connection";
import { ALONE, ControlsCard } from "./controls_card";
import { GrowthBar } from "./growth_bar";
import { formatModelHash, parseModelHash } from "./link";
import type { Answer, Failed, Grown, Hello, Order, Problem } from "./messages";
import { Orders } from "./orders";
import { parameters } from "./parameters";
import { PlantView } from "./plant_view";
import { ProblemList } from "./problem_list";
import { Splitter } from "./splitter";
import { StringSheet } from "./string_sheet";
import { TextPane } from "./text_pane";

/** Milliseconds without a key after which the plant of a new text is asked for. */
const PAUSE = 180;
/** Milliseconds after which a plant that is still growing is said to be. */
const SLOW = 500;

/** A text and its plant, side by side. */
export class Editor {
  readonly root = element("div", { class: "bioscope bio-editor" });
  readonly text = new TextPane(() => this.edited());
  readonly growth = new GrowthBar(() => this.order());
  readonly notices = new Notices();
  readonly plant: PlantView;
  readonly orders: Orders;
  readonly connection: Connection;
  /** What is wrong with the text. */
  problems: Problem[] = [];
  /** The plant that is shown. */
  grown: Grown | null = null;
  private readonly controls = new ControlsCard(
    (parameter, value) => this.text.replace(parameter.from, parameter.to, value),
    () => this.order(),
  );
  private readonly string = new StringSheet(() => this.stringWanted());
  private readonly list = new ProblemList((problem) => this.text.goTo(problem));
  private readonly buttons = new Map<string, HTMLButtonElement>();
  private readonly title = element("h1");
  private hello: Hello | null = null;
  private saved = "";
  private waiting: number | undefined;
  private slow: number | undefined;

  constructor(renderer: WebGLRenderer, address: string, token: string | null) {
    this.plant = new PlantView(renderer);
    this.connection = new Connection(address, token, {
      answer: (answer) => this.take(answer),
      lost: (reason, remedy) => this.lost(reason, remedy),
    });
    this.orders = new Orders((number, order) => this.connection.send({ do: "grow", number, ...order }));
    this.assemble();
    window.addEventListener("keydown", (event) => this.press(event), { capture: true });
    window.addEventListener("hashchange", () => void this.openLink());
    window.addEventListener("beforeunload", (event) => {
      if (this.unsaved) event.preventDefault();
    });
    this.connection.connect();
  }

  /** Whether the text differs from the file's. */
  get unsaved(): boolean {
    return this.hello !== null && this.text.text !== this.saved;
  }

  get seed(): number {
    return this.controls.choices.seed;
  }

  private assemble(): void {
    const bar = element(
      "header",
      { class: "bio-head" },
      this.title,
      this.button("save", "snapshot", "save to the file (Ctrl-S)", () => this.save()),
      this.button("download", "page", "download the text", () => this.download()),
      this.button("share", "share", "copy a link that holds this text", () => void this.share()),
    );
    const left = element("div", { class: "bio-left" }, bar, this.text.element, this.list.element);
    const foot = element(
      "div",
      { class: "bio-foot" },
      this.growth.element,
      this.button("string", "events", "show the string", () => this.string.toggle()),
      this.button("frame", "camera", "look at the whole plant (F)", () => this.plant.frame()),
    );
    const right = element(
      "div",
      { class: "bio-stage" },
      this.plant.element,
      this.controls.element,
      this.string.element,
      foot,
      this.notices.element,
    );
    this.root.append(left, new Splitter(this.root).element, right);
  }

  private button(name: string, picture: SignName, title: string, run: () => void): HTMLButtonElement {
    const button = element("button", { title, ariaLabel: title, data: { action: name }, onclick: run });
    button.append(sign(SIGNS[picture]));
    this.buttons.set(name, button);
    return button;
  }

  private press(event: KeyboardEvent): void {
    const command = event.ctrlKey || event.metaKey;
    const typing = event.target instanceof HTMLElement && event.target.closest(".bio-text, input");
    if (command && event.key === "s") this.save();
    else if (command && event.key === "Enter") this.growth.toggle();
    else if (!command && !typing && event.key === "f") this.plant.frame();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  // What the server says.

  private take(answer: Answer): void {
    if (answer.type === "hello") void this.begin(answer);
    else if (answer.type === "grown") this.show(answer);
    else if (answer.type === "failed") this.fail(answer);
    else if (answer.type === "notice") this.notices.tell(answer);
    else {
      this.saved = answer.text;
      this.refreshTitle();
      this.notices.tell({ level: "info", text: "Saved." });
    }
  }

  /** The first message of each connection; what has been typed before stays. */
  private async begin(hello: Hello): Promise<void> {
    this.notices.stand("link", null);
    const first = this.hello === null;
    const kept = !first && this.unsaved;
    this.hello = hello;
    this.saved = hello.text;
    if (first) this.controls.offer(hello.environments);
    if (!kept) this.text.text = hello.text;
    this.orders.restart();
    if (first) await this.openLink();
    this.edited();
    this.order();
  }

  private lost(reason: string, remedy: string | null): void {
    this.notices.stand("link", { level: "error", text: reason, remedy: remedy ?? "Trying again." });
  }

  private show(grown: Grown): void {
    if (!this.orders.take(grown.number)) return;
    this.grown = grown;
    this.growth.setLength(grown.length);
    this.plant.show(grown.mesh, grown.steps >= grown.length);
    if (!this.string.element.hidden) this.string.show(grown);
    this.root.classList.remove("bio-failed");
    this.list.tell(grown, this.plant.size);
    this.judge(grown.problems);
    this.growth.shown();
  }

  private fail(failed: Failed): void {
    if (!this.orders.take(failed.number)) return;
    this.growth.stop();
    this.root.classList.add("bio-failed");
    this.list.say(this.grown ? "The plant is the last one that could be grown." : "Nothing has grown yet.");
    this.judge(failed.problems);
    if (!this.grown && failed.too_large) this.growLess(failed.problems[0]);
  }

  /** A first plant that gets out of hand is shown younger. */
  private growLess(problem: Problem): void {
    this.growth.guessLength(this.text.text);
    const step = this.growth.halve();
    if (step === 0) return;
    this.notices.tell({ level: "warning", text: `${problem.message}.`, remedy: `Trying step ${step}.` });
    this.order();
  }

  private judge(problems: Problem[]): void {
    window.clearTimeout(this.slow);
    this.problems = problems;
    this.text.mark(problems);
    this.list.show(problems);
  }

  // What the person does.

  private edited(): void {
    this.refreshTitle();
    this.controls.show(parameters(this.text.text));
    window.clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => this.order(), PAUSE);
  }

  /** Asks for the plant as everything says now. */
  private order(): void {
    if (!this.hello || !this.connection.open) return;
    window.clearTimeout(this.waiting);
    const { environment, seed } = this.controls.choices;
    const order: Order = {
      text: this.text.text,
      steps: this.growth.step,
      seed,
      homomorphism: this.string.homomorphism,
      environment: environment === ALONE ? null : environment,
    };
    this.orders.ask(order);
    window.clearTimeout(this.slow);
    this.slow = window.setTimeout(() => {
      if (this.orders.busy) this.list.say("growing …");
    }, SLOW);
  }

  private stringWanted(): void {
    this.buttons.get("string")?.classList.toggle("bio-on", !this.string.element.hidden);
    if (this.grown) this.string.show(this.grown);
    this.order();
  }

  private save(): void {
    if (!this.hello) return;
    if (this.hello.savable) this.connection.send({ do: "save", text: this.text.text });
    else this.download();
  }

  private download(): void {
    download(this.hello?.file ?? "plant.l", new Blob([this.text.text], { type: "text/plain" }));
  }

  private async share(): Promise<void> {
    const { seed, growth } = this;
    const address = new URL(location.href);
    address.search = "";
    address.hash = await formatModelHash({ text: this.text.text, seed, steps: growth.step });
    try {
      await navigator.clipboard.writeText(address.href);
      this.notices.tell({ level: "info", text: "Link to this text copied." });
    } catch {
      this.notices.tell({
        level: "info",
        text: "The link is in the address bar.",
        remedy: "Copy it from there.",
      });
    }
    history.replaceState(null, "", address.hash);
  }

  /** Takes over the text that the address holds, if it does. */
  private async openLink(): Promise<void> {
    if (!location.hash.includes("model=")) return;
    const shared = await parseModelHash(location.hash);
    if (!shared) {
      this.notices.tell({ level: "warning", text: "The link is broken: it holds no text." });
      return;
    }
    if (shared.text !== this.text.text) {
      this.text.text = shared.text;
      const file = this.hello?.savable ? ` ${this.hello.file} stays as it is until you save.` : "";
      this.notices.tell({ level: "info", text: `This text is from the link.${file}` });
    }
    this.growth.step = shared.steps;
    this.controls.setSeed(shared.seed);
    this.edited();
  }

  private refreshTitle(): void {
    const { hello, unsaved } = this;
    if (!hello) return;
    this.title.textContent = hello.file;
    this.title.dataset.unsaved = String(unsaved && hello.savable);
    this.title.title = unsaved && hello.savable ? "not saved" : "";
    document.title = `${unsaved && hello.savable ? "• " : ""}${hello.file} · Bioscope ${VERSION}`;
    const save = this.buttons.get("save");
    if (save) save.hidden = !hello.savable;
  }
}
