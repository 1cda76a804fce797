import type { Retina } from "../messages/types";
import { element } from "../overlays/dom";

type Look = "color" | "depth" | "identity";

/** How each look paints a pixel into four bytes. */
const PAINTERS: Record<
  Look,
  (retina: Retina, index: number, target: Uint8ClampedArray, colors: IdentityColors) => void
> = {
  color: ({ color }, index, target) => {
    for (let k = 0; k < 3; k++) target[4 * index + k] = color[4 * index + k];
  },
  depth: ({ depth }, index, target) => {
    const metres = depth[index];
    const near = Number.isFinite(metres) ? 1 / (1 + metres / 2.5) : 0;
    target[4 * index] = 255 * near;
    target[4 * index + 1] = 30 + 200 * near * near ** 0.2;
    target[4 * index + 2] = Number.isFinite(metres) ? 70 + 120 * (1 - near) : 30;
  },
  identity: ({ identity }, index, target, colors) => {
    const id = identity[index];
    target.set(id === 0 ? [8, 14, 20] : colors.of(id), 4 * index);
  },
};

/** A color for every individual: one hue per species, shades of it for its members (Tu 1996, section 5.6). */
class IdentityColors {
  private readonly hues = new Map<string, number>();
  private readonly colors = new Map<number, [number, number, number]>();

  constructor(private readonly species: (id: number) => string) {}

  of(id: number): [number, number, number] {
    const known = this.colors.get(id);
    if (known) return known;
    const species = this.species(id);
    const hue = this.hues.get(species) ?? (this.hues.size * 0.381966) % 1;
    this.hues.set(species, hue);
    const bright = 1 - 0.6 * ((id * 0.618034) % 1);
    const pure = 1 - 0.5 * ((id * 0.75488) % 1);
    const part = (shift: number) => {
      const wave = Math.abs(((((hue + shift) % 1) + 1) % 1) * 6 - 3) - 1;
      return Math.round(255 * bright * (1 - pure + pure * Math.min(1, Math.max(0, wave))));
    };
    const color: [number, number, number] = [part(0), part(2 / 3), part(1 / 3)];
    this.colors.set(id, color);
    return color;
  }
}

/** What the selected animal sees. */
export class RetinaView {
  readonly element;
  private readonly canvas = element("canvas", { width: 64, height: 64 });
  private readonly note = element("small", { class: "bio-quiet" });
  private readonly buttons = new Map<Look, HTMLButtonElement>();
  private look: Look = "color";
  private retina: Retina | null = null;
  private readonly colors: IdentityColors;

  /** `select` is called with whom is clicked; `species` names that of an individual. */
  constructor(
    private readonly select: (id: number) => void,
    species: (id: number) => string,
  ) {
    this.colors = new IdentityColors(species);
    const tabs = element("div", { class: "bio-tabs" });
    for (const look of Object.keys(PAINTERS) as Look[]) {
      const button = element("button", { textContent: look, onclick: () => this.choose(look) });
      this.buttons.set(look, button);
      tabs.append(button);
    }
    this.canvas.title = "what it sees; click to select what is there";
    this.canvas.onclick = (event) => this.pick(event);
    this.element = element("div", { class: "bio-retina", hidden: true }, this.canvas, tabs, this.note);
    this.choose("color");
  }

  show(retina: Retina | null): void {
    this.retina = retina;
    this.element.hidden = retina === null;
    if (retina) this.paint(retina);
  }

  /** The pixels shown, four bytes each; null if nothing is. */
  pixels(): Uint8ClampedArray | null {
    if (!this.retina) return null;
    const { width, height } = this.canvas;
    return this.canvas.getContext("2d")!.getImageData(0, 0, width, height).data;
  }

  private choose(look: Look): void {
    this.look = look;
    for (const [name, button] of this.buttons) button.classList.toggle("bio-on", name === look);
    if (this.retina) this.paint(this.retina);
  }

  private paint(retina: Retina): void {
    const { width, height } = retina;
    if (this.canvas.width !== width || this.canvas.height !== height)
      Object.assign(this.canvas, { width, height });
    const image = new ImageData(width, height);
    const painter = PAINTERS[this.look];
    for (let i = 0; i < width * height; i++) {
      painter(retina, i, image.data, this.colors);
      image.data[4 * i + 3] = 255;
    }
    this.canvas.getContext("2d")!.putImageData(image, 0, 0);
    const nearest = retina.depth.reduce((least, metres) => Math.min(least, metres), Infinity);
    const degrees = Math.round((retina.field_of_view * 180) / Math.PI);
    const distance = Number.isFinite(nearest) ? `, nearest ${nearest.toFixed(2)} m` : "";
    const eyes = retina.eyes === 2 ? "left and right eye, " : "";
    this.canvas.style.aspectRatio = String(width / height);
    this.note.textContent = `${eyes}${width} × ${height}, ${degrees}°${distance}`;
  }

  private pick(event: MouseEvent): void {
    if (!this.retina) return;
    const box = this.canvas.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * this.retina.width);
    const y = Math.floor(((event.clientY - box.top) / box.height) * this.retina.height);
    const id = this.retina.identity[y * this.retina.width + x];
    if (id) this.select(id);
  }
}
