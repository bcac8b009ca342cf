//! Tests of the stress in cells.

use super::*;
use crate::{
    base::{
        Pose, Quat,
        random::{Random, Stream},
    },
    measure::stress::{branches, contact_stress, mean_stress},
    physics::{
        System, SystemBuilder,
        builder::Wall,
        law::{PairLaw, Surface},
        state::Grains,
    },
    scene::Material,
};

fn law() -> PairLaw {
    let material = Material { youngs_modulus: 1e8, poisson_ratio: 0.245, density: 2000.0 };
    let surface = Surface { friction: 0.3, dissipation_time: 2e-5, tangential_damping: 0.3 };
    PairLaw::between(&material, &material, surface)
}

/// Sum of stress times cell volume (Pa m³).
fn total(grid: &Grid, stress: &[Option<Mat3>]) -> Mat3 {
    stress.iter().flatten().sum::<Mat3>() * grid.cell_volume()
}

/// Oracle: the mean stress. Tolerance 1e-12: sums of hundreds of parts.
#[test]
fn the_cells_add_up_to_the_contact_stress() {
    let mut random = Random::new(4, Stream::Position);
    let mut vector = || Vec3::from_fn(|_, _| random.between(-1.0, 1.0));
    let branches: Vec<Branch> =
        (0..200).map(|_| Branch { end: vector(), branch: vector(), force: vector() }).collect();
    let frame =
        Pose::from_parts(Vec3::repeat(-4.0).into(), Quat::from_euler_angles(0.1, -0.2, 0.15));
    let grid = Grid::new(frame, Vec3::new(0.3, 0.5, 0.4), [30, 20, 25]).unwrap();
    let mean = mean_stress(&branches, 1.0);
    let cells = cell_stress(&grid, &branches, None);
    assert!((total(&grid, &cells) - mean).norm() < 1e-12 * mean.norm());
    let n_empty = cells.iter().filter(|cell| cell.is_none()).count();
    assert!(0 < n_empty && n_empty < grid.n_cells());
}

/// Oracle: by hand. A branch of length 1 along x with a quarter in the first cell of length 1.
#[test]
fn a_branch_is_shared_by_its_length() {
    let grid = Grid::aligned(&Vec3::zeros(), &Vec3::new(2.0, 1.0, 1.0), [2, 1, 1]).unwrap();
    let branch = Branch {
        end: Vec3::new(1.75, 0.5, 0.5),
        branch: Vec3::new(1.0, 0.0, 0.0),
        force: Vec3::new(8.0, 0.0, 4.0),
    };
    let cells = cell_stress(&grid, &[branch], None).map_each(|it| (it[(0, 0)], it[(2, 0)]));
    assert_eq!(cells, [Some((2.0, 1.0)), Some((6.0, 3.0))]);
}

/// Asserts that two matrices are equal to rounding.
trait MapEach {
    fn map_each<T>(self, of: impl Fn(Mat3) -> T) -> Vec<Option<T>>;
}

impl MapEach for Vec<Option<Mat3>> {
    fn map_each<T>(self, of: impl Fn(Mat3) -> T) -> Vec<Option<T>> {
        self.into_iter().map(|cell| cell.map(&of)).collect()
    }
}

/// Oracle: a simple cubic lattice, compressed equally along all axes, has the same pressure
/// everywhere: that of its one contact per axis and cell. Periodic, so that no cell differs.
/// Tolerance: rounding.
#[test]
fn a_compressed_lattice_is_hydrostatic_in_every_cell() {
    let (n, radius, edge) = (4, 1e-3, 1.99e-3);
    let positions: Vec<Vec3> = (0..n * n * n)
        .map(|k| Vec3::new(real(k % n) + 0.3, real(k / n % n) + 0.4, real(k / n / n) + 0.2) * edge)
        .collect();
    let period = Vec3::repeat(real(n) * edge);
    let masses = vec![1e-5; positions.len()];
    let grains = Grains::at_rest(positions, vec![radius; n * n * n], masses);
    let mut builder = SystemBuilder::new(law());
    builder.substep(1e-6).radii_up_to(radius, radius).period(period).grains(grains);
    let mut system = builder.build().unwrap();
    system.step();
    let System { model, state, scratch, .. } = &system;
    let mean = contact_stress(model, state, scratch, period.product());
    let pressure = mean.trace() / 3.0;
    assert!(pressure > 0.0);
    assert!((mean - Mat3::identity() * pressure).norm() < 1e-12 * pressure);
    let grid = Grid::aligned(&Vec3::zeros(), &period, [2, 4, 2]).unwrap();
    let branches = branches(model, state, scratch);
    for stress in cell_stress(&grid, &branches, Some(&period)) {
        assert!((stress.unwrap() - mean).norm() < 1e-9 * pressure);
    }
}

/// Oracle: the mean stress. Grains on a floor, one above the other; the branch of the lowest starts at its
/// contact point with the floor, so that no cell below has a stress.
#[test]
fn a_wall_carries_its_share() {
    let (radius, n) = (1e-3, 3);
    let positions: Vec<Vec3> =
        (0..n).map(|k| Vec3::new(0.0, 0.0, (real(k) + 0.5) * 1.99e-3)).collect();
    let grains = Grains::at_rest(positions, vec![radius; n], vec![1e-5; n]);
    let mut builder = SystemBuilder::new(law());
    builder.substep(1e-6).radii_up_to(radius, radius).grains(grains);
    builder.wall(Wall::floor(0.0));
    let mut system = builder.build().unwrap();
    system.step();
    let System { model, state, scratch, .. } = &system;
    let branches = branches(model, state, scratch);
    assert_eq!(branches.len(), n);
    let (low, high) = (Vec3::new(-1e-3, -1e-3, -1.1e-3), Vec3::new(1e-3, 1e-3, 7.9e-3));
    let grid = Grid::aligned(&low, &high, [1, 1, 9]).unwrap();
    let cells = cell_stress(&grid, &branches, None);
    let mean = contact_stress(model, state, scratch, 1.0);
    assert!((total(&grid, &cells) - mean).norm() < 1e-12 * mean.norm());
    assert!(cells[0].is_none() && cells[8].is_none() && cells[1].is_some());
}
