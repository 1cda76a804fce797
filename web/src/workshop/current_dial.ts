import { element } from "../overlays/dom";

/** Side of the dial, pixels. */
const SIZE = 92;

/** The direction of a current, seen from above: drag the arrow. +X is right, +Z is down, as on the map. */
export class CurrentDial {
  readonly element = element("canvas", {
    class: "bio-dial",
    width: 2 * SIZE,
    height: 2 * SIZE,
    title: "drag to where the current flows",
  });
  private bearing = 0;
  private strength = 1;

  /** `change` is called with degrees from +Z (0) towards +X (90). */
  constructor(private readonly change: (bearing: number) => void) {
    this.element.addEventListener("pointerdown", (event) => {
      this.element.setPointerCapture(event.pointerId);
      this.turn(event);
    });
    this.element.addEventListener("pointermove", (event) => {
      if (event.buttons !== 0) this.turn(event);
    });
  }

  show(bearing: number, strength: number): void {
    [this.bearing, this.strength] = [bearing, strength];
    this.draw();
  }

  private turn(event: PointerEvent): void {
    const box = this.element.getBoundingClientRect();
    const x = event.clientX - box.left - box.width / 2;
    const z = event.clientY - box.top - box.height / 2;
    if (Math.hypot(x, z) < 4) return;
    this.bearing = Math.round((Math.atan2(x, z) * 180) / Math.PI);
    this.draw();
    this.change(this.bearing);
  }

  private draw(): void {
    const context = this.element.getContext("2d");
    if (!context) return;
    const angle = (this.bearing * Math.PI) / 180;
    const [x, z] = [Math.sin(angle), Math.cos(angle)];
    context.setTransform(2, 0, 0, 2, SIZE, SIZE);
    context.clearRect(-SIZE, -SIZE, 2 * SIZE, 2 * SIZE);
    const radius = SIZE / 2 - 6;
    context.lineWidth = 1.5;
    context.strokeStyle = "#ffffff30";
    context.beginPath();
    context.arc(0, 0, radius, 0, 2 * Math.PI);
    context.stroke();
    context.strokeStyle = context.fillStyle = this.strength > 0 ? "#7fd4e8" : "#8fa9b4";
    context.lineWidth = 2.5;
    context.beginPath();
    context.moveTo(-0.7 * radius * x, -0.7 * radius * z);
    context.lineTo(0.6 * radius * x, 0.6 * radius * z);
    context.stroke();
    context.beginPath();
    context.moveTo(0.85 * radius * x, 0.85 * radius * z);
    for (const side of [1, -1]) {
      const [ax, az] = [0.45 * x + side * 0.2 * z, 0.45 * z - side * 0.2 * x];
      context.lineTo(radius * ax, radius * az);
    }
    context.fill();
  }
}
