//! One lane: a plain number, for every processor.

use super::{Lanes, Mask};

impl Lanes for f64 {
    const N: usize = 1;
    type Mask = bool;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        from[0]
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[0] = self;
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

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.copysign(sign)
    }

    #[inline(always)]
    fn round(self) -> Self {
        self.round()
    }

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn or_where(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }

    #[inline(always)]
    fn from_rows_of_4<'a>(row: impl Fn(usize) -> &'a [f64; 4]) -> [Self; 4] {
        *row(0)
    }

    #[inline(always)]
    fn from_rows_of_3(rows: &[[f64; 3]]) -> [Self; 3] {
        rows[0]
    }

    #[inline(always)]
    fn to_rows_of_3(columns: [Self; 3], rows: &mut [[f64; 3]]) {
        rows[0] = columns;
    }

    #[inline(always)]
    fn to_rows_of_4(columns: [Self; 4], rows: &mut [[f64; 4]]) {
        rows[0] = columns;
    }

    #[inline(always)]
    fn to_rows_of_8(columns: [Self; 8], rows: &mut [[f64; 8]]) {
        rows[0] = columns;
    }
}

impl Mask for bool {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self && other
    }

    #[inline(always)]
    fn not(self) -> Self {
        !self
    }

    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn bits(self) -> u8 {
        u8::from(self)
    }
}
