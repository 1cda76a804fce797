/** The contour page: a picture, a mesh that is dragged near an outline and locks to it, texture coordinates out. */

import { Pane } from "tweakpane";
import { download, element } from "../overlays/dom";
import { exampleFish } from "./example";
import { ContourMesh, type Point, STRENGTHS } from "./mesh";
import { contentBox, type Feature, LONGEST_SIDE, pictureOf } from "./picture";
import { Relaxation } from "./relaxation";
import { asText, folds, textureTable } from "./table";
import { View } from "./view";

/** Rows and columns of the control meshes: of half a body and of a fin on back or belly. */
const SIZES: Record<string, [number, number]> = { body: [9, 21], fin: [2, 12] };
/** Least and most time for steps between two pictures, milliseconds. */
const PATIENCE = [10, 250];

const HELP =
  "Open a picture of a fish from the side, or drop it here. Drag the border near the outline, anchor nodes by double " +
  "click where the outline is faint, then let it settle. A node that is dragged meanwhile is pulled by a spring. " +
  "With Shift, dragging moves the whole mesh and the wheel sizes it. Wheel: zoom. Drag beside the mesh: move the " +
  "picture. The fish should look to the left: bio.fish.Form makes a body of the saved coordinates.";

/** What the sliders set. */
const settings = { mesh: "body", feature: "edges" as Feature, range: 12, ...STRENGTHS };

class ContourPage {
  private canvas = exampleFish();
  private name = "example";
  private picture = this.read();
  private mesh = new ContourMesh(...SIZES.body);
  private relaxation: Relaxation | undefined;
  private held: number | undefined;
  private message = "";
  private drawnAt = 0;
  private readonly view = new View(this.canvas);
  private readonly status = element("div", { class: "status", role: "status" });

  constructor() {
    this.startOver();
    const controls = element("div", { class: "controls" });
    document.body.append(this.view.canvas, element("div", { class: "help" }, HELP), this.status, controls);
    this.addControls(new Pane({ container: controls, title: "Contours" }));
    this.listen();
    this.draw();
  }

  private read() {
    const { width, height } = this.canvas;
    return pictureOf(this.canvas.getContext("2d")!.getImageData(0, 0, width, height).data, width, height);
  }

  /** Shows a picture from a file, made smaller if it is large. */
  private async open(file: Blob & { name?: string }): Promise<void> {
    let bitmap: ImageBitmap;
    try {
      bitmap = await createImageBitmap(file);
    } catch {
      this.message = `${file.name ?? "file"}: no picture that this browser reads`;
      return;
    }
    const scale = Math.min(1, LONGEST_SIDE / Math.max(bitmap.width, bitmap.height));
    this.canvas = document.createElement("canvas");
    this.canvas.width = Math.max(2, Math.round(scale * bitmap.width));
    this.canvas.height = Math.max(2, Math.round(scale * bitmap.height));
    this.canvas.getContext("2d")!.drawImage(bitmap, 0, 0, this.canvas.width, this.canvas.height);
    bitmap.close();
    this.picture = this.read();
    this.name = (file.name ?? "picture").replace(/\.[^.]*$/, "");
    this.view.show(this.canvas);
    this.startOver();
  }

  private startOver(): void {
    this.relaxation = this.held = undefined;
    this.message = "";
    this.mesh = new ContourMesh(...SIZES[settings.mesh]);
    this.mesh.strengths = settings;
    this.mesh.lay(contentBox(this.picture), settings.mesh === "body" ? "oval" : "box");
  }

  private settle(): void {
    this.relaxation = new Relaxation(this.picture, settings.feature, settings.range);
  }

  private save(form: "json" | "csv"): void {
    const table = textureTable(this.mesh, this.picture.width, this.picture.height);
    const text = form === "csv" ? asText(table) : JSON.stringify(table);
    download(`${this.name}-${settings.mesh}.${form}`, new Blob([text]));
  }

  private addControls(pane: Pane): void {
    const file = element("input", { type: "file", accept: "image/*" });
    file.addEventListener("change", () => file.files?.[0] && void this.open(file.files[0]));
    const button = (title: string, act: () => void) => pane.addButton({ title }).on("click", act);
    button("Open a picture…", () => file.click());
    pane
      .addBinding(settings, "mesh", { options: { "body, 9 × 21": "body", "fin, 2 × 12": "fin" } })
      .on("change", () => this.startOver());
    const features = Object.fromEntries(["edges", "dark lines", "bright lines"].map((one) => [one, one]));
    const resettle = () => this.relaxation && this.settle();
    pane.addBinding(settings, "feature", { options: features }).on("change", resettle);
    pane.addBinding(settings, "range", { label: "range, px", min: 1.5, max: 30 }).on("change", resettle);
    const forces = pane.addFolder({ title: "Forces", expanded: false });
    for (const [name, max] of [
      ["picture", 12],
      ["tension", 1],
      ["rigidity", 2],
    ] as const) {
      forces.addBinding(settings, name, { min: 0, max }).on("change", () => {
        this.mesh.strengths = settings;
        this.relaxation?.wake();
      });
    }
    button("Settle", () => this.settle());
    button("Pause", () => {
      this.relaxation = undefined;
      this.mesh.release();
    });
    button("Start over", () => this.startOver());
    button("Save coordinates (.json)", () => this.save("json"));
    button("Save coordinates (.csv)", () => this.save("csv"));
    this.listenForFiles(file);
  }

  private listenForFiles(input: HTMLInputElement): void {
    document.body.append(input);
    input.hidden = true;
    window.addEventListener("dragover", (event) => event.preventDefault());
    window.addEventListener("drop", (event) => {
      event.preventDefault();
      const dropped = event.dataTransfer?.files[0];
      if (dropped) void this.open(dropped);
    });
  }

  private listen(): void {
    const { canvas } = this.view;
    const place = (event: MouseEvent): Point => [event.clientX, event.clientY];
    let last: Point | undefined;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.message = "";
      last = place(event);
      this.held = event.shiftKey ? undefined : this.view.nodeAt(this.mesh, last);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (last && event.shiftKey && this.held === undefined) this.moveMesh(last, place(event));
      else if (last) this.drag(last, place(event));
      last &&= place(event);
    });
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, () => {
        last = this.held = undefined;
        this.mesh.release();
        this.relaxation?.wake();
      });
    }
    canvas.addEventListener("dblclick", (event) => this.toggleAnchor(place(event)));
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        // With Shift, browsers turn the wheel sideways.
        const factor = Math.exp(-0.0015 * (event.deltaY || event.deltaX));
        if (event.shiftKey) this.sizeMesh(factor, place(event));
        else this.view.zoom(factor, place(event));
      },
      { passive: false },
    );
    window.addEventListener("resize", () => this.view.fit());
  }

  /** Moves the node that is held, by a spring while the mesh settles, else by hand; without one, the picture. */
  private drag(from: Point, to: Point): void {
    if (this.held === undefined) {
      this.view.pan([to[0] - from[0], to[1] - from[1]]);
      return;
    }
    const [start, end] = [this.view.onPicture(from), this.view.onPicture(to)];
    const anchor = this.mesh.anchors.get(this.held);
    if (anchor) this.mesh.anchor(this.held, end);
    if (this.relaxation) {
      this.mesh.hold(this.held, end);
      this.relaxation.wake();
    } else this.mesh.shift(this.held, [end[0] - start[0], end[1] - start[1]]);
  }

  private moveMesh(from: Point, to: Point): void {
    const [start, end] = [this.view.onPicture(from), this.view.onPicture(to)];
    this.mesh.transform(1, [0, 0], [end[0] - start[0], end[1] - start[1]]);
    this.relaxation?.wake();
  }

  private sizeMesh(factor: number, about: Point): void {
    this.mesh.transform(factor, this.view.onPicture(about), [0, 0]);
    this.relaxation?.wake();
  }

  private toggleAnchor(at: Point): void {
    const node = this.view.nodeAt(this.mesh, at);
    if (node === undefined) return;
    this.mesh.anchor(node, this.mesh.anchors.has(node) ? undefined : this.mesh.point(node));
    this.relaxation?.wake();
  }

  private draw(): void {
    const start = performance.now();
    // Half of the time is for steps, also where drawing is slow.
    const patience = Math.min(Math.max(start - this.drawnAt, PATIENCE[0]), PATIENCE[1]);
    while (this.relaxation && !this.relaxation.done && performance.now() - start < patience) {
      this.relaxation.step(this.mesh);
    }
    this.drawnAt = performance.now();
    this.view.draw(this.mesh, this.held);
    const told = this.told();
    if (told !== this.status.textContent) this.status.textContent = told;
    requestAnimationFrame(() => this.draw());
  }

  /** What the page is doing, in a line. */
  private told(): string {
    if (this.message) return this.message;
    const { mesh, relaxation } = this;
    const counts = `${mesh.rows} × ${mesh.columns} · ${mesh.anchors.size} anchors · ${folds(mesh)} folds`;
    if (!relaxation) return `${counts} · paused`;
    if (relaxation.done) return `${counts} · settled`;
    return `${counts} · settling, range ${relaxation.width.toFixed(1)} px, moving ${relaxation.moved.toFixed(2)} px`;
  }
}

new ContourPage();
