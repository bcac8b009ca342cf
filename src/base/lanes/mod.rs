//! SIMD lanes: several numbers are computed at once, with the same bits as one at a time.
//!
//! A law is written once, for any width. `widest` runs it with the widest registers of this
//! processor: eight lanes (AVX-512), four (AVX2) or one (everywhere else). The only operations are
//! those that IEEE 754 rounds exactly, and none are fused, so the bits of a lane do not depend on
//! the width.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod one;
mod vector;

use std::{
    ops::{Add, Div, Mul, Neg, Sub},
    sync::atomic::{AtomicU8, Ordering},
};

pub use vector::Vector;

/// `N` numbers, one in each lane.
pub trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Number of lanes.
    const N: usize;
    /// One boolean per lane.
    type Mask: Mask;

    /// The same number in all lanes.
    fn splat(value: f64) -> Self;
    /// Loads the first `N` numbers of a slice.
    fn load(from: &[f64]) -> Self;
    /// Stores the lanes in the first `N` elements of a slice.
    fn store(self, to: &mut [f64]);
    /// Square root.
    fn sqrt(self) -> Self;
    /// The larger number; `other` where either is NaN.
    fn max(self, other: Self) -> Self;
    /// The smaller number; `other` where either is NaN.
    fn min(self, other: Self) -> Self;
    /// The magnitude of `self` with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
    /// The nearest integer; halves are rounded away from zero.
    fn round(self) -> Self;
    /// Where `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// Where `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `self` where `mask` is true, else `other`.
    fn or_where(self, mask: Self::Mask, other: Self) -> Self;
    /// Loads one row of four per lane, as four columns.
    fn from_rows_of_4<'a>(row: impl Fn(usize) -> &'a [f64; 4]) -> [Self; 4];
    /// Loads the first `N` rows of three, as three columns.
    fn from_rows_of_3(rows: &[[f64; 3]]) -> [Self; 3];
    /// Stores three columns as the first `N` rows of three.
    fn to_rows_of_3(columns: [Self; 3], rows: &mut [[f64; 3]]);
    /// Stores four columns as the first `N` rows of four.
    fn to_rows_of_4(columns: [Self; 4], rows: &mut [[f64; 4]]);
    /// Stores eight columns as the first `N` rows of eight.
    fn to_rows_of_8(columns: [Self; 8], rows: &mut [[f64; 8]]);
}

/// One boolean per lane.
pub trait Mask: Copy {
    /// True where both are true.
    fn and(self, other: Self) -> Self;
    /// True where `self` is false.
    fn not(self) -> Self;
    /// True if any lane is true.
    fn any(self) -> bool;
    /// One bit per lane; the first lane is the lowest bit.
    fn bits(self) -> u8;
}

/// A computation that can run at any width. `run` and everything it calls must be
/// `#[inline(always)]`, so that they are compiled for each width.
pub trait Kernel {
    /// Runs with registers of type `L`.
    fn run<L: Lanes>(self);
}

/// Number of lanes of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Width {
    /// One lane.
    One = 1,
    /// Four lanes.
    Four = 4,
    /// Eight lanes.
    Eight = 8,
}

/// The largest width that may be used.
static LIMIT: AtomicU8 = AtomicU8::new(Width::Eight as u8);

/// Limits the width of registers in this process to `width`. Results do not change; this is for comparing
/// speeds.
pub fn limit(width: Width) {
    LIMIT.store(width as u8, Ordering::Relaxed);
}

/// The width that `widest` uses on this processor.
#[inline]
pub fn width() -> Width {
    let limit = LIMIT.load(Ordering::Relaxed);
    let fits = |width: &Width| *width as u8 <= limit && has(*width);
    [Width::Eight, Width::Four].into_iter().find(fits).unwrap_or(Width::One)
}

/// True if this processor has registers of this width.
#[inline]
fn has(width: Width) -> bool {
    match width {
        Width::One => true,
        #[cfg(target_arch = "x86_64")]
        Width::Four => is_x86_feature_detected!("avx2"),
        #[cfg(target_arch = "x86_64")]
        Width::Eight => {
            is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
        }
        #[cfg(not(target_arch = "x86_64"))]
        _ => false,
    }
}

/// Runs `kernel` with the widest registers of this processor.
#[inline]
pub fn widest(kernel: impl Kernel) {
    run_at(width(), kernel);
}

/// Runs `kernel` with registers of `width`, which this processor must have.
#[inline]
fn run_at(width: Width, kernel: impl Kernel) {
    assert!(has(width), "this processor has no registers of width {width:?}");
    match width {
        #[cfg(target_arch = "x86_64")]
        #[expect(unsafe_code, reason = "code compiled for a processor extension")]
        // SAFETY: the processor has the extension.
        Width::Eight => unsafe { avx512::run(kernel) },
        #[cfg(target_arch = "x86_64")]
        #[expect(unsafe_code, reason = "code compiled for a processor extension")]
        // SAFETY: the processor has the extension.
        Width::Four => unsafe { avx2::run(kernel) },
        _ => kernel.run::<f64>(),
    }
}

#[cfg(test)]
mod tests;
