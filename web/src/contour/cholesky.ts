/**
 * The Cholesky factor of a symmetric positive definite matrix, row by row. Only its lower half is read, and nothing
 * further than `band` from the diagonal.
 */
export function factor(matrix: Float64Array, size: number, band: number): Float64Array {
  const lower = new Float64Array(size * size);
  for (let row = 0; row < size; row++) {
    const first = Math.max(row - band, 0);
    for (let column = first; column <= row; column++) {
      let sum = matrix[row * size + column];
      for (let at = first; at < column; at++) sum -= lower[row * size + at] * lower[column * size + at];
      if (column < row) lower[row * size + column] = sum / lower[column * size + column];
      else if (sum > 0) lower[row * size + row] = Math.sqrt(sum);
      else throw new RangeError("the matrix is not positive definite");
    }
  }
  return lower;
}

/** Solves in place with a Cholesky factor of this band. */
export function solve(lower: Float64Array, size: number, band: number, values: Float64Array): void {
  for (let row = 0; row < size; row++) {
    let sum = values[row];
    for (let at = Math.max(row - band, 0); at < row; at++) sum -= lower[row * size + at] * values[at];
    values[row] = sum / lower[row * size + row];
  }
  for (let row = size - 1; row >= 0; row--) {
    let sum = values[row];
    const last = Math.min(row + band, size - 1);
    for (let at = row + 1; at <= last; at++) sum -= lower[at * size + row] * values[at];
    values[row] = sum / lower[row * size + row];
  }
}
