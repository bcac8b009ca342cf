//! Scene keys as struct fields: `scene_keys!` declares a struct, the unset value of each field, and
//! how each key is read, in one line per key.
//!
//! ```text
//! scene_keys! {
//!     /// How the ball is pulled.
//!     pub(super) struct Pull {
//!         /// Speed (m/s).
//!         speed: Real = Quantity::above_zero(&SPEED),
//!         /// Number of recorded points.
//!         n_points ("points"): usize = 2..=1000,
//!     }
//! }
//! ```
//!
//! The key is the name of the field, or the literal after it. The expression says what is allowed:
//! see the implementations of `Limits`. The order of the fields is the order in which keys are
//! read.

use std::ops::RangeInclusive;

use super::{
    Chamber, Grains, Material, Membrane, Time, schema,
    visit::{Quantity, Range, Visitor},
};
use crate::base::{Real, Vec3};

/// A group of keys that belong together.
pub(crate) trait Section {
    /// Visits every key with its unit and its limits.
    fn walk(&mut self, walk: &mut impl Visitor);
}

/// What a value of type `T` may be, and how it is read.
pub(crate) trait Limits<T> {
    /// Visits `key` with its `value`.
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut T);
}

/// Declares structs whose fields are scene keys.
macro_rules! scene_keys {
    ($(
        $(#[$attribute:meta])*
        $visibility:vis struct $name:ident {
            $( $(#[$doc:meta])* $field:ident $(($key:literal))? : $type:ty = $limits:expr, )*
        }
    )*) => { $(
        $(#[$attribute])*
        #[derive(Clone, Debug)]
        $visibility struct $name { $( $(#[$doc])* $visibility $field: $type, )* }

        impl $crate::scene::unset::Unset for $name {
            fn unset() -> Self {
                Self { $( $field: $crate::scene::unset::Unset::unset(), )* }
            }
        }

        impl $crate::scene::keys::Section for $name {
            fn walk(&mut self, walk: &mut impl $crate::scene::visit::Visitor) {
                $(
                    let key = $crate::scene::keys::scene_keys!(@key $field $($key)?);
                    $crate::scene::keys::Limits::<$type>::visit(
                        $limits, walk, key, &mut self.$field,
                    );
                )*
            }
        }
    )* };
    (@key $field:ident) => { stringify!($field) };
    (@key $field:ident $key:literal) => { $key };
}
pub(crate) use scene_keys;

/// A number with a unit.
impl Limits<Real> for Quantity {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut Real) {
        walk.quantity(key, self, value);
    }
}

/// A list of numbers with units.
impl Limits<Vec<Real>> for Quantity {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut Vec<Real>) {
        walk.quantities(key, self, value);
    }
}

/// Three numbers with units.
impl Limits<Vec3> for Quantity {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut Vec3) {
        walk.vector(key, self, value);
    }
}

/// A number with a unit, or this word for none.
pub(crate) struct QuantityOr(pub(crate) &'static str, pub(crate) Quantity);

impl Limits<Option<Real>> for QuantityOr {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut Option<Real>) {
        walk.quantity_or(key, self.0, self.1, value);
    }
}

/// A number without a dimension.
impl Limits<Real> for Range {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut Real) {
        walk.number(key, self, value);
    }
}

/// A list of numbers without a dimension.
impl Limits<Vec<Real>> for Range {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut Vec<Real>) {
        walk.plain_numbers(key, self, value);
    }
}

/// An integer.
impl Limits<u64> for RangeInclusive<u64> {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut u64) {
        walk.integer(key, *self.start(), *self.end(), value);
    }
}

/// An integer as `usize`.
impl Limits<usize> for RangeInclusive<u64> {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut usize) {
        schema::integer_usize(walk, key, (*self.start(), *self.end()), value);
    }
}

/// `true` or `false`.
pub(crate) struct Flag;

impl Limits<bool> for Flag {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut bool) {
        walk.flag(key, value);
    }
}

/// A text.
pub(crate) struct Text;

impl Limits<String> for Text {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut String) {
        walk.text(key, value);
    }
}

/// A map under the key.
#[derive(Clone, Copy)]
pub(crate) struct Map;

impl<T: Section> Limits<T> for Map {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, value: &mut T) {
        walk.section(key, |walk| value.walk(walk));
    }
}

/// Keys beside the others, without a separate map; the field's name is not a key.
pub(crate) struct Inline;

impl<T: Section> Limits<T> for Inline {
    fn visit(self, walk: &mut impl Visitor, _: &'static str, value: &mut T) {
        value.walk(walk);
    }
}

/// Values of one kind under separate keys; the field's name is not a key.
pub(crate) struct Each<L, const N: usize>(pub(crate) [&'static str; N], pub(crate) L);

impl<T, L: Limits<T> + Clone, const N: usize> Limits<[T; N]> for Each<L, N> {
    fn visit(self, walk: &mut impl Visitor, _: &'static str, values: &mut [T; N]) {
        for (key, value) in self.0.into_iter().zip(values) {
            self.1.clone().visit(walk, key, value);
        }
    }
}

/// The same in a map under the key.
pub(crate) struct MapOf<L, const N: usize>(pub(crate) [&'static str; N], pub(crate) L);

impl<T, L: Limits<T> + Clone, const N: usize> Limits<[T; N]> for MapOf<L, N> {
    fn visit(self, walk: &mut impl Visitor, key: &'static str, values: &mut [T; N]) {
        walk.section(key, |walk| Each(self.0, self.1).visit(walk, key, values));
    }
}

/// Parts of the gripper's scene, which `schema` describes.
macro_rules! sections_of_schema {
    ($($type:ty: $walk:ident),*) => { $(
        impl Section for $type {
            fn walk(&mut self, walk: &mut impl Visitor) {
                schema::$walk(walk, self);
            }
        }
    )* };
}

sections_of_schema!(
    Time: time, Material: material, Grains: grains, Membrane: membrane, Chamber: chamber
);

#[cfg(test)]
mod tests {
    use super::{super::text, *};
    use crate::scene::{quantity::LENGTH, unset::Unset};

    scene_keys! {
        /// A scene with a key of every form.
        struct Example {
            /// Renamed.
            is_on ("on"): bool = Flag,
            /// Inline.
            material: Material = Inline,
            /// A map.
            part: Part = Map,
            /// Values under separate keys.
            ends: [Real; 2] = Each(["left", "right"], Quantity::any(&LENGTH)),
            /// Counted.
            counts: [u64; 2] = MapOf(["a", "b"], 1..=9),
        }

        /// A map.
        struct Part {
            /// Optional.
            gap: Option<Real> = QuantityOr("none", Quantity::above_zero(&LENGTH)),
        }
    }

    impl text::Keys for Example {
        fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
            Vec::new()
        }
    }

    const TEXT: &str = "on: true\nyoungs_modulus: 1 MPa\npoisson_ratio: 0.3\ndensity: 2000 kg/m^3\n\
                        part: { gap: none }\nleft: -1 mm\nright: 2 mm\ncounts: { a: 1, b: 9 }\n";

    fn read(text: &str) -> Result<Example, String> {
        let variants = (["quick"].as_slice(), "quick");
        let layers =
            text::Layers { text, source: "x.yaml", variants, overrides: &[], on_defaults: false };
        text::read(&layers).map_err(|error| error.to_string())
    }

    /// Oracle: the text, value by value; a value out of its limits is named by its key.
    #[test]
    fn every_form_of_a_key_is_read_and_checked() {
        let unset = Example::unset();
        assert!(!unset.is_on && unset.material.density.is_nan() && unset.counts == [0; 2]);
        let scene = read(TEXT).unwrap();
        assert!(scene.is_on && scene.part.gap.is_none());
        assert_eq!(scene.material.density.to_bits(), 2000.0_f64.to_bits());
        assert_eq!(scene.ends.map(f64::to_bits), [-1e-3, 2e-3].map(f64::to_bits));
        assert_eq!(scene.counts, [1, 9]);
        let error = read(&TEXT.replace("b: 9", "b: 10")).unwrap_err();
        assert!(error.contains("counts.b") && error.contains("from 1 to 9"), "{error}");
        let error = read(&TEXT.replace("on: true\n", "")).unwrap_err();
        assert!(error.contains("`on`") || error.contains("on:"), "{error}");
    }
}
