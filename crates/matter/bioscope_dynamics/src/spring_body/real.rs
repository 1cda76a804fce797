use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// The number a body is computed in: `f64` or `f32` for one body alone, [`Lanes`] for eight bodies at once, each with the
/// bits that it has in `f32` alone.
pub trait Real:
    Copy
    + Default
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// How many bodies one number speaks for.
    const LANES: usize;
    /// The same value for all bodies.
    fn splat(value: f64) -> Self;
    /// The value of one body.
    fn lane(self, lane: usize) -> f64;
    /// Changes the value of one body.
    fn set_lane(&mut self, lane: usize, value: f64);
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// The greater of two.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// The smaller of two.
    #[must_use]
    fn min(self, other: Self) -> Self;
}

macro_rules! alone {
    ($($number:ident),*) => {$(
        impl Real for $number {
            const LANES: usize = 1;
            #[inline(always)]
            fn splat(value: f64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn lane(self, _lane: usize) -> f64 {
                self.into()
            }
            #[inline(always)]
            fn set_lane(&mut self, _lane: usize, value: f64) {
                *self = value as Self;
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
        }
    )*};
}

alone!(f32, f64);

/// One `f32` for each of eight bodies, which are computed side by side. Every operation is a single
/// correctly rounded one per lane, so a body's motion does not depend on its lane or its companions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Lanes(pub [f32; 8]);

macro_rules! lanewise {
    ($($trait:ident $method:ident $operator:tt),*) => {$(
        impl $trait for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for lane in 0..8 {
                    self.0[lane] $operator other.0[lane];
                }
                self
            }
        }
    )*};
}

lanewise!(Add add +=, Sub sub -=, Mul mul *=, Div div /=);

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for lane in 0..8 {
            self.0[lane] = -self.0[lane];
        }
        self
    }
}

impl Real for Lanes {
    const LANES: usize = 8;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value as f32; 8])
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        f64::from(self.0[lane])
    }
    #[inline(always)]
    fn set_lane(&mut self, lane: usize, value: f64) {
        self.0[lane] = value as f32;
    }
    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for lane in 0..8 {
            self.0[lane] = self.0[lane].sqrt();
        }
        self
    }
    #[inline(always)]
    fn max(mut self, other: Self) -> Self {
        for lane in 0..8 {
            self.0[lane] = if self.0[lane] > other.0[lane] { self.0[lane] } else { other.0[lane] };
        }
        self
    }
    #[inline(always)]
    fn min(mut self, other: Self) -> Self {
        for lane in 0..8 {
            self.0[lane] = if self.0[lane] < other.0[lane] { self.0[lane] } else { other.0[lane] };
        }
        self
    }
}

/// A vector of three.
pub type Triple<R> = [R; 3];

#[inline(always)]
pub(super) fn add<R: Real>(a: Triple<R>, b: Triple<R>) -> Triple<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn sub<R: Real>(a: Triple<R>, b: Triple<R>) -> Triple<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn scale<R: Real>(a: Triple<R>, by: R) -> Triple<R> {
    [a[0] * by, a[1] * by, a[2] * by]
}

#[inline(always)]
pub(super) fn dot<R: Real>(a: Triple<R>, b: Triple<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross<R: Real>(a: Triple<R>, b: Triple<R>) -> Triple<R> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
