//! Tests of coarse-grained fields.

use super::*;
use crate::base::{
    Pose, Quat,
    random::{Random, Stream},
    real::real,
};

/// Spheres at random places in a unit cube, overlapping or not, and a rotated grid around them.
fn scattered(n: usize) -> (Vec<Vec3>, Vec<Real>, Grid) {
    let mut random = Random::new(8, Stream::Position);
    let positions = (0..n).map(|_| Vec3::from_fn(|_, _| random.unit())).collect();
    let radii = (0..n).map(|_| random.between(0.02, 0.12)).collect();
    let rotation = Quat::from_euler_angles(0.4, 0.2, -0.9);
    let corner = Vec3::repeat(0.5) - rotation * Vec3::repeat(1.2);
    let frame = Pose::from_parts(corner.into(), rotation);
    let grid = Grid::new(frame, Vec3::new(0.2, 0.3, 0.24), [12, 8, 10]).unwrap();
    (positions, radii, grid)
}

/// Oracle: the total of the distributed quantity. Tolerance 1e-12: sums of thousands of parts, each
/// exact to 1e-15.
#[test]
fn the_cells_add_up_to_the_totals() {
    let (positions, radii, grid) = scattered(300);
    let overlaps = Overlaps::new(&grid, &positions, &radii, None);
    for i in 0..positions.len() {
        let total: Real = overlaps.of_sphere(i).iter().map(|(_, share)| share).sum();
        assert!((total - 1.0).abs() < 1e-12, "{total}");
    }
    let volume: Real = radii.iter().map(|r| 4.0 / 3.0 * PI * r.powi(3)).sum();
    let solid: Real = overlaps.solid_fraction().iter().sum::<Real>() * grid.cell_volume();
    assert!((solid / volume - 1.0).abs() < 1e-12);
    let momenta: Vec<Vec3> = positions.iter().zip(&radii).map(|(x, r)| x * *r).collect();
    let total: Vec3 = momenta.iter().sum();
    let spread = overlaps.density(&momenta).iter().sum::<Vec3>() * grid.cell_volume();
    assert!((spread - total).norm() < 1e-12 * total.norm());
}

/// Oracle: the field itself; no tolerance. Cells without spheres have no value, all others have.
#[test]
fn a_rigid_translation_is_the_same_in_every_cell_to_the_last_bit() {
    let (positions, radii, grid) = scattered(40);
    let overlaps = Overlaps::new(&grid, &positions, &radii, None);
    let moved: Vec<Vec3> = positions.iter().map(|x| x + Vec3::new(0.25, -0.5, 2.0)).collect();
    let velocities = vec![Vec3::new(0.1, -0.3, 0.7); positions.len()];
    let masses: Vec<Real> = radii.iter().map(|r| r.powi(3)).collect();
    let solid = overlaps.solid_fraction();
    let displacement = overlaps.mean(&displacements(&positions, &moved, None));
    for (cell, velocity) in overlaps.weighted_mean(&masses, &velocities).iter().enumerate() {
        assert_eq!(*velocity, (solid[cell] > 0.0).then_some(velocities[0]));
        assert_eq!(velocity.is_some(), displacement[cell].is_some());
        let delta = displacement[cell].map_or(0.0, |it| (it - Vec3::new(0.25, -0.5, 2.0)).norm());
        assert!(delta < 1e-15, "{delta}");
    }
    assert!(solid.contains(&0.0) && solid.iter().any(|it| *it > 0.0));
}

/// Oracle: momentum density over mass density.
#[test]
fn means_with_masses_are_momentum_over_mass() {
    let (positions, radii, grid) = scattered(200);
    let overlaps = Overlaps::new(&grid, &positions, &radii, None);
    let masses: Vec<Real> = radii.iter().map(|r| 2e3 * r.powi(3)).collect();
    let velocities: Vec<Vec3> =
        positions.iter().map(|x| x.cross(&Vec3::new(1.0, 2.0, 3.0))).collect();
    let momenta: Vec<Vec3> = velocities.iter().zip(&masses).map(|(v, m)| v * *m).collect();
    let (momentum, mass) = (overlaps.density(&momenta), overlaps.density(&masses));
    for (cell, velocity) in overlaps.weighted_mean(&masses, &velocities).iter().enumerate() {
        if let Some(velocity) = velocity {
            assert!((momentum[cell] / mass[cell] - velocity).norm() < 1e-12);
        }
    }
}

/// Oracle: the prescribed gradient. Exact to rounding if the cells are those of a lattice, since all cells
/// then have the same content.
#[test]
fn a_linear_velocity_has_its_gradient() {
    let n = 6;
    let positions: Vec<Vec3> = (0..n * n * n)
        .map(|k| Vec3::new(real(k % n) + 0.3, real(k / n % n) + 0.5, real(k / n / n) + 0.1))
        .collect();
    let rotation = Quat::from_euler_angles(0.4, 0.2, -0.9);
    let positions: Vec<Vec3> = positions.iter().map(|x| rotation * x).collect();
    let frame = Pose::from_parts(Vec3::zeros().into(), rotation);
    let grid = Grid::new(frame, Vec3::repeat(1.0), [n; 3]).unwrap();
    let overlaps = Overlaps::new(&grid, &positions, &vec![0.4; n * n * n], None);
    let expected = Mat3::new(0.1, 2.0, -0.4, 0.0, 0.7, 1.3, -2.2, 0.5, -0.8);
    let velocities: Vec<Vec3> = positions.iter().map(|x| expected * x).collect();
    let gradients = gradient(&grid, &overlaps.mean(&velocities));
    for indices in [[1, 1, 1], [2, 3, 3], [3, 4, 2]] {
        let found = gradients[grid.index(indices)].unwrap();
        assert!((found - expected).norm() < 1e-12, "{found}");
    }
    let mut lonely = vec![None; grid.n_cells()];
    lonely[grid.index([2, 2, 2])] = Some(Vec3::x());
    assert!(gradient(&grid, &lonely).iter().all(Option::is_none));
}

/// Oracle: the spheres' volume, although many extend beyond the box; a sphere shifted by periods is the same
/// sphere.
#[test]
fn a_periodic_box_has_no_outside() {
    let (positions, radii, _) = scattered(100);
    let period = Vec3::repeat(1.0);
    let grid = Grid::aligned(&Vec3::zeros(), &period, [5, 4, 3]).unwrap();
    let solid = Overlaps::new(&grid, &positions, &radii, Some(&period)).solid_fraction();
    let total: Real = solid.iter().sum::<Real>() * grid.cell_volume();
    let volume: Real = radii.iter().map(|r| 4.0 / 3.0 * PI * r.powi(3)).sum();
    assert!((total / volume - 1.0).abs() < 1e-12);
    let strayed: Vec<Vec3> = positions.iter().map(|x| x + Vec3::new(3.0, -1.0, 0.0)).collect();
    let again = Overlaps::new(&grid, &strayed, &radii, Some(&period)).solid_fraction();
    assert!(solid.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-12));
    let moved: Vec<Vec3> = positions.iter().map(|x| x.map(|x| (x + 0.1) % 1.0)).collect();
    let steps = displacements(&positions, &moved, Some(&period));
    assert!(steps.iter().all(|step| (step - Vec3::repeat(0.1)).norm() < 1e-14));
}
