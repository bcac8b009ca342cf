//! Several numbers computed at once: one lane each, with the same bits as one after the other.
//!
//! A law is written once, for any width. `widest` runs it with the widest registers that this processor
//! has: eight lanes (AVX-512), four (AVX2) or one (everywhere else). Only operations that IEEE 754
//! rounds exactly are offered, and none is ever fused with another, so a lane holds the same bits
//! whatever the width; how the work is cut into registers is not part of a result.

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
    /// How many.
    const N: usize;
    /// One truth per lane.
    type Mask: Mask;

    /// The same number in all lanes.
    fn splat(value: f64) -> Self;
    /// The first `N` numbers of a slice that has as many.
    fn load(from: &[f64]) -> Self;
    /// Writes the lanes to the first `N` places of a slice that has as many.
    fn store(self, to: &mut [f64]);
    /// Square root.
    fn sqrt(self) -> Self;
    /// The larger number; `other` where one of both is not a number.
    fn max(self, other: Self) -> Self;
    /// The smaller number; `other` where one of both is not a number.
    fn min(self, other: Self) -> Self;
    /// The magnitude of `self` with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
    /// The nearest whole number, halves away from zero.
    fn round(self) -> Self;
    /// Where `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// Where `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `self` where `mask` holds, else `other`.
    fn or_where(self, mask: Self::Mask, other: Self) -> Self;
    /// One row of four per lane, as four columns.
    fn from_rows_of_4<'a>(row: impl Fn(usize) -> &'a [f64; 4]) -> [Self; 4];
    /// The first `N` rows of three, as three columns.
    fn from_rows_of_3(rows: &[[f64; 3]]) -> [Self; 3];
    /// Writes three columns as the first `N` rows of three.
    fn to_rows_of_3(columns: [Self; 3], rows: &mut [[f64; 3]]);
    /// Writes four columns as the first `N` rows of four.
    fn to_rows_of_4(columns: [Self; 4], rows: &mut [[f64; 4]]);
    /// Writes eight columns as the first `N` rows of eight.
    fn to_rows_of_8(columns: [Self; 8], rows: &mut [[f64; 8]]);
}

/// Truths, one per lane.
pub trait Mask: Copy {
    /// Where both hold.
    fn and(self, other: Self) -> Self;
    /// Where it does not hold.
    fn not(self) -> Self;
    /// True if it holds somewhere.
    fn any(self) -> bool;
    /// One bit per lane, the first lane in the lowest.
    fn bits(self) -> u8;
}

/// Work that can be done at any width. `run` must be `#[inline(always)]`, and what it calls too, so
/// that it is compiled anew for each width.
pub trait Kernel {
    /// Does it with registers of `L`.
    fn run<L: Lanes>(self);
}

/// How wide registers may be.
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

/// The widest that may be used.
static LIMIT: AtomicU8 = AtomicU8::new(Width::Eight as u8);

/// From now on nothing wider than `width` is used in this process. For comparisons: bits do not change.
pub fn limit(width: Width) {
    LIMIT.store(width as u8, Ordering::Relaxed);
}

/// What `widest` takes on this processor.
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

/// Runs `kernel` with the widest registers.
#[inline]
pub fn widest(kernel: impl Kernel) {
    run_at(width(), kernel);
}

/// Runs `kernel` with registers of a width that this processor has.
#[inline]
fn run_at(width: Width, kernel: impl Kernel) {
    assert!(has(width), "{width:?} lanes");
    match width {
        #[cfg(target_arch = "x86_64")]
        #[expect(unsafe_code, reason = "code for a processor's extension")]
        // SAFETY: the processor has it.
        Width::Eight => unsafe { avx512::run(kernel) },
        #[cfg(target_arch = "x86_64")]
        #[expect(unsafe_code, reason = "code for a processor's extension")]
        // SAFETY: the processor has it.
        Width::Four => unsafe { avx2::run(kernel) },
        _ => kernel.run::<f64>(),
    }
}

#[cfg(test)]
mod tests;
