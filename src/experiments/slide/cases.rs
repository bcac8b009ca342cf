//! The cases: which ball is pulled over which membrane, and in which direction.

use super::scene::{Pull, SlideScene};
use crate::{
    base::{Real, Vec3},
    physics::law::PairLaw,
};

/// Gravity (m/s²).
pub(super) const GRAVITY: Real = 9.81;

/// One case.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    /// Name of the case.
    pub(super) name: &'static str,
    /// True if the ball touches spheres on the vertices instead of triangles.
    pub(super) has_spheres: bool,
    /// Direction in which the ball is pulled.
    pub(super) direction: Direction,
    /// Force that presses the ball down in addition to its weight (N).
    pub(super) load: Real,
    /// Factor on the moduli of the contact.
    pub(super) stiffening: Real,
    /// How the ball is pulled.
    pub(super) pull: Pull,
    /// True if only the edge of the membrane is held.
    pub(super) is_framed: bool,
    /// Distance between neighboring vertices (m).
    pub(super) edge: Real,
}

impl Case {
    /// Contact law between ball and membrane.
    pub(super) fn law(&self, scene: &SlideScene) -> PairLaw {
        let membrane = &scene.membrane;
        let surface = membrane.surface();
        let mut law = PairLaw::between(&scene.ball.material, &membrane.material, surface);
        law.modulus *= self.stiffening;
        law.shear_modulus *= self.stiffening;
        law
    }

    /// Load plus weight of the ball (N).
    pub(super) fn weight(&self, scene: &SlideScene) -> Real {
        self.load + mass(scene) * GRAVITY
    }

    /// One period of the lattice in the direction of the pull (m).
    pub(super) fn period(&self) -> Vec3 {
        self.direction.period(self.edge)
    }
}

/// Mass of the ball (kg).
pub(super) fn mass(scene: &SlideScene) -> Real {
    4.0 / 3.0 * std::f64::consts::PI * scene.ball.radius.powi(3) * scene.ball.material.density
}

/// A direction in which the lattice is periodic, as the steps i, j that make one period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Direction(pub(super) i32, pub(super) i32);

impl Direction {
    /// From vertex to vertex, along edges.
    pub(super) const ROWS: Self = Self(1, 0);
    /// Perpendicular to it: over a vertex, a hollow, an edge and another hollow.
    pub(super) const ACROSS: Self = Self(-1, 2);
    /// In between, at 19.1° to the rows.
    pub(super) const SKEW: Self = Self(2, 1);

    /// One period (m) on a lattice with this `edge` (m).
    pub(super) fn period(self, edge: Real) -> Vec3 {
        lattice_point((self.0, self.1), edge)
    }
}

/// Position of the vertex (i, j) of the triangular lattice (m).
///
/// ```text
/// i a + j b,   a = (s, 0),  b = (s/2, √3 s/2)
/// ```
pub(super) fn lattice_point((i, j): (i32, i32), edge: Real) -> Vec3 {
    let (i, j) = (Real::from(i), Real::from(j));
    Vec3::new(i + 0.5 * j, 0.75_f64.sqrt() * j, 0.0) * edge
}

/// All cases: both membranes along and across the rows and at an angle; a higher load; stiff
/// contacts; a membrane held at its edge.
pub(super) fn cases(scene: &SlideScene) -> Vec<Case> {
    let plain = Case {
        name: "triangles_rows",
        has_spheres: false,
        direction: Direction::ROWS,
        load: scene.load,
        stiffening: 1.0,
        pull: scene.pull,
        is_framed: false,
        edge: scene.membrane.edge,
    };
    let mut framed = Case { is_framed: true, ..plain };
    framed.pull.length = scene.frame.length;
    let hard = Case { stiffening: scene.hard.stiffening, pull: scene.hard.pull, ..plain };
    let (across, skew) = (Direction::ACROSS, Direction::SKEW);
    let mut cases = vec![
        plain,
        Case { name: "triangles_across", direction: across, ..plain },
        Case { name: "triangles_skew", direction: skew, ..plain },
        Case { name: "triangles_heavy", load: scene.heavy_load, ..plain },
        Case { name: "spheres_rows", has_spheres: true, ..plain },
        Case { name: "spheres_across", has_spheres: true, direction: across, ..plain },
        Case { name: "spheres_skew", has_spheres: true, direction: skew, ..plain },
        Case { name: "hard_spheres_rows", has_spheres: true, ..hard },
        Case { name: "hard_spheres_across", has_spheres: true, direction: across, ..hard },
        Case { name: "triangles_framed", ..framed },
        Case { name: "spheres_framed", has_spheres: true, ..framed },
    ];
    if scene.frame.is_refined {
        let edge = scene.membrane.edge / 2.0;
        cases.push(Case { name: "small_triangles_framed", edge, ..framed });
    }
    cases
}
