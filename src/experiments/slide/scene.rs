//! The scene of the slide test, key by key.

use crate::{
    base::Real,
    physics::{law, membrane::MembraneMaterial},
    scene::{
        Material,
        keys::{Flag, Inline, Map, scene_keys},
        quantity::{FORCE, IMPULSE, LENGTH, SPEED, TIME, TORQUE},
        text::Keys,
        visit::{Quantity, Range},
    },
};

/// A positive length.
const SOME_LENGTH: Quantity = Quantity::above_zero(&LENGTH);

scene_keys! {
    /// The whole scene.
    pub(super) struct SlideScene {
        /// The ball that is pulled.
        ball: Ball = Map,
        /// The membrane it slides on.
        membrane: Membrane = Map,
        /// Force that presses the ball down in addition to its weight (N).
        load: Real = Quantity::above_zero(&FORCE),
        /// The same in a second run over triangles (N).
        heavy_load: Real = Quantity::above_zero(&FORCE),
        /// How the ball is pulled.
        pull: Pull = Inline,
        /// Distance between two recorded rows (m).
        record_every: Real = SOME_LENGTH,
        /// Contacts so stiff that only geometry matters.
        hard: Hard = Map,
        /// A membrane that is held at its edge only.
        frame: Frame = Map,
    }

    /// The ball.
    pub(super) struct Ball {
        /// Radius (m).
        radius: Real = SOME_LENGTH,
        /// Its material.
        material: Material = Inline,
    }

    /// The membrane and its contact with the ball.
    pub(super) struct Membrane {
        /// Distance between neighboring vertices (m).
        edge: Real = SOME_LENGTH,
        /// Radius of the spheres on the vertices (m).
        sphere_radius: Real = SOME_LENGTH,
        /// Thickness (m).
        thickness: Real = SOME_LENGTH,
        /// Its material.
        material: Material = Inline,
        /// Coulomb friction with the ball.
        friction: Real = Range::Above(0.0),
        /// Damping ratio of the springs.
        spring_damping: Real = Range::AtLeast(0.0),
        /// Elastic constant of the hinges (N m).
        bending_stiffness: Real = Quantity::at_least_zero(&TORQUE),
        /// Damping constant of the hinges (N s).
        bending_damping: Real = Quantity::at_least_zero(&IMPULSE),
        /// Dissipation time of the contact (s).
        dissipation_time: Real = Quantity::at_least_zero(&TIME),
        /// Damping of the tangential spring of the contact.
        tangential_damping: Real = Range::AtLeast(0.0),
    }

    /// How the ball is pulled.
    #[derive(Copy)]
    pub(super) struct Pull {
        /// Speed (m/s).
        speed: Real = Quantity::above_zero(&SPEED),
        /// Distance (m).
        length: Real = SOME_LENGTH,
        /// Substep (s).
        substep: Real = Quantity::above_zero(&TIME),
    }

    /// Contacts so stiff that only geometry matters.
    pub(super) struct Hard {
        /// Factor on the moduli of the contact.
        stiffening: Real = Range::Between(1.0, 1e6),
        /// How the ball is pulled.
        pull: Pull = Inline,
    }

    /// A membrane that is held at its edge only.
    pub(super) struct Frame {
        /// Edge length of the square frame (m).
        size: Real = SOME_LENGTH,
        /// Strain of the membrane at rest.
        stretch: Real = Range::AboveUpTo(0.0, 0.5),
        /// True adds a case with triangles of half the size.
        is_refined ("refined"): bool = Flag,
        /// Time before the ball is pulled (s).
        settle: Real = Quantity::above_zero(&TIME),
        /// Distance over which it is pulled (m).
        length: Real = SOME_LENGTH,
    }
}

impl Membrane {
    /// Friction and damping of the contact with the ball.
    pub(super) fn surface(&self) -> law::Surface {
        let Self { friction, dissipation_time, tangential_damping, .. } = *self;
        law::Surface { friction, dissipation_time, tangential_damping }
    }

    /// Springs and hinges.
    pub(super) fn material(&self) -> MembraneMaterial {
        MembraneMaterial {
            thickness: self.thickness,
            youngs_modulus: self.material.youngs_modulus,
            density: self.material.density,
            spring_damping: self.spring_damping,
            bending_stiffness: self.bending_stiffness,
            bending_damping: self.bending_damping,
        }
    }
}

impl Keys for SlideScene {
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
