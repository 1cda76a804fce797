import { type PerspectiveCamera, Vector3 } from "three";
import { colorOf } from "../colors";
import type { Annotation } from "../messages/types";
import { element } from "./dom";

/** What is written over the picture: where the selected animal is, and what animals sense and decide. */
export class Marks {
  readonly element = element("canvas", { class: "bio-marks-canvas" });
  /** Whether every animal has its number. */
  labels = false;
  private readonly point = new Vector3();
  private width = 1;
  private height = 1;
  private dirty = false;

  resize(width: number, height: number): void {
    const ratio = Math.min(2, window.devicePixelRatio);
    [this.width, this.height] = [width, height];
    Object.assign(this.element, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    this.element.getContext("2d")?.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  /** Place in the picture, in pixels from the upper left; null behind the camera. */
  project(camera: PerspectiveCamera, x: number, y: number, z: number): [number, number] | null {
    const point = this.point.set(x, y, z).applyMatrix4(camera.matrixWorldInverse);
    if (point.z > -camera.near) return null;
    point.applyMatrix4(camera.projectionMatrix);
    return [(point.x * 0.5 + 0.5) * this.width, (0.5 - point.y * 0.5) * this.height];
  }

  /** Radius in pixels of a ball at a place. */
  private radius(camera: PerspectiveCamera, place: readonly number[], radius: number): number {
    const away = this.point.set(place[0], place[1], place[2]).distanceTo(camera.position);
    return (radius * this.height) / (2 * Math.tan((camera.fov * Math.PI) / 360) * Math.max(0.01, away));
  }

  draw(camera: PerspectiveCamera, selected: Ring | null, annotations: Annotation[] | undefined): void {
    const context = this.element.getContext("2d");
    if (!context) return;
    if (this.dirty) context.clearRect(0, 0, this.width, this.height);
    this.dirty = selected !== null || (annotations?.length ?? 0) > 0;
    for (const annotation of annotations ?? []) this.drawAnnotation(context, camera, annotation);
    if (selected) this.drawRing(context, camera, selected);
  }

  /** Writes numbers at places. */
  drawLabels(camera: PerspectiveCamera, labels: readonly Label[]): void {
    const context = this.element.getContext("2d");
    if (!context) return;
    for (const { id, species, place } of labels) {
      const at = this.project(camera, ...place);
      if (at) this.write(context, String(id), at[0] + 3, at[1] - 3, colorOf(species));
    }
    this.dirty = true;
  }

  private drawRing(context: CanvasRenderingContext2D, camera: PerspectiveCamera, ring: Ring): void {
    const at = this.project(camera, ring.place[0], ring.place[1], ring.place[2]);
    if (!at) return;
    const radius = Math.max(14, this.radius(camera, ring.place, ring.radius) * 1.15);
    if (radius > this.height) return;
    const color = ring.behavior ? colorOf(ring.behavior) : "#ffffff";
    context.lineWidth = 1.5;
    context.strokeStyle = color;
    context.globalAlpha = 0.85;
    for (let quarter = 0; quarter < 4; quarter++) {
      const from = quarter * 0.5 * Math.PI + 0.5;
      context.beginPath();
      context.arc(at[0], at[1], radius, from, from + 0.57);
      context.stroke();
    }
    if (ring.behavior) this.write(context, ring.behavior, at[0] + radius + 8, at[1] + 4, color);
    context.globalAlpha = 1;
  }

  private drawAnnotation(
    context: CanvasRenderingContext2D,
    camera: PerspectiveCamera,
    annotation: Annotation,
  ): void {
    const color = colorOf(annotation.role);
    context.strokeStyle = context.fillStyle = color;
    context.globalAlpha = 0.75;
    context.lineWidth = 1.2;
    const { line, center, radius, position, text } = annotation;
    if (line) this.drawLine(context, camera, line);
    if (center && radius !== undefined) {
      const at = this.project(camera, ...center);
      if (at)
        stroke(context, () => context.arc(at[0], at[1], this.radius(camera, center, radius), 0, 2 * Math.PI));
    }
    if (position && text) {
      const at = this.project(camera, ...position);
      if (at) this.write(context, text, at[0] + 4, at[1] - 4, color);
    }
    context.globalAlpha = 1;
  }

  private drawLine(
    context: CanvasRenderingContext2D,
    camera: PerspectiveCamera,
    line: readonly number[],
  ): void {
    const from = this.project(camera, line[0], line[1], line[2]);
    const to = this.project(camera, line[3], line[4], line[5]);
    if (!from || !to) return;
    stroke(context, () => {
      context.moveTo(...from);
      context.lineTo(...to);
    });
    context.beginPath();
    context.arc(to[0], to[1], 2.2, 0, 2 * Math.PI);
    context.fill();
  }

  private write(context: CanvasRenderingContext2D, text: string, x: number, y: number, color: string): void {
    context.font = "12px system-ui, sans-serif";
    context.lineWidth = 3;
    context.strokeStyle = "#021018b0";
    context.strokeText(text, x, y);
    context.fillStyle = color;
    context.fillText(text, x, y);
  }
}

/** An individual and where it is, metres. */
export interface Label {
  id: number;
  species: string;
  place: [number, number, number];
}

/** The ring round the selected individual. */
export interface Ring {
  place: [number, number, number];
  /** Metres. */
  radius: number;
  behavior: string | null;
}

function stroke(context: CanvasRenderingContext2D, path: () => void): void {
  context.beginPath();
  path();
  context.stroke();
}
