import type { ContourMesh, Point } from "./mesh";

/** How near the cursor must be to a node to take it, pixels on the screen. */
const NEAR = 14;

/** Draws picture and mesh, and tells where on the picture the cursor is. */
export class View {
  readonly canvas = document.createElement("canvas");
  private readonly pen = this.canvas.getContext("2d")!;
  private scale = 1;
  private offset: Point = [0, 0];
  /** What was drawn last. */
  private shown = "";

  constructor(private picture: CanvasImageSource & { width: number; height: number }) {
    this.fit();
  }

  /** Shows another picture. */
  show(picture: CanvasImageSource & { width: number; height: number }): void {
    this.picture = picture;
    this.shown = "";
    this.fit();
  }

  /** Shows the whole picture. */
  fit(): void {
    const { width, height } = this.picture;
    const [wide, high] = [window.innerWidth, window.innerHeight];
    this.scale = 0.86 * Math.min(wide / width, high / height);
    this.offset = [0.5 * (wide - this.scale * width), 0.5 * (high - this.scale * height)];
  }

  /** Zooms by a factor about a point of the screen. */
  zoom(factor: number, [x, y]: Point): void {
    const scale = Math.min(Math.max(this.scale * factor, 0.1), 40);
    const ratio = scale / this.scale;
    this.offset = [x + (this.offset[0] - x) * ratio, y + (this.offset[1] - y) * ratio];
    this.scale = scale;
  }

  /** Shifts the picture on the screen. */
  pan([x, y]: Point): void {
    this.offset = [this.offset[0] + x, this.offset[1] + y];
  }

  /** The point of the picture at a point of the screen. */
  onPicture([x, y]: Point): Point {
    return [(x - this.offset[0]) / this.scale, (y - this.offset[1]) / this.scale];
  }

  /** The point of the screen at a point of the picture. */
  onScreen([x, y]: Point): Point {
    return [this.offset[0] + this.scale * x, this.offset[1] + this.scale * y];
  }

  /** The node nearest to a point of the screen, if one is near. */
  nodeAt(mesh: ContourMesh, [x, y]: Point): number | undefined {
    let [nearest, found] = [NEAR, undefined as number | undefined];
    for (let node = 0; node < mesh.rows * mesh.columns; node++) {
      const [nodeX, nodeY] = this.onScreen(mesh.point(node));
      const distance = Math.hypot(nodeX - x, nodeY - y);
      if (distance < nearest) [nearest, found] = [distance, node];
    }
    return found;
  }

  /** Draws everything if anything has changed; one node may be marked as held. */
  draw(mesh: ContourMesh, held: number | undefined): void {
    const { canvas, pen } = this;
    const anchors = [...mesh.anchors.keys()];
    const shown = [
      window.innerWidth,
      window.innerHeight,
      this.scale,
      held,
      anchors,
      this.offset,
      mesh.positions,
    ];
    if (shown.join() === this.shown) return;
    this.shown = shown.join();
    const density = window.devicePixelRatio;
    const [wide, high] = [Math.round(window.innerWidth * density), Math.round(window.innerHeight * density)];
    if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
    pen.setTransform(density, 0, 0, density, 0, 0);
    pen.clearRect(0, 0, wide, high);
    const [left, top] = this.offset;
    pen.drawImage(this.picture, left, top, this.scale * this.picture.width, this.scale * this.picture.height);
    this.drawContours(mesh);
    for (let node = 0; node < mesh.rows * mesh.columns; node++) this.drawNode(mesh, node, node === held);
  }

  private drawContours(mesh: ContourMesh): void {
    const { pen } = this;
    const line = (nodes: number[], isBorder: boolean) => {
      pen.beginPath();
      for (const node of nodes) pen.lineTo(...this.onScreen(mesh.point(node)));
      // Dark under light: seen on any picture.
      for (const [color, width] of [
        ["rgb(4 18 27 / 65%)", isBorder ? 4 : 2.4],
        [isBorder ? "#7fd4e8" : "rgb(235 248 252 / 75%)", isBorder ? 1.8 : 0.9],
      ] as const) {
        [pen.strokeStyle, pen.lineWidth] = [color, width];
        pen.stroke();
      }
    };
    const count = (length: number) => [...Array(length).keys()];
    for (let row = 0; row < mesh.rows; row++) {
      const nodes = count(mesh.columns).map((column) => mesh.node(row, column));
      line(nodes, row === 0 || row === mesh.rows - 1);
    }
    for (let column = 0; column < mesh.columns; column++) {
      const nodes = count(mesh.rows).map((row) => mesh.node(row, column));
      line(nodes, column === 0 || column === mesh.columns - 1);
    }
  }

  private drawNode(mesh: ContourMesh, node: number, isHeld: boolean): void {
    const { pen } = this;
    const anchor = mesh.anchors.get(node);
    if (!(isHeld || anchor || mesh.isBorder(node))) return;
    const [x, y] = this.onScreen(mesh.point(node));
    pen.fillStyle = isHeld ? "#ffffff" : anchor ? "#f2b84b" : "#7fd4e8";
    [pen.strokeStyle, pen.lineWidth] = ["rgb(4 18 27 / 80%)", 1.5];
    pen.beginPath();
    if (anchor) pen.rect(x - 5, y - 5, 10, 10);
    else pen.arc(x, y, isHeld ? 6 : 3.2, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
  }
}
