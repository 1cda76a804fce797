use super::real::{Real, Triple, dot, scale, sub};

/// Where the entries of a sparse symmetric matrix are stored: each column from the diagonal upward to
/// its first row that is not zero (Tu, "Artificial Animals for Computer Animation", section 4.4).
/// Entries are single numbers, or blocks of 3 × 3.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skyline {
    /// First stored row of each column.
    first: Vec<usize>,
    /// Index of each diagonal entry, and at the end the number of entries.
    diagonal: Vec<usize>,
}

impl Skyline {
    /// The skyline of a matrix of this size with these entries beside its diagonal.
    pub fn new(size: usize, pairs: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let mut first: Vec<usize> = (0..size).collect();
        for (a, b) in pairs {
            let (row, column) = (a.min(b), a.max(b));
            first[column] = first[column].min(row);
        }
        let mut diagonal = vec![0];
        for column in 0..size {
            diagonal.push(diagonal[column] + column - first[column] + 1);
        }
        Self { first, diagonal }
    }

    /// Number of columns.
    pub fn size(&self) -> usize {
        self.first.len()
    }

    /// Number of stored entries.
    pub fn stored(&self) -> usize {
        self.diagonal[self.size()]
    }

    /// Greatest distance of a stored entry from the diagonal.
    pub fn half_bandwidth(&self) -> usize {
        (0..self.size()).map(|column| column - self.first[column]).max().unwrap_or(0)
    }

    /// Index of the entry in this row and column, which must be within the skyline.
    #[inline(always)]
    pub fn index(&self, a: usize, b: usize) -> usize {
        let (row, column) = if a < b { (a, b) } else { (b, a) };
        self.diagonal[column] + column - row
    }

    /// Solves A x = b in place for three right-hand sides, A = L D Lᵀ. Returns the smallest pivot:
    /// unless it is positive, A was not positive definite and the solution means nothing.
    #[inline(always)]
    pub fn solve<R: Real>(&self, matrix: &mut [R], right: &mut [Triple<R>]) -> R {
        let mut least = R::splat(f64::from(f32::MAX));
        for column in 0..self.size() {
            let top = self.first[column];
            for row in top + 1..column {
                let mut entry = matrix[self.index(row, column)];
                for above in top.max(self.first[row])..row {
                    entry -= matrix[self.index(above, row)] * matrix[self.index(above, column)];
                }
                matrix[self.index(row, column)] = entry;
            }
            let mut pivot = matrix[self.diagonal[column]];
            for row in top..column {
                let index = self.index(row, column);
                let entry = matrix[index];
                let factor = entry / matrix[self.diagonal[row]];
                pivot -= factor * entry;
                matrix[index] = factor;
                right[column] = sub(right[column], scale(right[row], factor));
            }
            matrix[self.diagonal[column]] = pivot;
            least = least.min(pivot);
        }
        for column in (0..self.size()).rev() {
            // Below the diagonal everything is done: divide, then carry upward.
            let inverse = R::splat(1.0) / matrix[self.diagonal[column]];
            let mut value = scale(right[column], inverse);
            for later in column + 1..self.size() {
                if self.first[later] <= column {
                    let factor = matrix[self.index(column, later)];
                    value = sub(value, scale(right[later], factor));
                }
            }
            right[column] = value;
        }
        least
    }

    /// Solves A x = b in place for a positive definite A of 3 × 3 blocks (row by row; those on the
    /// diagonal are symmetric), A = Uᵀ D U.
    #[inline(always)]
    pub fn solve_blocks<R: Real>(&self, matrix: &mut [Block<R>], right: &mut [Triple<R>]) {
        for column in 0..self.size() {
            let top = self.first[column];
            let base = self.diagonal[column] + column;
            for row in top + 1..column {
                let mut entry = matrix[base - row];
                let row_base = self.diagonal[row] + row;
                for above in top.max(self.first[row])..row {
                    subtract_product(&mut entry, &matrix[row_base - above], &matrix[base - above]);
                }
                matrix[base - row] = entry;
            }
            let mut pivot = matrix[base - column];
            let mut value = right[column];
            for row in top..column {
                let entry = matrix[base - row];
                let factor = symmetric_times(&matrix[self.diagonal[row]], &entry);
                subtract_symmetric_product(&mut pivot, &factor, &entry);
                value = sub(value, transposed_times(&factor, right[row]));
                matrix[base - row] = factor;
            }
            right[column] = value;
            matrix[base - column] = inverse(&pivot);
        }
        for (diagonal, value) in self.diagonal.iter().zip(right.iter_mut()) {
            *value = times(&matrix[*diagonal], *value);
        }
        for column in (0..self.size()).rev() {
            let base = self.diagonal[column] + column;
            let value = right[column];
            for row in self.first[column]..column {
                right[row] = sub(right[row], times(&matrix[base - row], value));
            }
        }
    }
}

/// A matrix of 3 × 3, row by row.
pub type Block<R> = [R; 9];

#[inline(always)]
fn times<R: Real>(a: &Block<R>, v: Triple<R>) -> Triple<R> {
    [dot([a[0], a[1], a[2]], v), dot([a[3], a[4], a[5]], v), dot([a[6], a[7], a[8]], v)]
}

#[inline(always)]
fn transposed_times<R: Real>(a: &Block<R>, v: Triple<R>) -> Triple<R> {
    [dot([a[0], a[3], a[6]], v), dot([a[1], a[4], a[7]], v), dot([a[2], a[5], a[8]], v)]
}

/// `entry` −= aᵀ b.
#[inline(always)]
fn subtract_product<R: Real>(entry: &mut Block<R>, a: &Block<R>, b: &Block<R>) {
    for row in 0..3 {
        for column in 0..3 {
            let product = a[row] * b[column] + a[3 + row] * b[3 + column];
            entry[3 * row + column] -= product + a[6 + row] * b[6 + column];
        }
    }
}

/// `entry` −= aᵀ b, of which the upper half is computed and mirrored.
#[inline(always)]
fn subtract_symmetric_product<R: Real>(entry: &mut Block<R>, a: &Block<R>, b: &Block<R>) {
    for row in 0..3 {
        for column in row..3 {
            let product = a[row] * b[column] + a[3 + row] * b[3 + column];
            let value = entry[3 * row + column] - (product + a[6 + row] * b[6 + column]);
            entry[3 * row + column] = value;
            entry[3 * column + row] = value;
        }
    }
}

#[inline(always)]
fn symmetric_times<R: Real>(a: &Block<R>, b: &Block<R>) -> Block<R> {
    let mut out = *b;
    for column in 0..3 {
        let image = times(a, [b[column], b[3 + column], b[6 + column]]);
        for row in 0..3 {
            out[3 * row + column] = image[row];
        }
    }
    out
}

/// Inverse of a symmetric matrix by its cofactors.
#[inline(always)]
fn inverse<R: Real>(a: &Block<R>) -> Block<R> {
    let xx = a[4] * a[8] - a[5] * a[5];
    let xy = a[2] * a[5] - a[1] * a[8];
    let xz = a[1] * a[5] - a[2] * a[4];
    let yy = a[0] * a[8] - a[2] * a[2];
    let yz = a[1] * a[2] - a[0] * a[5];
    let zz = a[0] * a[4] - a[1] * a[1];
    let scale = R::splat(1.0) / (a[0] * xx + a[1] * xy + a[2] * xz);
    let [xx, xy, xz] = [xx * scale, xy * scale, xz * scale];
    let [yy, yz, zz] = [yy * scale, yz * scale, zz * scale];
    [xx, xy, xz, xy, yy, yz, xz, yz, zz]
}
