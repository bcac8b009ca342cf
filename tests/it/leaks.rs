//! What comes through: grains much smaller than those that the membranes were made for.
#![expect(clippy::print_stderr, reason = "what was measured is shown with the result")]

use jamgrip::{
    base::{Pose, Real, Vec3, real::Twist},
    physics::{
        boundary::{
            body::BodyMotion,
            wall::{WallModel, WallShape},
        },
        health::{self, Diverged},
        law::Surface,
        membrane::{CARRIER_ID, FREE, MembraneContact, mesh::Mesh},
        state::Springs,
    },
    scene::Material,
};

use crate::{
    rig::{Rig, hertz_constant},
    sheet::{alone, hexagon},
};

/// Radius of the grains that both membranes were made for: those of the triaxial test (m).
const RADIUS: Real = 2.5e-3;
/// Distance of the spheres in the triaxial test, and their radius (m).
const SPACING: Real = 1.3e-3;
const SPHERE: Real = 0.65e-3;
/// Edge of the triangles there (m).
const EDGE: Real = 4e-3;
/// A tube around a bed of grains (m).
const TUBE: Real = 5e-3;
/// Pressure of the triaxial test (Pa).
const PRESSURE: Real = 100e3;

const SPHERES: MembraneContact = MembraneContact::Spheres { radius: SPHERE };

/// Grains of the triaxial test, softened: what counts is the sheet, softer by far.
const MATERIAL: Material = Material { youngs_modulus: 1e8, poisson_ratio: 0.245, density: 2000.0 };

fn rig(mesh: Mesh, contact: MembraneContact, dt: Real) -> Rig {
    let surface = Surface { friction: 0.25, dissipation_time: 5e-6, tangential_damping: 0.3 };
    let mut rig = Rig::on_sheet(&MATERIAL, surface, mesh, dt);
    rig.model.membrane_law.friction = 1.2;
    rig.model.membrane.contact = contact;
    rig
}

/// Three close layers of grains of `radius` in a tube, between a plate and a sheet whose rim is held.
fn bed(mesh: Mesh, contact: MembraneContact, radius: Real) -> Rig {
    let mut rig = rig(mesh, contact, 2e-6);
    let rim = rig.model.membrane.mesh.is_on_rim.clone();
    let holder = |is_on_rim| if is_on_rim { CARRIER_ID } else { FREE };
    rig.model.membrane.holders = rim.into_iter().map(holder).collect();
    let floor = if contact == SPHERES { SPHERE } else { 0.0 };
    let mut top = 0.0;
    for layer in 0..3 {
        let z = floor + radius * (1.02 + 1.66 * Real::from(layer));
        let shift = Vec3::new(1.0, 0.577, 0.0) * (radius * 1.01 * Real::from(layer % 2));
        top = z + 1.01 * radius;
        for (i, j) in (-12..=12).flat_map(|j| (-12..=12).map(move |i| (i, j))) {
            let (x, y) = (Real::from(i) + 0.5 * Real::from(j), 0.866 * Real::from(j));
            let place = Vec3::new(x, y, 0.0) * (2.02 * radius) + shift;
            if place.norm() + radius < TUBE {
                rig.add_grain(place + Vec3::z() * z, Vec3::zeros(), radius, MATERIAL.density);
            }
        }
    }
    let law = rig.model.walls[0].law;
    let down = WallShape::Plane { normal: -Vec3::z() };
    for (shape, height) in [(WallShape::Tube { radius: TUBE }, 0.0), (down, top)] {
        let motion = BodyMotion { pose: Pose::translation(0.0, 0.0, height), twist: Twist::zero() };
        rig.model.walls.push(WallModel::fixed(shape, law));
        rig.controls.walls.push(motion);
        rig.state.walls.push(motion);
    }
    rig.state.springs = Springs::none(rig.state.grains.len(), 0);
    rig.model.skin = 0.25 * radius;
    rig
}

/// Lets the air press the sheet on the grains, in 10 ms, and holds for 5 ms.
fn evacuate(mut rig: Rig) -> Result<Rig, Diverged> {
    for step in 0..7500 {
        rig.controls.gauge_setpoint = -PRESSURE * (Real::from(step) / 5000.0).min(1.0);
        rig.step();
        if step % 50 == 49 {
            health::check(&rig.state, &rig.scratch, 0)?;
        }
    }
    Ok(rig)
}

#[test]
fn a_bed_of_grains_of_a_fifth_stays_inside_at_100_kpa() {
    alone(|| {
        let radius = RADIUS / 5.0;
        for (name, mesh, contact) in [
            ("triangles", hexagon(2, EDGE), MembraneContact::Triangles),
            ("spheres", hexagon(6, SPACING), SPHERES),
        ] {
            let rig = evacuate(bed(mesh, contact, radius)).unwrap();
            let plate: Real = rig.scratch.wall_wrenches[2].force.z;
            let area = std::f64::consts::PI * TUBE * TUBE;
            eprintln!(
                "{} grains on {name}: plate {:.1} kPa",
                rig.state.grains.len(),
                plate / area / 1e3
            );
            // Oracle: the plate carries the air's load on the tube's cross-section, less what the
            // tube takes by friction (3 layers: some percent), and part of that on the sheet
            // between tube and rim.
            let patch: Real = rig.model.membrane.mesh.vertex_areas().iter().sum();
            let least = 0.95 * PRESSURE * area;
            assert!(plate > least && plate < PRESSURE * patch, "{plate} N, at least {least} N");
        }
    });
}

/// Load (N) under which one grain of `radius` comes through a held sheet at `place`.
fn breakthrough(
    mesh: Mesh,
    contact: MembraneContact,
    place: Vec3,
    radius: Real,
    most: Real,
) -> Real {
    let mut rig = rig(mesh, contact, 1e-6);
    let floor = if contact == SPHERES { SPHERE } else { 0.0 };
    rig.add_grain(place + Vec3::z() * (radius + floor), Vec3::zeros(), radius, MATERIAL.density);
    rig.model.membrane_law.friction = 0.0;
    rig.model.skin = 0.25 * radius;
    let n_steps = 60_000;
    for step in 0..n_steps {
        let load = most * Real::from(step) / Real::from(n_steps);
        rig.model.gravity = Vec3::z() * (-load / rig.state.grains.masses[0]);
        rig.step();
        if health::check(&rig.state, &rig.scratch, 0).is_err() {
            return load;
        }
    }
    Real::INFINITY
}

/// What three held spheres around a hollow bear without friction at most (N): the largest of
/// 3 F(ξ) cos θ over all heights of the grain.
fn strength(rig: &Rig, radius: Real) -> Real {
    let shared = radius * SPHERE / (radius + SPHERE);
    let constant = hertz_constant(&rig.model.membrane_law, shared);
    let away = SPACING / 3.0_f64.sqrt();
    (1..2000)
        .map(|k| {
            let height = (radius + SPHERE) * Real::from(k) / 2000.0;
            let distance = away.hypot(height);
            let overlap = (radius + SPHERE - distance).max(0.0);
            3.0 * constant * overlap.powf(1.5) * height / distance
        })
        .fold(0.0, Real::max)
}

#[test]
fn spheres_let_the_smaller_grains_through_sooner_and_triangles_do_not() {
    alone(|| {
        let hollow = Vec3::new(0.5, 0.75_f64.sqrt() / 3.0, 0.0) * SPACING;
        let face = Vec3::new(0.4, 0.25, 0.0) * EDGE;
        for share in [5.0, 10.0, 20.0] {
            let radius = RADIUS / share;
            // As a pressure on the square of sheet that a grain carries.
            let pressure = |load: Real| load / (4.0 * radius * radius);
            let triangles = rig(hexagon(2, EDGE), MembraneContact::Triangles, 1e-6);
            // Oracle: Hertz until the centre is in the sheet, F = 4/3 E* R², that is E*/3.
            let expected = 4.0 / 3.0 * triangles.model.membrane_law.modulus * radius * radius;
            let mesh = hexagon(2, EDGE);
            let measured =
                breakthrough(mesh, MembraneContact::Triangles, face, radius, 1.3 * expected);
            eprintln!(
                "1/{share}: triangles {:.0} kPa, closed form {:.0} kPa",
                pressure(measured) / 1e3,
                pressure(expected) / 1e3
            );
            // Tolerance 3 %: what the load grows while the grain swings after it.
            assert!((measured / expected - 1.0).abs() < 0.03, "{measured} N, not {expected} N");
            // Oracle: equilibrium of three Hertz contacts.
            let weakest = strength(&triangles, radius);
            let mesh = hexagon(3, SPACING);
            let through = breakthrough(mesh, SPHERES, hollow, radius, 1.3 * weakest);
            eprintln!(
                "1/{share}: spheres {:.0} kPa, closed form {:.0} kPa",
                pressure(through) / 1e3,
                pressure(weakest) / 1e3
            );
            assert!((through / weakest - 1.0).abs() < 0.03, "{through} N, not {weakest} N");
            assert!(through < 0.6 * measured, "spheres hold as well as triangles");
        }
        // Below s/√3 − r, a 25th of the usual size, nothing holds a grain at all.
        let none = rig(hexagon(3, SPACING), SPHERES, 1e-6);
        assert!(strength(&none, RADIUS / 25.0) < 1e-12);
    });
}

/// Oracle: the sign of the distance is that of the nearest point (Bærentzen & Aanæs 2005). A pleat lays
/// the sheet's outside behind its inside, well within a soft overlap.
#[test]
fn a_fold_behind_the_sheet_is_no_leak() {
    alone(|| {
        let radius = RADIUS;
        let sheet = |depth: Real| {
            let Mesh { positions, triangles, .. } = hexagon(2, EDGE);
            let lower = positions.iter().map(|it| it - Vec3::z() * depth).collect();
            Mesh::new(lower, triangles).unwrap()
        };
        let leaks = |mesh: Mesh| {
            let mut rig = rig(mesh, MembraneContact::Triangles, 1e-6);
            let place = Vec3::new(0.4 * EDGE, 0.25 * EDGE, 0.8 * radius);
            rig.add_grain(place, Vec3::zeros(), radius, MATERIAL.density);
            rig.step();
            assert_eq!(rig.scratch.patch_forces[0].n, 2, "both layers are within the overlap");
            health::check(&rig.state, &rig.scratch, 0).is_err()
        };
        let turned = |mesh: Mesh| mesh.inside_out().unwrap();
        assert!(!leaks(sheet(0.0).joined(&turned(sheet(0.1 * radius))).unwrap()));
        assert!(leaks(turned(sheet(0.0)).joined(&sheet(0.1 * radius)).unwrap()));
    });
}
