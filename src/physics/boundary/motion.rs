//! Prescribed motion of walls, as data.
//!
//! ```text
//! once per substep, from t to t + dt:
//!   v = (x(t + dt) − x(t))/dt,   ω dt = the rotation from t to t + dt
//!   x ← x + v dt,                q ← exp(ω dt) q
//!
//! sinusoid   x(t) = x(0) + a A (sin(2π f t + φ) − sin φ)
//! hinge      x(t) = c + R(a, θ(t)) (x(0) − c),   q(t) = R(a, θ(t)) q(0)
//! servo      v = a · clamp(g (target − load)/full scale, ±v_max)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | x, q | position of the wall's origin and its orientation | m, – |
//! | v, ω | velocity of the origin and angular velocity | m/s, rad/s |
//! | a | unit vector: direction of the sinusoid, axis of the hinge, driving direction of the servo | – |
//! | A, f, φ | amplitude, frequency, phase | m, Hz, rad |
//! | c, θ | a point on the hinge's axis, angle | m, rad |
//!
//! Only `System::step` evaluates motions. The velocity is the mean over the substep, so position
//! and velocity stay consistent: sinusoids and hinges follow their closed forms up to rounding.
//! Vertices held by a wall take its pose at the end of the substep and its velocity during it.
//! Contacts of grains are evaluated at the start of the substep, with the pose at the end of the
//! last substep and the velocity during it.
//!
//! Time starts when a wall is given its motion. Time and the load of a servo are part of the state, but only in
//! systems with a wall that needs them.

use std::f64::consts::TAU;

use crate::base::{Pose, Quat, Real, Vec3, real::Twist};

/// How a wall moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum WallMotion {
    /// Does not move.
    #[default]
    Fixed,
    /// Moved by the owner of the system, which writes the velocity, and the pose if it jumps, into
    /// `Controls::walls` before each substep. `System::step` advances the pose.
    External,
    /// Moves at a constant velocity.
    Velocity(Twist),
    /// Oscillates along a line.
    Sinusoid {
        /// Direction, a unit vector in world axes.
        axis: Vec3,
        /// Amplitude (m).
        amplitude: Real,
        /// Frequency (Hz).
        frequency: Real,
        /// Phase at the start (rad).
        phase: Real,
    },
    /// Moves so that its load approaches a target.
    Servo(Servo),
    /// Rotates about a fixed axis.
    Hinge(Hinge),
}

/// A wall that moves until its load equals the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servo {
    /// Direction in which the wall presses, a unit vector in world axes.
    pub axis: Vec3,
    /// The controlled load.
    pub load: Load,
    /// Target of the load (N) or (Pa).
    pub target: Real,
    /// Deviation from the target at which the wall moves at the speed `gain` (N) or (Pa).
    pub full_scale: Real,
    /// Speed at a deviation of `full_scale` (m/s).
    pub gain: Real,
    /// Largest speed (m/s).
    pub speed_max: Real,
}

/// The load that a servo controls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// The force on the wall, against the servo's axis (N).
    Force,
    /// That force divided by an area (Pa).
    Pressure {
        /// The area (m²).
        area: Real,
    },
}

/// A wall that rotates about a fixed axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hinge {
    /// A point on the axis (m), world frame.
    pub point: Vec3,
    /// Direction of the axis, a unit vector in world axes. Rotation is right-handed.
    pub axis: Vec3,
    /// Angle as a function of time.
    pub turn: Turn,
}

/// Angle of a hinge as a function of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// Constant angular velocity.
    Steady {
        /// Angular velocity (rad/s).
        rate: Real,
    },
    /// Constant angular velocity until an angle is reached.
    To {
        /// Final angle (rad).
        angle: Real,
        /// Magnitude of the angular velocity (rad/s).
        rate: Real,
    },
    /// Oscillation: θ = A (sin(2π f t + φ) − sin φ).
    Swing {
        /// Amplitude A (rad).
        amplitude: Real,
        /// Frequency f (Hz).
        frequency: Real,
        /// Phase at the start φ (rad).
        phase: Real,
    },
}

/// State of a wall's motion, needed to continue it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WallMemory {
    /// Time since the motion started (s).
    pub time: Real,
    /// Force on the wall against its servo's axis in the last substep (N); 0 without a servo.
    pub force: Real,
}

/// An invalid parameter of a motion.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{what} is {value:e}; it must be {limit}")]
pub struct MotionError {
    /// The parameter, with its unit.
    pub what: &'static str,
    /// Its value.
    pub value: Real,
    /// Valid values.
    pub limit: &'static str,
}

impl WallMotion {
    /// True if continuing the motion needs time or load.
    pub fn needs_memory(&self) -> bool {
        matches!(self, Self::Sinusoid { .. } | Self::Servo(_) | Self::Hinge(_))
    }

    /// Mean velocity over the next `dt` (s) of a wall at `pose`; `None` for `External`.
    pub fn twist(&self, pose: &Pose, memory: &WallMemory, dt: Real) -> Option<Twist> {
        let time = memory.time;
        Some(match self {
            Self::External => return None,
            Self::Fixed => Twist::zero(),
            Self::Velocity(twist) => *twist,
            Self::Sinusoid { axis, amplitude, frequency, phase } => {
                let at = |time: Real| amplitude * (TAU * frequency * time + phase).sin();
                along(axis, (at(time + dt) - at(time)) / dt)
            }
            Self::Servo(servo) => along(&servo.axis, servo.speed(memory.force)),
            Self::Hinge(hinge) => hinge.twist(pose, time, dt),
        })
    }

    /// Checks all parameters.
    ///
    /// # Errors
    /// The first parameter that is not finite, not positive where it must be, or not a unit vector.
    pub fn check(&self) -> Result<(), MotionError> {
        match self {
            Self::Fixed | Self::External => Ok(()),
            Self::Velocity(twist) => twist
                .linear
                .iter()
                .chain(&twist.angular)
                .try_for_each(|value| finite("velocity (m/s) or (rad/s)", *value)),
            Self::Sinusoid { axis, amplitude, frequency, phase } => {
                unit(axis)?;
                oscillation(*amplitude, *frequency, *phase)
            }
            Self::Servo(servo) => servo.check(),
            Self::Hinge(hinge) => hinge.check(),
        }
    }
}

impl Servo {
    /// Speed along the axis (m/s) while `force` (N) acts on the wall, against the axis.
    pub fn speed(&self, force: Real) -> Real {
        let load = match self.load {
            Load::Force => force,
            Load::Pressure { area } => force / area,
        };
        let deviation = (self.target - load) / self.full_scale;
        (self.gain * deviation).clamp(-self.speed_max, self.speed_max)
    }

    fn check(&self) -> Result<(), MotionError> {
        unit(&self.axis)?;
        finite("target of the servo (N) or (Pa)", self.target)?;
        positive("full scale of the servo (N) or (Pa)", self.full_scale)?;
        positive("gain of the servo (m/s)", self.gain)?;
        positive("largest speed of the servo (m/s)", self.speed_max)?;
        match self.load {
            Load::Force => Ok(()),
            Load::Pressure { area } => positive("area of the servo (m²)", area),
        }
    }
}

impl Hinge {
    fn twist(&self, pose: &Pose, time: Real, dt: Real) -> Twist {
        let rotation = self.turn.angle(time + dt) - self.turn.angle(time);
        let arm = pose.translation.vector - self.point;
        // The chord, not the tangent: along the tangent the wall would leave its circle.
        let chord = Quat::from_scaled_axis(self.axis * rotation) * arm - arm;
        Twist { linear: chord / dt, angular: self.axis * (rotation / dt) }
    }

    fn check(&self) -> Result<(), MotionError> {
        unit(&self.axis)?;
        self.point.iter().try_for_each(|value| finite("point of the hinge (m)", *value))?;
        match self.turn {
            Turn::Steady { rate } => finite("rate of the hinge (rad/s)", rate),
            Turn::To { angle, rate } => {
                finite("final angle of the hinge (rad)", angle)?;
                positive("rate of the hinge (rad/s)", rate)
            }
            Turn::Swing { amplitude, frequency, phase } => oscillation(amplitude, frequency, phase),
        }
    }
}

impl Turn {
    /// Angle (rad) at `time` (s); 0 at the start.
    pub fn angle(&self, time: Real) -> Real {
        match *self {
            Self::Steady { rate } => rate * time,
            Self::To { angle, rate } => angle.signum() * (rate * time).min(angle.abs()),
            Self::Swing { amplitude, frequency, phase } => {
                amplitude * ((TAU * frequency * time + phase).sin() - phase.sin())
            }
        }
    }
}

/// Translation along `axis` at `speed` (m/s). Zero components are positive zeros.
fn along(axis: &Vec3, speed: Real) -> Twist {
    Twist { linear: axis.map(|component| component * speed + 0.0), angular: Vec3::zeros() }
}

fn oscillation(amplitude: Real, frequency: Real, phase: Real) -> Result<(), MotionError> {
    finite("amplitude (m) or (rad)", amplitude)?;
    positive("frequency (Hz)", frequency)?;
    finite("phase (rad)", phase)
}

fn finite(what: &'static str, value: Real) -> Result<(), MotionError> {
    if value.is_finite() { Ok(()) } else { Err(MotionError { what, value, limit: "finite" }) }
}

fn positive(what: &'static str, value: Real) -> Result<(), MotionError> {
    let is_good = value.is_finite() && value > 0.0;
    if is_good { Ok(()) } else { Err(MotionError { what, value, limit: "positive and finite" }) }
}

fn unit(axis: &Vec3) -> Result<(), MotionError> {
    let value = axis.norm();
    let is_unit = (value - 1.0).abs() < 1e-9;
    if is_unit {
        Ok(())
    } else {
        Err(MotionError { what: "length of the axis", value, limit: "1" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::boundary::body::BodyMotion;

    /// Moves a wall for `n` substeps of `dt` (s) and calls `inspect` after each, with time and motion.
    fn run(
        motion: WallMotion,
        start: Pose,
        (n, dt): (usize, Real),
        mut inspect: impl FnMut(Real, &BodyMotion),
    ) {
        let mut wall = BodyMotion { pose: start, twist: Twist::zero() };
        let mut memory = WallMemory::default();
        for _ in 0..n {
            wall.twist = motion.twist(&wall.pose, &memory, dt).unwrap();
            wall.advance(dt);
            memory.time += dt;
            inspect(memory.time, &wall);
        }
    }

    /// Oracle: the formula at the top of the file, for an oblique axis and a phase. Tolerance: rounding,
    /// 1e-13 of the amplitude per thousand substeps.
    #[test]
    fn a_sinusoid_follows_its_closed_form() {
        let (amplitude, frequency, phase) = (2e-3, 50.0, 0.7);
        let axis = Vec3::new(1.0, -2.0, 2.0) / 3.0;
        let motion = WallMotion::Sinusoid { axis, amplitude, frequency, phase };
        assert_eq!(motion.check(), Ok(()));
        let start = Pose::translation(0.1, 0.2, -0.3);
        let (n, dt) = (4000, 1.0 / frequency / 4000.0);
        let mut last = start.translation.vector;
        run(motion, start, (n, dt), |time, wall| {
            let displacement = amplitude * ((TAU * frequency * time + phase).sin() - phase.sin());
            let expected = start.translation.vector + axis * displacement;
            let position = wall.pose.translation.vector;
            assert!((position - expected).norm() < 1e-12 * amplitude, "at {time} s");
            // The velocity is the mean over the substep: the derivative at its middle, with a relative error of
            // (2π f dt)²/24.
            let middle = TAU * frequency * (time - 0.5 * dt) + phase;
            let speed = amplitude * TAU * frequency * middle.cos();
            let error = (wall.twist.linear - axis * speed).norm();
            assert!(error < 2e-7 * amplitude * TAU * frequency, "{error}");
            last = position;
        });
        assert!((last - start.translation.vector).norm() < 1e-12 * amplitude);
    }

    /// Oracle: a rotation preserves distances from its axis; the angle is the rate times the time.
    /// Tolerance: rounding of 10⁴ rotations, 1e-12.
    #[test]
    fn a_hinged_wall_keeps_its_distance_from_the_axis() {
        let point = Vec3::new(0.1, 0.0, 0.05);
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let start = Pose::new(Vec3::new(0.3, 0.1, -0.2), Vec3::new(0.2, -0.4, 0.1));
        let distance = |position: Vec3| (position - point).cross(&axis).norm();
        let swing = Turn::Swing { amplitude: 0.4, frequency: 2.0, phase: 0.3 };
        for turn in [Turn::Steady { rate: -3.0 }, Turn::To { angle: 1.2, rate: 2.0 }, swing] {
            let motion = WallMotion::Hinge(Hinge { point, axis, turn });
            assert_eq!(motion.check(), Ok(()));
            run(motion, start, (10_000, 1e-4), |time, wall| {
                let position = wall.pose.translation.vector;
                assert!((distance(position) - distance(start.translation.vector)).abs() < 1e-12);
                let rotation = Quat::from_scaled_axis(axis * turn.angle(time));
                let expected = point + rotation * (start.translation.vector - point);
                assert!((position - expected).norm() < 1e-12, "{turn:?} at {time} s");
                let rotated = wall.pose.rotation * start.rotation.inverse();
                assert!(rotated.angle_to(&rotation) < 1e-7, "{turn:?} at {time} s");
            });
        }
        // Oracle: it stops at its final angle, in both directions.
        for angle in [1.2, -1.2] {
            let turn = Turn::To { angle, rate: 2.0 };
            assert!((turn.angle(0.3) - 0.6 * angle.signum()).abs() < 1e-15);
            assert_eq!(turn.angle(5.0).to_bits(), angle.to_bits());
        }
    }

    /// Oracle: the equation of a spring. The force approaches the target at the rate g k/F_0, and is within
    /// e⁻²⁰ of it after twenty time constants.
    #[test]
    fn a_servo_on_a_spring_reaches_its_target() {
        let (stiffness, target, gain, dt) = (1e4, 5.0, 1e-3, 1e-4);
        for (load, area) in [(Load::Force, 1.0), (Load::Pressure { area: 0.02 }, 0.02)] {
            let servo = Servo {
                axis: -Vec3::z(),
                load,
                target: target / area,
                full_scale: target / area,
                gain,
                speed_max: 5e-4,
            };
            let motion = WallMotion::Servo(servo);
            assert_eq!(motion.check(), Ok(()));
            let mut wall = BodyMotion { pose: Pose::identity(), twist: Twist::zero() };
            let mut memory = WallMemory::default();
            // Twenty time constants of F_0/(g k) = 0.5 s: ten seconds.
            for _ in 0..100_000 {
                wall.twist = motion.twist(&wall.pose, &memory, dt).unwrap();
                assert!(wall.twist.linear.norm() <= servo.speed_max);
                wall.advance(dt);
                memory.force = (stiffness * -wall.pose.translation.z).max(0.0);
            }
            assert!((memory.force / target - 1.0).abs() < 1e-7, "{}", memory.force);
            assert!(wall.twist.linear.norm() < 1e-10);
        }
    }

    #[test]
    fn invalid_parameters_are_named() {
        let sinusoid =
            |axis, frequency| WallMotion::Sinusoid { axis, amplitude: 1e-3, frequency, phase: 0.0 };
        // Oracle: the one invalid parameter of each motion.
        let of = |motion: WallMotion| motion.check().unwrap_err().what;
        assert_eq!(of(sinusoid(Vec3::new(1.0, 1.0, 0.0), 1.0)), "length of the axis");
        assert_eq!(of(sinusoid(Vec3::x(), 0.0)), "frequency (Hz)");
        let twist = Twist { linear: Vec3::x() * Real::NAN, angular: Vec3::zeros() };
        assert_eq!(of(WallMotion::Velocity(twist)), "velocity (m/s) or (rad/s)");
    }
}
