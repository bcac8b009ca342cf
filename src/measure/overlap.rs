//! Overlap volume of a sphere and an axis-aligned box, in closed form.
//!
//! ```text
//! V(box)  = Σ ± P(corner)            over its eight corners, − for each high coordinate
//! P       = volume of the ball beyond three planes x > a, y > b, z > c
//!         = 1/3 (R S − a A_a − b A_b − c A_c)                       for a, b, c ≥ 0 (Gauss)
//! S       = R² (2π − Σ (a/R) φ_a − Σ atan2(R h_ab, −a b))           (Gauss–Bonnet)
//! h_ab    = √(R² − a² − b²)
//!
//! R    radius of the sphere, whose center is the origin             (m)
//! S    area of the sphere's part of the surface                     (m²)
//! A_a  area of the part of the surface in the plane x = a           (m²)
//! φ_a  angle of the arc that bounds both                            (rad)
//! ```
//!
//! Negative coordinates are mirrored: the parts beyond −a and beyond a add up to the ball beyond the
//! other planes. Exact to rounding, about 1e-15 R³.

use std::f64::consts::PI;

use crate::base::{Real, Vec3};

/// Volume (m³) of the sphere around `center` with `radius` in the box from `low` to `high` (m).
pub fn sphere_in_box(center: &Vec3, radius: Real, low: &Vec3, high: &Vec3) -> Real {
    let (from, to) = (low - center, high - center);
    if (from.max() <= -radius) && (radius <= to.min()) {
        return 4.0 / 3.0 * PI * radius.powi(3);
    }
    if from.max() >= radius || to.min() <= -radius {
        return 0.0;
    }
    let mut volume = 0.0;
    for corner in 0..8_u32 {
        let is_high = [0, 1, 2].map(|axis| corner >> axis & 1 == 1);
        let at = Vec3::from_fn(|axis, _| if is_high[axis] { to[axis] } else { from[axis] });
        let sign = if corner.count_ones() % 2 == 0 { 1.0 } else { -1.0 };
        volume += sign * beyond_three(radius, at);
    }
    volume
}

/// Volume of the ball beyond x > a.
fn beyond_one(radius: Real, a: Real) -> Real {
    let a = a.clamp(-radius, radius);
    PI / 3.0 * (radius - a).powi(2) * (2.0 * radius + a)
}

/// Volume of the ball beyond x > a and y > b.
fn beyond_two(radius: Real, a: Real, b: Real) -> Real {
    if a < 0.0 {
        return beyond_one(radius, b) - beyond_two(radius, -a, b);
    }
    if b < 0.0 {
        return beyond_one(radius, a) - beyond_two(radius, a, -b);
    }
    let squared = radius * radius - a * a - b * b;
    if squared <= 0.0 {
        return 0.0;
    }
    let h = squared.sqrt();
    let arcs = [2.0 * h.atan2(b), 2.0 * h.atan2(a)];
    let corner = (radius * h).atan2(-a * b);
    let sphere = radius * radius * (2.0 * PI - (a * arcs[0] + b * arcs[1]) / radius - 2.0 * corner);
    let segment = |a: Real, b: Real, arc: Real| 0.5 * (radius * radius - a * a) * arc - b * h;
    (radius * sphere - a * segment(a, b, arcs[0]) - b * segment(b, a, arcs[1])) / 3.0
}

/// Volume of the ball beyond x > a, y > b and z > c.
fn beyond_three(radius: Real, at: Vec3) -> Real {
    for axis in 0..3 {
        if at[axis] < 0.0 {
            let mut mirrored = at;
            mirrored[axis] = -at[axis];
            let (b, c) = (at[(axis + 1) % 3], at[(axis + 2) % 3]);
            return beyond_two(radius, b, c) - beyond_three(radius, mirrored);
        }
    }
    if at.norm_squared() >= radius * radius {
        return 0.0;
    }
    let (mut turned, mut flat) = (0.0, 0.0);
    for axis in 0..3 {
        let [a, b, c] = [0, 1, 2].map(|k| at[(axis + k) % 3]);
        // The intersections of the arc in the plane of a with the planes of b and c.
        let h = |other: Real| (radius * radius - a * a - other * other).sqrt();
        let arc = h(b).atan2(b) - c.atan2(h(c));
        let in_plane = (radius * radius - a * a) * arc - b * (h(b) - c) - c * (h(c) - b);
        flat += a * 0.5 * in_plane;
        turned += a / radius * arc + (radius * h(b)).atan2(-a * b);
    }
    (radius.powi(3) * (2.0 * PI - turned) - flat) / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::{Random, Stream};

    const R: Real = 0.3;
    const VOLUME: Real = 4.0 / 3.0 * PI * R * R * R;

    fn in_cube(center: [Real; 3], radius: Real, edge: Real) -> Real {
        sphere_in_box(&Vec3::from(center), radius, &Vec3::zeros(), &Vec3::repeat(edge))
    }

    /// Oracle: symmetry. Tolerance: rounding.
    #[test]
    fn on_a_face_edge_or_corner_it_is_a_half_a_quarter_an_eighth() {
        for (center, share) in
            [([0.0, 1.0, 1.0], 0.5), ([0.0, 0.0, 1.0], 0.25), ([0.0, 0.0, 0.0], 0.125)]
        {
            assert!((in_cube(center, R, 2.0) / VOLUME - share).abs() < 1e-14, "{share}");
        }
        assert!((in_cube([1.0; 3], R, 2.0) / VOLUME - 1.0).abs() < 1e-15);
        assert!(in_cube([-0.4, 1.0, 1.0], R, 2.0).abs() < 1e-15);
    }

    /// Oracle: the cap π h² (3 R − h)/3, and a cube without its six disjoint caps' complement.
    /// Tolerance: the seven digits of the printed values.
    #[test]
    fn caps_and_a_cube_in_a_sphere_have_their_elementary_volumes() {
        let small = in_cube([-0.1, 1.0, 1.0], R, 2.0);
        assert!((small - 0.029_321_5).abs() < 5e-8, "{small}");
        let large = in_cube([0.1, 1.0, 1.0], R, 2.0);
        assert!((large - 0.083_775_8).abs() < 5e-8, "{large}");
        let cut = in_cube([0.5; 3], 0.6, 1.0);
        assert!((cut - 0.797_964_5).abs() < 5e-8, "{cut}");
    }

    /// Oracle: the parts of a partition add up to the sphere. Tolerance 1e-12 of it: 343 sums of
    /// eight terms, each exact to 1e-15.
    #[test]
    fn the_parts_in_all_cells_add_up_to_the_sphere() {
        let mut random = Random::new(1, Stream::Position);
        for _ in 0..300 {
            let center = Vec3::from_fn(|_, _| random.between(-0.2, 0.2));
            let radius = random.between(0.05, 0.6);
            let cuts = [-1.0, -0.31, -0.1, 0.0, random.between(0.0, 0.2), 0.25, 0.4, 1.0];
            let mut sum = 0.0;
            for cell in 0..343 {
                let k = [cell % 7, cell / 7 % 7, cell / 49];
                let part = sphere_in_box(
                    &center,
                    radius,
                    &Vec3::from(k.map(|k| cuts[k])),
                    &Vec3::from(k.map(|k| cuts[k + 1])),
                );
                assert!(part > -1e-15, "{part}");
                sum += part;
            }
            let sphere_volume = 4.0 / 3.0 * PI * radius.powi(3);
            assert!((sum / sphere_volume - 1.0).abs() < 1e-12, "{sum} {sphere_volume}");
        }
    }

    /// Oracle: the `overlap` library of Strobl, Formella & Pöschel (2016) (tests/golden/measure/make.py):
    /// spheres and boxes in all relative positions. Tolerance 1e-12 of the smaller of both volumes.
    #[test]
    fn volumes_are_those_of_the_overlap_library() {
        let text = include_str!("../../tests/golden/measure/overlap.json");
        let rows: Vec<serde_json::Value> = serde_json::from_str(text).unwrap();
        assert_eq!(rows.len(), 120);
        for row in rows {
            let vector = |key: &str| -> Vec3 {
                let numbers: [Real; 3] = serde_json::from_value(row[key].clone()).unwrap();
                Vec3::from(numbers)
            };
            let real = |key: &str| row[key].as_f64().unwrap();
            let (center, low, high) = (vector("center"), vector("low"), vector("high"));
            let found = sphere_in_box(&center, real("radius"), &low, &high);
            let size = (high - low).product().min(4.0 / 3.0 * PI * real("radius").powi(3));
            let difference = (found - real("volume")).abs();
            assert!(difference < 1e-12 * size, "{row}: {found}");
        }
    }
}
