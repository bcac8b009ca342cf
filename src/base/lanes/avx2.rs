//! Four lanes: AVX2.
//!
//! Every function here is inlined into `run`, which is compiled for the extension.
#![expect(unsafe_code, reason = "processor intrinsics")]

use std::{
    arch::x86_64::*,
    ops::{Add, Div, Mul, Neg, Sub},
};

use super::{Kernel, Lanes, Mask};

/// Four numbers.
#[derive(Clone, Copy)]
pub(super) struct Four(__m256d);

/// Four booleans: all bits of a lane are set where true.
#[derive(Clone, Copy)]
pub(super) struct FourMask(__m256d);

/// Runs `kernel` with four lanes.
///
/// # Safety
/// The processor must have the extension.
#[target_feature(enable = "avx2")]
pub(super) unsafe fn run(kernel: impl Kernel) {
    kernel.run::<Four>();
}

// SAFETY of everything below: `Four` is private to the parent module, which uses it only in kernels that
// `run` runs, and `run` requires the extension. Loads and stores use slices whose lengths are checked.
macro_rules! operator {
    ($trait:ident, $name:ident, $intrinsic:ident) => {
        impl $trait for Four {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
operator!(Add, add, _mm256_add_pd);
operator!(Sub, sub, _mm256_sub_pd);
operator!(Mul, mul, _mm256_mul_pd);
operator!(Div, div, _mm256_div_pd);

impl Neg for Four {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
    }
}

/// Transposes four rows of four.
#[inline(always)]
unsafe fn transposed([a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
    unsafe {
        let low_ab = _mm256_unpacklo_pd(a, b);
        let high_ab = _mm256_unpackhi_pd(a, b);
        let low_cd = _mm256_unpacklo_pd(c, d);
        let high_cd = _mm256_unpackhi_pd(c, d);
        [
            _mm256_permute2f128_pd::<0x20>(low_ab, low_cd),
            _mm256_permute2f128_pd::<0x20>(high_ab, high_cd),
            _mm256_permute2f128_pd::<0x31>(low_ab, low_cd),
            _mm256_permute2f128_pd::<0x31>(high_ab, high_cd),
        ]
    }
}

impl Lanes for Four {
    const N: usize = 4;
    type Mask = FourMask;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(unsafe { _mm256_set1_pd(value) })
    }

    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let from = &from[..4];
        Self(unsafe { _mm256_loadu_pd(from.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to = &mut to[..4];
        unsafe { _mm256_storeu_pd(to.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm256_max_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(unsafe { _mm256_min_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        unsafe {
            let sign_bit = _mm256_set1_pd(-0.0);
            let magnitude = _mm256_andnot_pd(sign_bit, self.0);
            Self(_mm256_or_pd(magnitude, _mm256_and_pd(sign_bit, sign.0)))
        }
    }

    #[inline(always)]
    fn round(self) -> Self {
        // Just less than a half, so that 0.49999999999999994 stays below one.
        let half = Self::splat(0.5_f64.next_down()).copysign(self);
        const TOWARD_ZERO: i32 = _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC;
        Self(unsafe { _mm256_round_pd::<TOWARD_ZERO>((self + half).0) })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> FourMask {
        FourMask(unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn le(self, other: Self) -> FourMask {
        FourMask(unsafe { _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn or_where(self, mask: FourMask, other: Self) -> Self {
        Self(unsafe { _mm256_blendv_pd(other.0, self.0, mask.0) })
    }

    #[inline(always)]
    fn from_rows_of_4<'a>(row: impl Fn(usize) -> &'a [f64; 4]) -> [Self; 4] {
        unsafe {
            let [a, b, c, d] = transposed([
                _mm256_loadu_pd(row(0).as_ptr()),
                _mm256_loadu_pd(row(1).as_ptr()),
                _mm256_loadu_pd(row(2).as_ptr()),
                _mm256_loadu_pd(row(3).as_ptr()),
            ]);
            [Self(a), Self(b), Self(c), Self(d)]
        }
    }

    #[inline(always)]
    fn from_rows_of_3(rows: &[[f64; 3]]) -> [Self; 3] {
        let flat = rows[..4].as_flattened();
        unsafe {
            // x0 y0 z0 x1, y1 z1 x2 y2, z2 x3 y3 z3
            let a = _mm256_loadu_pd(flat.as_ptr());
            let b = _mm256_loadu_pd(flat[4..].as_ptr());
            let c = _mm256_loadu_pd(flat[8..].as_ptr());
            let ab = _mm256_permute2f128_pd::<0x30>(a, b); // x0 y0 x2 y2
            let ac = _mm256_permute2f128_pd::<0x21>(a, c); // z0 x1 z2 x3
            let bc = _mm256_permute2f128_pd::<0x30>(b, c); // y1 z1 y3 z3
            [
                Self(_mm256_blend_pd::<0b1010>(ab, ac)),
                Self(_mm256_shuffle_pd::<0b0101>(ab, bc)),
                Self(_mm256_blend_pd::<0b1010>(ac, bc)),
            ]
        }
    }

    #[inline(always)]
    fn to_rows_of_3([x, y, z]: [Self; 3], rows: &mut [[f64; 3]]) {
        let flat = rows[..4].as_flattened_mut();
        unsafe {
            let xy = _mm256_unpacklo_pd(x.0, y.0); // x0 y0 x2 y2
            let zx = _mm256_blend_pd::<0b1010>(z.0, x.0); // z0 x1 z2 x3
            let yz = _mm256_unpackhi_pd(y.0, z.0); // y1 z1 y3 z3
            let a = _mm256_permute2f128_pd::<0x20>(xy, zx); // x0 y0 z0 x1
            let b = _mm256_permute2f128_pd::<0x30>(yz, xy); // y1 z1 x2 y2
            let c = _mm256_permute2f128_pd::<0x31>(zx, yz); // z2 x3 y3 z3
            _mm256_storeu_pd(flat.as_mut_ptr(), a);
            _mm256_storeu_pd(flat[4..].as_mut_ptr(), b);
            _mm256_storeu_pd(flat[8..].as_mut_ptr(), c);
        }
    }

    #[inline(always)]
    fn to_rows_of_4([a, b, c, d]: [Self; 4], rows: &mut [[f64; 4]]) {
        let rows = &mut rows[..4];
        unsafe {
            for (row, value) in rows.iter_mut().zip(transposed([a.0, b.0, c.0, d.0])) {
                _mm256_storeu_pd(row.as_mut_ptr(), value);
            }
        }
    }

    #[inline(always)]
    fn to_rows_of_8(columns: [Self; 8], rows: &mut [[f64; 8]]) {
        let rows = &mut rows[..4];
        let [a, b, c, d, e, f, g, h] = columns;
        unsafe {
            let left = transposed([a.0, b.0, c.0, d.0]);
            let right = transposed([e.0, f.0, g.0, h.0]);
            for row in 0..4 {
                _mm256_storeu_pd(rows[row].as_mut_ptr(), left[row]);
                _mm256_storeu_pd(rows[row][4..].as_mut_ptr(), right[row]);
            }
        }
    }
}

impl Mask for FourMask {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(unsafe { _mm256_and_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn not(self) -> Self {
        Self(unsafe {
            let all = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
            _mm256_xor_pd(self.0, all)
        })
    }

    #[inline(always)]
    fn any(self) -> bool {
        (unsafe { _mm256_movemask_pd(self.0) }) != 0
    }

    #[inline(always)]
    fn bits(self) -> u8 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "four bits")]
        let bits = (unsafe { _mm256_movemask_pd(self.0) }) as u8;
        bits
    }
}
