/** The last so many numbers of several series that grow together; memory is taken once. */
export class Ring {
  private readonly data: Float64Array;
  private start = 0;
  /** Rows held now. */
  length = 0;

  constructor(
    readonly capacity: number,
    readonly columns: number,
  ) {
    this.data = new Float64Array(capacity * columns);
  }

  /** Adds a row; the oldest gives way when all places are taken. */
  push(row: readonly number[]): void {
    const at = (this.start + this.length) % this.capacity;
    for (let column = 0; column < this.columns; column++) {
      this.data[at * this.columns + column] = row[column] ?? Number.NaN;
    }
    if (this.length < this.capacity) this.length += 1;
    else this.start = (this.start + 1) % this.capacity;
  }

  /** One series, oldest first. */
  column(number: number): number[] {
    const values: number[] = [];
    for (let row = 0; row < this.length; row++) {
      values.push(this.data[((this.start + row) % this.capacity) * this.columns + number]);
    }
    return values;
  }

  /** Newest value of one series; NaN if there is none. */
  last(number: number): number {
    if (this.length === 0) return Number.NaN;
    return this.data[((this.start + this.length - 1) % this.capacity) * this.columns + number];
  }

  clear(): void {
    this.start = this.length = 0;
  }
}
