//! Visitors of the keys of a scene: the reader fills the values from a tree, the printer writes them,
//! the reference describes the keys. Thus every key, its unit and its limits are in exactly one line
//! of `schema`.

use super::quantity::Dimension;
use crate::base::{Real, Vec3};

/// Limits of a number, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Range {
    /// Any finite number.
    Any,
    /// Greater than this.
    Above(Real),
    /// This or greater.
    AtLeast(Real),
    /// This or less.
    AtMost(Real),
    /// Between these, inclusive.
    Between(Real, Real),
    /// Greater than the first and at most the second.
    AboveUpTo(Real, Real),
}

impl Range {
    /// True if `value` is finite and inside.
    pub(crate) fn contains(self, value: Real) -> bool {
        value.is_finite()
            && match self {
                Self::Any => true,
                Self::Above(min) => min < value,
                Self::AtLeast(min) => min <= value,
                Self::AtMost(max) => value <= max,
                Self::Between(min, max) => min <= value && value <= max,
                Self::AboveUpTo(min, max) => min < value && value <= max,
            }
    }

    /// Describes the range; `print` writes a number with its unit.
    pub(crate) fn describe(self, print: impl Fn(Real) -> String) -> String {
        match self {
            Self::Any => "finite".to_owned(),
            Self::Above(min) => format!("above {}", print(min)),
            Self::AtLeast(min) => format!("at least {}", print(min)),
            Self::AtMost(max) => format!("at most {}", print(max)),
            Self::Between(min, max) => format!("from {} to {}", print(min), print(max)),
            Self::AboveUpTo(min, max) => format!("above {}, at most {}", print(min), print(max)),
        }
    }
}

/// A key that holds a quantity: its dimension and limits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quantity {
    /// Its dimension.
    pub dimension: &'static Dimension,
    /// Its limits.
    pub range: Range,
}

impl Quantity {
    /// Any finite value.
    pub(crate) const fn any(dimension: &'static Dimension) -> Self {
        Self { dimension, range: Range::Any }
    }

    /// Greater than zero.
    pub(crate) const fn above_zero(dimension: &'static Dimension) -> Self {
        Self { dimension, range: Range::Above(0.0) }
    }

    /// Zero or greater.
    pub(crate) const fn at_least_zero(dimension: &'static Dimension) -> Self {
        Self { dimension, range: Range::AtLeast(0.0) }
    }

    /// Between two values, inclusive.
    pub(crate) const fn between(dimension: &'static Dimension, min: Real, max: Real) -> Self {
        Self { dimension, range: Range::Between(min, max) }
    }
}

/// Visits the keys of a scene. The reader sets the values, the printer reads them.
pub(crate) trait Visitor: Sized {
    /// Describes the next key. Only the scene reference uses it.
    fn doc(&mut self, _text: &'static str) {}

    /// A map under `key`.
    fn section(&mut self, key: &'static str, inside: impl FnOnce(&mut Self));

    /// A number with a unit.
    fn quantity(&mut self, key: &'static str, kind: Quantity, value: &mut Real);

    /// A number with a unit, or `word` for none.
    fn quantity_or(
        &mut self,
        key: &'static str,
        word: &'static str,
        kind: Quantity,
        value: &mut Option<Real>,
    );

    /// Three numbers with units.
    fn vector(&mut self, key: &'static str, kind: Quantity, value: &mut Vec3);

    /// A list of vectors.
    fn vectors(&mut self, key: &'static str, kind: Quantity, value: &mut Vec<Vec3>);

    /// A number without a dimension.
    fn number(&mut self, key: &'static str, range: Range, value: &mut Real);

    /// A list of `N` numbers without a dimension.
    fn numbers<const N: usize>(&mut self, key: &'static str, value: &mut [Real; N]);

    /// A list of numbers with units.
    fn quantities(&mut self, key: &'static str, kind: Quantity, value: &mut Vec<Real>);

    /// A list of any number of numbers without a dimension.
    fn plain_numbers(&mut self, key: &'static str, range: Range, value: &mut Vec<Real>);

    /// An integer.
    fn integer(&mut self, key: &'static str, min: u64, max: u64, value: &mut u64);

    /// An integer, or `word` for none.
    fn integer_or(
        &mut self,
        key: &'static str,
        word: &'static str,
        max: u64,
        value: &mut Option<u64>,
    );

    /// `true` or `false`.
    fn flag(&mut self, key: &'static str, value: &mut bool);

    /// A string.
    fn text(&mut self, key: &'static str, value: &mut String);

    /// A string, or `word` for none.
    fn text_or(&mut self, key: &'static str, word: &'static str, value: &mut Option<String>);

    /// One word of a fixed list. Returns the choice, or `current` if there is none.
    fn choice(
        &mut self,
        key: &'static str,
        known: &[&'static str],
        current: &'static str,
    ) -> &'static str;

    /// A map under `key` with exactly one key of a fixed list. Returns that key, or `None` if it is
    /// unknown. The caller then visits `section(key)` and the contents under the returned name.
    fn alternative(
        &mut self,
        key: &'static str,
        known: &[&'static str],
        current: &'static str,
    ) -> Option<&'static str>;

    /// True if values are being read: then keys that a printer leaves out are visited too.
    fn is_reading(&self) -> bool;
}
