/** A drawn fish to try the tool on: a body with bars and an eye, on a plain ground. */
export function exampleFish(): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [640, 420];
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = "#cfe0e6";
  pen.fillRect(0, 0, 640, 420);
  const body = new Path2D(
    "M90 216 C120 120 250 84 340 96 C430 108 480 172 522 184 L522 240 C480 252 430 316 340 326 C250 334 128 306 90 216 Z",
  );
  pen.save();
  pen.clip(body);
  pen.fillStyle = "#ef6f16";
  pen.fillRect(0, 0, 640, 420);
  for (const [at, width] of [
    [190, 52],
    [336, 58],
    [478, 30],
  ]) {
    pen.fillStyle = "#14110f";
    pen.fillRect(at - 6, 0, width + 12, 420);
    pen.fillStyle = "#f6f8f7";
    pen.fillRect(at, 0, width, 420);
  }
  pen.restore();
  for (const [radius, color] of [
    [17, "#d8752c"],
    [9, "#0c0b0a"],
  ] as const) {
    pen.fillStyle = color;
    pen.beginPath();
    pen.arc(152, 188, radius, 0, 2 * Math.PI);
    pen.fill();
  }
  return canvas;
}
