//! Every width gives the same bits as plain numbers.

use std::cmp::Ordering;

use super::*;
use crate::base::random::{Random, Stream};

/// All kinds of numbers: ordinary, zero of both signs, halves, infinity, NaN.
fn numbers(random: &mut Random) -> [f64; 24] {
    let special = [0.0, -0.0, 0.5, -0.5, 1.5, 2.5, 0.5_f64.next_down(), f64::INFINITY, f64::NAN];
    std::array::from_fn(|k| match special.get(k) {
        Some(&it) if random.between(0.0, 1.0) < 0.3 => it,
        _ => random.between(-3.0, 3.0),
    })
}

/// All operations on lanes; each result goes into its own row.
struct AllOperations<'a> {
    a: &'a [f64],
    b: &'a [f64],
    out: &'a mut [Vec<f64>],
}

impl Kernel for AllOperations<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        for start in (0..self.a.len()).step_by(L::N) {
            let (a, b) = (L::load(&self.a[start..]), L::load(&self.b[start..]));
            let one = |mask: L::Mask| L::splat(1.0).or_where(mask, L::splat(0.0));
            let from_bits =
                |bits: u8| L::load(&std::array::from_fn::<_, 8, _>(|k| f64::from(bits >> k & 1)));
            let results = [
                a + b,
                a - b,
                a * b,
                a / b,
                -a,
                a.sqrt(),
                a.max(b),
                a.min(b),
                a.round(),
                a.copysign(b),
                one(a.lt(b)),
                one(a.le(b)),
                one(a.lt(b).and(b.lt(L::splat(1.0)))),
                one(a.lt(b).not()),
                from_bits(a.lt(b).bits()),
            ];
            for (row, result) in self.out.iter_mut().zip(results) {
                result.store(&mut row[start..]);
            }
        }
    }
}

/// All ways to load rows into lanes and to store them.
struct Moves<'a> {
    from: &'a [f64],
    to_3: &'a mut [[f64; 3]; 8],
    to_4: &'a mut [[f64; 4]; 8],
    to_8: &'a mut [[f64; 8]; 8],
    columns: &'a mut [Vec<f64>],
}

impl Kernel for Moves<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let (rows_3, _) = self.from.as_chunks::<3>();
        let (rows_4, _) = self.from.as_chunks::<4>();
        for start in (0..8).step_by(L::N) {
            let three = L::from_rows_of_3(&rows_3[start..]);
            // In an irregular order, as neighbor lists have it.
            let four = L::from_rows_of_4(|lane| &rows_4[(start + lane) * 5 % 6]);
            let [x, y, z] = three;
            L::to_rows_of_3([y, z, x], &mut self.to_3[start..]);
            let [a, b, c, d] = four;
            L::to_rows_of_4([d, a, c, b], &mut self.to_4[start..]);
            L::to_rows_of_8([a, b, c, d, x, y, z, a + x], &mut self.to_8[start..]);
            for (row, column) in self.columns.iter_mut().zip(three.into_iter().chain(four)) {
                column.store(&mut row[start..]);
            }
        }
    }
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    // All NaNs count as equal.
    numbers.iter().map(|it| if it.is_nan() { u64::MAX } else { it.to_bits() }).collect()
}

/// Runs `check` at every width that the processor has.
fn at_every_width(check: impl Fn(Width)) {
    let widths = [Width::One, Width::Four, Width::Eight];
    widths.into_iter().filter(|&width| has(width)).for_each(check);
}

#[test]
fn operations_give_the_same_bits_as_plain_numbers() {
    let mut random = Random::new(5, Stream::Position);
    for _ in 0..300 {
        let (a, b) = (numbers(&mut random), numbers(&mut random));
        at_every_width(|width| {
            let mut out = vec![vec![0.0; 24]; 15];
            run_at(width, AllOperations { a: &a, b: &b, out: &mut out });
            for k in 0..24 {
                let (a, b) = (a[k], b[k]);
                let one = |it: bool| f64::from(u8::from(it));
                // Oracle: the language's operations on plain numbers, bit for bit.
                let expected = [
                    a + b,
                    a - b,
                    a * b,
                    a / b,
                    -a,
                    a.sqrt(),
                    if a > b { a } else { b },
                    if a < b { a } else { b },
                    a.round(),
                    a.copysign(b),
                    one(a < b),
                    one(a <= b),
                    one(a < b && b < 1.0),
                    one(a.partial_cmp(&b).is_none_or(Ordering::is_ge)),
                    one(a < b),
                ];
                for (operation, expected) in expected.into_iter().enumerate() {
                    // The sign of a NaN does not matter.
                    if operation == 9 && (a.is_nan() || b.is_nan()) {
                        continue;
                    }
                    let found = out[operation][k];
                    assert_eq!(
                        bits(&[found]),
                        bits(&[expected]),
                        "{width:?}, operation {operation} of {a} and {b}: {found}"
                    );
                }
            }
        });
    }
}

#[test]
fn loading_and_storing_rows_preserves_bits() {
    let mut random = Random::new(6, Stream::Position);
    let from: [f64; 24] = std::array::from_fn(|_| random.between(-3.0, 3.0));
    let (three, _) = from.as_chunks::<3>();
    let (four, _) = from.as_chunks::<4>();
    at_every_width(|width| {
        let (mut to_3, mut to_4, mut to_8) = ([[0.0; 3]; 8], [[0.0; 4]; 8], [[0.0; 8]; 8]);
        let mut columns = vec![vec![0.0; 8]; 7];
        let moves = Moves {
            from: &from,
            to_3: &mut to_3,
            to_4: &mut to_4,
            to_8: &mut to_8,
            columns: &mut columns,
        };
        run_at(width, moves);
        for lane in 0..8 {
            // Oracle: plain indexing.
            let ([x, y, z], [a, b, c, d]) = (three[lane], four[lane * 5 % 6]);
            assert_eq!(bits(&to_3[lane]), bits(&[y, z, x]), "{width:?}");
            assert_eq!(bits(&to_4[lane]), bits(&[d, a, c, b]), "{width:?}");
            assert_eq!(bits(&to_8[lane]), bits(&[a, b, c, d, x, y, z, a + x]), "{width:?}");
            let column: Vec<f64> = columns.iter().map(|column| column[lane]).collect();
            assert_eq!(bits(&column), bits(&[x, y, z, a, b, c, d]), "{width:?}");
        }
    });
}
