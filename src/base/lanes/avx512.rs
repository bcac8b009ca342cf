//! Eight lanes: AVX-512 (F, DQ and VL).
//!
//! Every function here is inlined into `run`, which is compiled for the extension.
#![expect(unsafe_code, reason = "processor intrinsics")]

use std::{
    arch::x86_64::*,
    ops::{Add, Div, Mul, Neg, Sub},
};

use super::{Kernel, Lanes, Mask};

/// Eight numbers.
#[derive(Clone, Copy)]
pub(super) struct Eight(__m512d);

/// Runs `kernel` with eight lanes.
///
/// # Safety
/// The processor must have the extension.
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2")]
pub(super) unsafe fn run(kernel: impl Kernel) {
    kernel.run::<Eight>();
}

// SAFETY of everything below: `Eight` is private to the parent module, which uses it only in kernels that
// `run` runs, and `run` requires the extension. Loads and stores use slices whose lengths are checked.
macro_rules! operator {
    ($trait:ident, $name:ident, $intrinsic:ident) => {
        impl $trait for Eight {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
operator!(Add, add, _mm512_add_pd);
operator!(Sub, sub, _mm512_sub_pd);
operator!(Mul, mul, _mm512_mul_pd);
operator!(Div, div, _mm512_div_pd);

impl Neg for Eight {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(unsafe { _mm512_xor_pd(self.0, _mm512_set1_pd(-0.0)) })
    }
}

/// Two rows of four.
#[inline(always)]
unsafe fn halves(low: &[f64; 4], high: &[f64; 4]) -> __m512d {
    unsafe {
        let low = _mm512_castpd256_pd512(_mm256_loadu_pd(low.as_ptr()));
        _mm512_insertf64x4::<1>(low, _mm256_loadu_pd(high.as_ptr()))
    }
}

/// Transposes eight rows of four, given as four registers with rows `k` and `k + 4`, into columns.
#[inline(always)]
unsafe fn columns_of_4(rows: [__m512d; 4]) -> [Eight; 4] {
    let [a, b, c, d] = rows;
    unsafe {
        let low_ab = _mm512_unpacklo_pd(a, b);
        let high_ab = _mm512_unpackhi_pd(a, b);
        let low_cd = _mm512_unpacklo_pd(c, d);
        let high_cd = _mm512_unpackhi_pd(c, d);
        // Within each half: first the low pairs of both, then the high pairs.
        let low = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0);
        let high = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
        [
            Eight(_mm512_permutex2var_pd(low_ab, low, low_cd)),
            Eight(_mm512_permutex2var_pd(high_ab, low, high_cd)),
            Eight(_mm512_permutex2var_pd(low_ab, high, low_cd)),
            Eight(_mm512_permutex2var_pd(high_ab, high, high_cd)),
        ]
    }
}

impl Lanes for Eight {
    const N: usize = 8;
    type Mask = __mmask8;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(unsafe { _mm512_set1_pd(value) })
    }

    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let from = &from[..8];
        Self(unsafe { _mm512_loadu_pd(from.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to = &mut to[..8];
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(unsafe { _mm512_min_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        unsafe {
            let sign_bit = _mm512_set1_pd(-0.0);
            let magnitude = _mm512_andnot_pd(sign_bit, self.0);
            Self(_mm512_or_pd(magnitude, _mm512_and_pd(sign_bit, sign.0)))
        }
    }

    #[inline(always)]
    fn round(self) -> Self {
        // Just less than a half, so that 0.49999999999999994 stays below one.
        let half = Self::splat(0.5_f64.next_down()).copysign(self);
        const TOWARD_ZERO: i32 = _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC;
        Self(unsafe { _mm512_roundscale_pd::<TOWARD_ZERO>((self + half).0) })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    fn le(self, other: Self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    fn or_where(self, mask: __mmask8, other: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_pd(mask, other.0, self.0) })
    }

    #[inline(always)]
    fn from_rows_of_4<'a>(row: impl Fn(usize) -> &'a [f64; 4]) -> [Self; 4] {
        unsafe {
            columns_of_4([
                halves(row(0), row(4)),
                halves(row(1), row(5)),
                halves(row(2), row(6)),
                halves(row(3), row(7)),
            ])
        }
    }

    #[inline(always)]
    fn from_rows_of_3(rows: &[[f64; 3]]) -> [Self; 3] {
        let flat = rows[..8].as_flattened();
        unsafe {
            let a = _mm512_loadu_pd(flat.as_ptr());
            let b = _mm512_loadu_pd(flat[8..].as_ptr());
            let c = _mm512_loadu_pd(flat[16..].as_ptr());
            // a = x0 y0 z0 x1 y1 z1 x2 y2, b = z2 x3 y3 z3 x4 y4 z4 x5, c = y5 z5 x6 y6 z6 x7 y7 z7
            let x = _mm512_permutex2var_pd(a, _mm512_set_epi64(0, 0, 15, 12, 9, 6, 3, 0), b);
            let y = _mm512_permutex2var_pd(a, _mm512_set_epi64(0, 0, 0, 13, 10, 7, 4, 1), b);
            let z = _mm512_permutex2var_pd(a, _mm512_set_epi64(0, 0, 0, 14, 11, 8, 5, 2), b);
            [
                Self(_mm512_permutex2var_pd(x, _mm512_set_epi64(13, 10, 5, 4, 3, 2, 1, 0), c)),
                Self(_mm512_permutex2var_pd(y, _mm512_set_epi64(14, 11, 8, 4, 3, 2, 1, 0), c)),
                Self(_mm512_permutex2var_pd(z, _mm512_set_epi64(15, 12, 9, 4, 3, 2, 1, 0), c)),
            ]
        }
    }

    #[inline(always)]
    fn to_rows_of_3([x, y, z]: [Self; 3], rows: &mut [[f64; 3]]) {
        let flat = rows[..8].as_flattened_mut();
        unsafe {
            // Indices 0 to 7 select from x, 8 to 15 from y; then the mask overwrites elements with z.
            let a = _mm512_permutex2var_pd(x.0, _mm512_set_epi64(10, 2, 0, 9, 1, 0, 8, 0), y.0);
            let b = _mm512_permutex2var_pd(x.0, _mm512_set_epi64(5, 0, 12, 4, 0, 11, 3, 0), y.0);
            let c = _mm512_permutex2var_pd(x.0, _mm512_set_epi64(0, 15, 7, 0, 14, 6, 0, 13), y.0);
            let a_z = _mm512_set_epi64(0, 0, 1, 0, 0, 0, 0, 0);
            let b_z = _mm512_set_epi64(0, 4, 0, 0, 3, 0, 0, 2);
            let c_z = _mm512_set_epi64(7, 0, 0, 6, 0, 0, 5, 0);
            let a = _mm512_mask_permutexvar_pd(a, 0b0010_0100, a_z, z.0);
            let b = _mm512_mask_permutexvar_pd(b, 0b0100_1001, b_z, z.0);
            let c = _mm512_mask_permutexvar_pd(c, 0b1001_0010, c_z, z.0);
            _mm512_storeu_pd(flat.as_mut_ptr(), a);
            _mm512_storeu_pd(flat[8..].as_mut_ptr(), b);
            _mm512_storeu_pd(flat[16..].as_mut_ptr(), c);
        }
    }

    #[inline(always)]
    fn to_rows_of_4([a, b, c, d]: [Self; 4], rows: &mut [[f64; 4]]) {
        let rows = &mut rows[..8];
        unsafe {
            // The transpose of each half is the same both ways.
            let columns = columns_of_4([a.0, b.0, c.0, d.0]);
            for (k, column) in columns.into_iter().enumerate() {
                _mm256_storeu_pd(rows[k].as_mut_ptr(), _mm512_castpd512_pd256(column.0));
                let high = _mm512_extractf64x4_pd::<1>(column.0);
                _mm256_storeu_pd(rows[k + 4].as_mut_ptr(), high);
            }
        }
    }

    #[inline(always)]
    fn to_rows_of_8(columns: [Self; 8], rows: &mut [[f64; 8]]) {
        let rows = &mut rows[..8];
        let [a, b, c, d, e, f, g, h] = columns;
        unsafe {
            // Transposes within quarters, then moves the quarters to their rows.
            let left = [
                _mm512_unpacklo_pd(a.0, b.0),
                _mm512_unpackhi_pd(a.0, b.0),
                _mm512_unpacklo_pd(c.0, d.0),
                _mm512_unpackhi_pd(c.0, d.0),
            ];
            let right = [
                _mm512_unpacklo_pd(e.0, f.0),
                _mm512_unpackhi_pd(e.0, f.0),
                _mm512_unpacklo_pd(g.0, h.0),
                _mm512_unpackhi_pd(g.0, h.0),
            ];
            for odd in 0..2 {
                // The quarters of these four hold rows odd, odd + 2, odd + 4 and odd + 6.
                let [ab, cd, ef, gh] = [left[odd], left[odd + 2], right[odd], right[odd + 2]];
                let first = _mm512_shuffle_f64x2::<0b10_00_10_00>(ab, cd);
                let second = _mm512_shuffle_f64x2::<0b11_01_11_01>(ab, cd);
                let third = _mm512_shuffle_f64x2::<0b10_00_10_00>(ef, gh);
                let fourth = _mm512_shuffle_f64x2::<0b11_01_11_01>(ef, gh);
                let in_order = [
                    _mm512_shuffle_f64x2::<0b10_00_10_00>(first, third),
                    _mm512_shuffle_f64x2::<0b10_00_10_00>(second, fourth),
                    _mm512_shuffle_f64x2::<0b11_01_11_01>(first, third),
                    _mm512_shuffle_f64x2::<0b11_01_11_01>(second, fourth),
                ];
                for (k, row) in in_order.into_iter().enumerate() {
                    _mm512_storeu_pd(rows[2 * k + odd].as_mut_ptr(), row);
                }
            }
        }
    }
}

impl Mask for __mmask8 {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }

    #[inline(always)]
    fn not(self) -> Self {
        !self
    }

    #[inline(always)]
    fn any(self) -> bool {
        self != 0
    }

    #[inline(always)]
    fn bits(self) -> u8 {
        self
    }
}
