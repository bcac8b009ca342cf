//! The scene of the slide test, key by key.

use crate::{
    base::Real,
    physics::{law, membrane::MembraneMaterial},
    scene::{
        Material,
        quantity::{FORCE, IMPULSE, LENGTH, SPEED, TIME, TORQUE},
        schema,
        text::Keys,
        visit::{Quantity, Range, Visitor},
    },
};

/// All that the slide test is made of.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    pub(super) ball: Ball,
    pub(super) membrane: Membrane,
    /// Force that presses the ball down besides its weight (N).
    pub(super) load: Real,
    /// The same on a second run over triangles (N).
    pub(super) heavy_load: Real,
    pub(super) pull: Pull,
    /// Distance between two records (m).
    pub(super) record_every: Real,
    pub(super) hard: Hard,
    pub(super) frame: Frame,
}

#[derive(Clone, Debug)]
pub(super) struct Ball {
    /// (m)
    pub(super) radius: Real,
    pub(super) material: Material,
}

#[derive(Clone, Debug)]
pub(super) struct Membrane {
    /// Distance of neighbouring vertices (m).
    pub(super) edge: Real,
    /// Radius of the vertex spheres (m).
    pub(super) sphere_radius: Real,
    pub(super) material: Material,
    pub(super) surface: law::Surface,
    pub(super) sheet: MembraneMaterial,
}

/// How the ball is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    /// (m/s)
    pub(super) speed: Real,
    /// (m)
    pub(super) length: Real,
    /// (s)
    pub(super) substep: Real,
}

/// Contacts so stiff that only geometry counts.
#[derive(Clone, Debug)]
pub(super) struct Hard {
    /// Factor on the moduli of the contact.
    pub(super) stiffening: Real,
    pub(super) pull: Pull,
}

/// A sheet whose edge is held.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// Along and across (m).
    pub(super) size: Real,
    /// Strain of the sheet at rest.
    pub(super) stretch: Real,
    /// True if it is tried with triangles of half the size too.
    pub(super) is_refined: bool,
    /// Time before the ball is drawn (s).
    pub(super) settle: Real,
    /// (m)
    pub(super) length: Real,
}

impl Keys for Scene {
    fn walk(&mut self, walk: &mut impl Visitor) {
        let length = Quantity::above_zero(&LENGTH);
        walk.section("ball", |walk| {
            walk.quantity("radius", length, &mut self.ball.radius);
            schema::material(walk, &mut self.ball.material);
        });
        walk.section("membrane", |walk| membrane(walk, &mut self.membrane));
        walk.quantity("load", Quantity::above_zero(&FORCE), &mut self.load);
        walk.quantity("heavy_load", Quantity::above_zero(&FORCE), &mut self.heavy_load);
        pull(walk, &mut self.pull);
        walk.quantity("record_every", length, &mut self.record_every);
        walk.section("hard", |walk| {
            walk.number("stiffening", Range::Between(1.0, 1e6), &mut self.hard.stiffening);
            pull(walk, &mut self.hard.pull);
        });
        walk.section("frame", |walk| {
            walk.quantity("size", length, &mut self.frame.size);
            walk.number("stretch", Range::AboveUpTo(0.0, 0.5), &mut self.frame.stretch);
            walk.flag("refined", &mut self.frame.is_refined);
            walk.quantity("settle", Quantity::above_zero(&TIME), &mut self.frame.settle);
            walk.quantity("length", length, &mut self.frame.length);
        });
    }

    fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut unfit = Vec::new();
        let room = self.frame.size - 4.0 * self.ball.radius;
        if self.frame.length > room {
            let reason = format!("leaves the frame, which has room for {room} m");
            unfit.push(("frame.length", reason, "make it shorter, or frame.size larger"));
        }
        let periods = self.hard.pull.length / (3.0_f64.sqrt() * self.membrane.edge);
        if periods < 2.0 {
            let reason = "is less than two periods of the lattice".to_owned();
            unfit.push(("hard.length", reason, "take at least 3.5 edges of the membrane"));
        }
        if self.pull.length < 10.0 * self.membrane.edge {
            let reason = "is less than ten edges of the membrane".to_owned();
            unfit.push(("length", reason, "make it longer"));
        }
        unfit
    }
}

fn membrane(walk: &mut impl Visitor, it: &mut Membrane) {
    let length = Quantity::above_zero(&LENGTH);
    walk.quantity("edge", length, &mut it.edge);
    walk.quantity("sphere_radius", length, &mut it.sphere_radius);
    walk.quantity("thickness", length, &mut it.sheet.thickness);
    schema::material(walk, &mut it.material);
    walk.number("friction", Range::Above(0.0), &mut it.surface.friction);
    walk.number("spring_damping", Range::AtLeast(0.0), &mut it.sheet.spring_damping);
    let stiffness = Quantity::at_least_zero(&TORQUE);
    walk.quantity("bending_stiffness", stiffness, &mut it.sheet.bending_stiffness);
    let damping = Quantity::at_least_zero(&IMPULSE);
    walk.quantity("bending_damping", damping, &mut it.sheet.bending_damping);
    let time = Quantity::at_least_zero(&TIME);
    walk.quantity("dissipation_time", time, &mut it.surface.dissipation_time);
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut it.surface.tangential_damping);
    it.sheet.youngs_modulus = it.material.youngs_modulus;
    it.sheet.density = it.material.density;
}

fn pull(walk: &mut impl Visitor, it: &mut Pull) {
    walk.quantity("speed", Quantity::above_zero(&SPEED), &mut it.speed);
    walk.quantity("length", Quantity::above_zero(&LENGTH), &mut it.length);
    walk.quantity("substep", Quantity::above_zero(&TIME), &mut it.substep);
}

/// A scene before it is read.
pub(super) fn blank() -> Scene {
    let nan = Real::NAN;
    let material = Material { youngs_modulus: nan, poisson_ratio: nan, density: nan };
    let surface = law::Surface { friction: nan, dissipation_time: nan, tangential_damping: nan };
    let sheet = MembraneMaterial {
        thickness: nan,
        youngs_modulus: nan,
        density: nan,
        spring_damping: nan,
        bending_stiffness: nan,
        bending_damping: nan,
    };
    let pull = Pull { speed: nan, length: nan, substep: nan };
    Scene {
        ball: Ball { radius: nan, material },
        membrane: Membrane { edge: nan, sphere_radius: nan, material, surface, sheet },
        load: nan,
        heavy_load: nan,
        pull,
        record_every: nan,
        hard: Hard { stiffening: nan, pull },
        frame: Frame { size: nan, stretch: nan, is_refined: false, settle: nan, length: nan },
    }
}
