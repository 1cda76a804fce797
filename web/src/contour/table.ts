import type { ContourMesh } from "./mesh";

/** Texture coordinates of a mesh: for each row of nodes, for each node, s from the left and t from the top, 0 to 1. */
export interface TextureTable {
  rows: number;
  columns: number;
  coordinates: [number, number][][];
}

/** The texture coordinates of a mesh over a picture of this size in pixels. */
export function textureTable(mesh: ContourMesh, width: number, height: number): TextureTable {
  const share = (one: number, whole: number) => Math.min(Math.max(one / whole, 0), 1);
  const coordinates = [...Array(mesh.rows).keys()].map((row) =>
    [...Array(mesh.columns).keys()].map((column): [number, number] => {
      const [x, y] = mesh.point(mesh.node(row, column));
      return [share(x, width), share(y, height)];
    }),
  );
  return { rows: mesh.rows, columns: mesh.columns, coordinates };
}

/** The table as comma-separated lines: row, column, s, t. */
export function asText({ coordinates }: TextureTable): string {
  const lines = coordinates.flatMap((row, at) =>
    row.map(([s, t], column) => `${at},${column},${s.toFixed(6)},${t.toFixed(6)}`),
  );
  return `row,column,s,t\n${lines.join("\n")}\n`;
}

/** How many cells of the mesh are turned over or cross themselves: they turn the wrong way at two corners or more. */
export function folds(mesh: ContourMesh): number {
  const turn = (a: number, b: number, c: number): number => {
    const [[ax, ay], [bx, by], [cx, cy]] = [mesh.point(a), mesh.point(b), mesh.point(c)];
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  };
  let count = 0;
  for (let row = 1; row < mesh.rows; row++) {
    for (let column = 1; column < mesh.columns; column++) {
      const [a, b] = [mesh.node(row - 1, column - 1), mesh.node(row - 1, column)];
      const [d, c] = [mesh.node(row, column - 1), mesh.node(row, column)];
      const turns = [turn(a, b, c), turn(b, c, d), turn(c, d, a), turn(d, a, b)];
      if (turns.filter((one) => one <= 0).length > 1) count += 1;
    }
  }
  return count;
}
