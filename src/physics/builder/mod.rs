//! Builds systems from parts: grains, walls, membranes, bodies, gravity, air.

mod error;
mod membrane;
#[cfg(test)]
mod tests;
mod wall;

use std::ops::Range;

pub use error::BuildError;
pub use membrane::{Membrane, Vertices};
pub use wall::{Wall, WallId};

use super::{
    Controls, Model, State, System,
    boundary::{
        body::BodyMotion,
        wall::{WallModel, WallShape},
    },
    critical_step::{critical_step, stiffness_at_vertex},
    law::{PairLaw, Surface},
    membrane::{FREE, MembraneModel},
    model::{BodyModel, ChamberModel},
    packing::sphere_volume,
    state::Grains,
};
use crate::{
    base::{Pose, Real, Vec3, real::Twist},
    scene::Material,
};

/// Default skin of the neighbor lists, as a fraction of the largest radius.
const SKIN_SHARE: Real = 0.25;
/// Largest deviation of the length of a unit vector from 1.
const UNIT_TOLERANCE: Real = 1e-9;

/// Builds a system from parts and checks that they are consistent.
///
/// Two grains that fall on a ramp of triangles in a box with a shaken floor:
///
/// ```
/// use jamgrip::{
///     base::Vec3,
///     physics::{
///         SystemBuilder,
///         boundary::{motion::WallMotion, triangles::Triangles},
///         builder::Wall, law::Surface,
///     },
///     scene::Material,
/// };
///
/// let glass = Material { youngs_modulus: 1e7, poisson_ratio: 0.25, density: 2500.0 };
/// let surface = Surface { friction: 0.5, dissipation_time: 3e-5, tangential_damping: 0.3 };
/// let mut builder = SystemBuilder::of_material(&glass, surface);
/// builder.gravity(Vec3::new(0.0, 0.0, -9.81)).substep_of_critical(0.5);
/// builder.grain(Vec3::new(0.0, 0.0, 5e-3), 2e-3);
/// builder.grain(Vec3::new(0.5e-3, 0.0, 10e-3), 2e-3);
/// let [left, right, front, back, floor, _] =
///     Wall::sides(Vec3::new(-0.01, -0.01, 0.0), Vec3::new(0.01, 0.01, 0.05));
/// let shaken = WallMotion::Sinusoid {
///     axis: Vec3::z(), amplitude: 0.2e-3, frequency: 30.0, phase: 0.0,
/// };
/// builder.walls([floor.moving(shaken), left, right, front, back]);
/// let (low, high) = (Vec3::new(-0.01, -0.01, 0.0), Vec3::new(0.01, 0.01, 2e-3));
/// let corners = vec![low, Vec3::new(0.01, -0.01, 0.0), Vec3::new(-0.01, 0.01, 2e-3), high];
/// let ramp = Triangles::new(corners, vec![[0, 1, 2], [1, 3, 2]])?;
/// builder.wall(Wall::triangles(ramp));
/// let mut system = builder.build()?;
/// for _ in 0..1000 {
///     system.step();
/// }
/// assert!(system.state.grains.positions.iter().all(|p| p.z > 1e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// The first wall is the carrier, the frame of reference of the system (`boundary::wall::CARRIER`). If there is a
/// moving container, add it first.
///
/// No threads are started. To use several, step the system as the leader of a team:
/// `parallel::lead(&pool, || system.step())`.
#[derive(Clone, Debug)]
pub struct SystemBuilder {
    grain_law: PairLaw,
    wall_law: PairLaw,
    membrane_law: PairLaw,
    material: Option<Material>,
    gravity: Vec3,
    density_scaling: Real,
    period: Option<Vec3>,
    substep: Substep,
    skin: Option<Real>,
    /// Largest and mean radius of grains that grow or are added later.
    radii: Option<[Real; 2]>,
    chamber: ChamberModel,
    table: Pose,
    pressure_max: Real,
    grains: Grains,
    walls: Vec<Wall>,
    membranes: Vec<Membrane>,
    bodies: Vec<BodyModel>,
    motions: Vec<BodyMotion>,
}

/// How the length of a substep is determined.
#[derive(Clone, Copy, Debug)]
enum Substep {
    Unknown,
    Given(Real),
    OfCritical(Real),
}

impl SystemBuilder {
    /// An empty system. All contacts of grains use `law` unless others are set.
    pub fn new(law: PairLaw) -> Self {
        Self {
            grain_law: law,
            wall_law: law,
            membrane_law: law,
            material: None,
            gravity: Vec3::zeros(),
            density_scaling: 1.0,
            period: None,
            substep: Substep::Unknown,
            skin: None,
            radii: None,
            chamber: ChamberModel { lag_factor: 0.0, change_max: Real::INFINITY },
            table: Pose::identity(),
            pressure_max: 0.0,
            grains: Grains::default(),
            walls: Vec::new(),
            membranes: Vec::new(),
            bodies: Vec::new(),
            motions: Vec::new(),
        }
    }

    /// An empty system with grains of one material and rigid walls.
    pub fn of_material(material: &Material, surface: Surface) -> Self {
        let mut builder = Self::new(PairLaw::between(material, material, surface));
        builder.wall_law = PairLaw::against_rigid(material, surface);
        builder.material = Some(*material);
        builder
    }

    /// Sets gravity (m/s²), world axes. The default is zero.
    pub fn gravity(&mut self, gravity: Vec3) -> &mut Self {
        self.gravity = gravity;
        self
    }

    /// Sets the ratio of the inertia of grains and membranes to their real inertia. The default is 1. Masses, damping
    /// and gravity must already include the ratio.
    pub fn density_scaling(&mut self, factor: Real) -> &mut Self {
        self.density_scaling = factor;
        self
    }

    /// Makes the system periodic, with a box of these edges (m) from the origin. Only for systems of grains.
    pub fn period(&mut self, period: Vec3) -> &mut Self {
        self.period = Some(period);
        self
    }

    /// Sets the length of a substep (s).
    pub fn substep(&mut self, substep: Real) -> &mut Self {
        self.substep = Substep::Given(substep);
        self
    }

    /// Sets the length of a substep to this fraction of the critical step. Requires `of_material`.
    pub fn substep_of_critical(&mut self, share: Real) -> &mut Self {
        self.substep = Substep::OfCritical(share);
        self
    }

    /// Sets the largest pressure of a membrane on the grains (Pa), for `substep_of_critical`.
    pub fn pressure_max(&mut self, pressure: Real) -> &mut Self {
        self.pressure_max = pressure;
        self
    }

    /// Sets the skin (m), the distance beyond contact within which pairs are listed. Results do not depend on it. The
    /// default is a quarter of the largest radius.
    pub fn skin(&mut self, skin: Real) -> &mut Self {
        self.skin = Some(skin);
        self
    }

    /// Sets the largest and the mean radius of grains (m), if they grow or are added later.
    pub fn radii_up_to(&mut self, largest: Real, mean: Real) -> &mut Self {
        self.radii = Some([largest, mean]);
        self
    }

    /// Sets the contact law between grains and walls without their own law.
    pub fn wall_law(&mut self, law: PairLaw) -> &mut Self {
        self.wall_law = law;
        self
    }

    /// Sets the contact law between grains and membranes.
    pub fn membrane_law(&mut self, law: PairLaw) -> &mut Self {
        self.membrane_law = law;
        self
    }

    /// Sets pump and line of the air inside the membranes. The default has no lag and no limit.
    pub fn chamber(&mut self, chamber: ChamberModel) -> &mut Self {
        self.chamber = chamber;
        self
    }

    /// Sets the pose of the table; its surface is z = 0 of this frame.
    pub fn table(&mut self, pose: Pose) -> &mut Self {
        self.table = pose;
        self
    }

    /// Adds a grain of the builder's material at rest, at `position` (m) with `radius` (m).
    ///
    /// Without a material (`new`) its mass is unknown, and `build` returns an error.
    pub fn grain(&mut self, position: Vec3, radius: Real) -> &mut Self {
        let density = self.material.map_or(Real::NAN, |it| it.density);
        let mass = density * self.density_scaling * sphere_volume(radius);
        self.grains(Grains::at_rest(vec![position], vec![radius], vec![mass]))
    }

    /// Adds grains.
    pub fn grains(&mut self, grains: Grains) -> &mut Self {
        let all = &mut self.grains;
        all.positions.extend(grains.positions);
        all.velocities.extend(grains.velocities);
        all.angular_velocities.extend(grains.angular_velocities);
        all.radii.extend(grains.radii);
        all.masses.extend(grains.masses);
        self
    }

    /// Adds a wall; the first is the carrier.
    pub fn wall(&mut self, wall: Wall) -> WallId {
        self.walls.push(wall);
        WallId(u32::try_from(self.walls.len() - 1).expect("a system has few walls"))
    }

    /// Adds walls.
    pub fn walls(&mut self, walls: impl IntoIterator<Item = Wall>) -> &mut Self {
        self.walls.extend(walls);
        self
    }

    /// Adds a membrane. Returns the indices of its vertices in the system, in which the vertices and facets of all
    /// membranes are concatenated.
    pub fn membrane(&mut self, membrane: Membrane) -> Range<usize> {
        let first: usize = self.membranes.iter().map(|it| it.positions.len()).sum();
        let vertices = first..first + membrane.positions.len();
        self.membranes.push(membrane);
        vertices
    }

    /// Adds a rigid body that membranes touch, and also grains after `BodyModel::touches_grains`.
    pub fn body(&mut self, body: BodyModel, motion: BodyMotion) -> &mut Self {
        self.bodies.push(body);
        self.motions.push(motion);
        self
    }

    /// Builds the system, at rest.
    ///
    /// # Errors
    /// If a part is missing or invalid, or parts are inconsistent.
    pub fn build(mut self) -> Result<System, BuildError> {
        self.check_grains()?;
        let grains = std::mem::take(&mut self.grains);
        let largest = grains.radii.iter().copied().fold(0.0, Real::max);
        let radii = match self.radii {
            Some([limit, _]) if limit < largest => {
                let grain = grains.radii.iter().position(|r| limit < *r).unwrap_or(0);
                return Err(BuildError::Radius { grain, radius: largest, limit });
            }
            Some(radii) => radii,
            None => [largest, grains.mean_radius()],
        };
        let smallest = grains.radii.iter().copied().fold(Real::INFINITY, Real::min);
        let walls: Vec<BodyMotion> = self
            .walls
            .iter()
            .map(|it| BodyMotion { pose: it.pose, twist: Twist::zero() })
            .collect();
        let bodies = std::mem::take(&mut self.motions);
        let positions: Vec<Vec3> =
            self.membranes.iter().flat_map(|it| it.positions.iter().copied()).collect();
        let model = self.assemble(radii, smallest)?;
        let mut state = State::at_rest(&model, walls.clone(), grains);
        state.membrane.positions = positions;
        let controls = Controls { gauge_setpoint: 0.0, walls, bodies };
        Ok(System::new(model, controls, state))
    }

    /// Builds only the model, for grains that are added later. Requires `radii_up_to`.
    ///
    /// # Errors
    /// If a part is missing or invalid, or parts are inconsistent.
    pub fn build_model(self) -> Result<Model, BuildError> {
        let [largest, mean] = self.radii.unwrap_or([0.0; 2]);
        positive(|| "largest radius (m) of grains, see `radii_up_to`".to_owned(), largest)?;
        self.assemble([largest, mean], largest)
    }

    fn assemble(mut self, [largest, mean]: [Real; 2], smallest: Real) -> Result<Model, BuildError> {
        let skin = self.skin.unwrap_or(SKIN_SHARE * largest);
        self.check_period(2.0 * largest + self.grain_law.range() + skin)?;
        let (membrane, held_positions) = self.join_membranes()?;
        self.check_walls(largest, &membrane)?;
        let substep = self.find_substep([smallest, largest], &membrane)?;
        finite(|| "gravity (m/s²)".to_owned(), &self.gravity)?;
        let wall_law = self.wall_law;
        let wall = |it: Wall| WallModel {
            law: it.law.unwrap_or(wall_law),
            shape: it.shape,
            motion: it.motion,
        };
        Ok(Model {
            density_scaling: self.density_scaling,
            gravity: self.gravity,
            substep,
            radius_max: largest,
            radius_mean: mean,
            skin,
            period: self.period,
            grain_law: self.grain_law,
            membrane_law: self.membrane_law,
            membrane,
            held_positions,
            walls: self.walls.into_iter().map(wall).collect(),
            chamber: self.chamber,
            table: self.table,
            bodies: self.bodies,
        })
    }

    /// Joins all membranes. Also returns the positions of held vertices in the frames of their walls (m).
    fn join_membranes(&mut self) -> Result<(MembraneModel, Vec<Vec3>), BuildError> {
        let mut joined: Option<MembraneModel> = None;
        let mut held_positions = Vec::new();
        for (k, mut membrane) in std::mem::take(&mut self.membranes).into_iter().enumerate() {
            membrane.find_holders(k, self.walls.len())?;
            let frames: Vec<Pose> = self.walls.iter().map(|it| it.pose.inverse()).collect();
            for (position, &holder) in membrane.positions.iter().zip(&membrane.model.holders) {
                finite(|| format!("position (m) of a vertex of membrane {k}"), position)?;
                // The carrier may hold vertices later that are free now.
                let wall = if holder == FREE { WallId::CARRIER.holder() } else { holder };
                let in_frame = |frame: &Pose| frame.rotation * position + frame.translation.vector;
                held_positions.push(frames.get(wall as usize).map_or(*position, in_frame));
            }
            let model = membrane.model;
            joined = Some(match joined {
                None => model,
                Some(first) => {
                    let differ = |what| Err(BuildError::MembranesDiffer { membrane: k, what });
                    if first.contact != model.contact {
                        return differ("the contact geometry for grains");
                    }
                    if first.bends_by_first_areas() != model.bends_by_first_areas() {
                        return differ("the use of reference areas by hinges");
                    }
                    first.joined(&model).map_err(|error| BuildError::Mesh { membrane: k, error })?
                }
            });
        }
        Ok((joined.unwrap_or_else(MembraneModel::none), held_positions))
    }

    fn check_grains(&self) -> Result<(), BuildError> {
        let Grains { positions, velocities, angular_velocities, radii, masses } = &self.grains;
        let expected = positions.len();
        for (place, found) in [
            ("velocities of grains", velocities.len()),
            ("angular velocities of grains", angular_velocities.len()),
            ("radii of grains", radii.len()),
            ("masses of grains", masses.len()),
        ] {
            if found != expected {
                return Err(BuildError::Count { place, found, expected });
            }
        }
        for i in 0..expected {
            for (what, vector) in [
                ("position (m)", &positions[i]),
                ("velocity (m/s)", &velocities[i]),
                ("angular velocity (rad/s)", &angular_velocities[i]),
            ] {
                finite(|| format!("{what} of grain {i}"), vector)?;
            }
            positive(|| format!("radius (m) of grain {i}"), radii[i])?;
            positive(|| format!("mass (kg) of grain {i}"), masses[i])?;
        }
        Ok(())
    }

    fn check_walls(&self, largest: Real, membrane: &MembraneModel) -> Result<(), BuildError> {
        for (k, wall) in self.walls.iter().enumerate() {
            let at = wall.pose.translation.vector;
            finite(|| format!("position (m) of wall {k}"), &at)?;
            wall.motion.check().map_err(|error| BuildError::Motion { wall: k, error })?;
            match &wall.shape {
                WallShape::Plane { normal } => {
                    let length = normal.norm();
                    let is_unit = (length - 1.0).abs() < UNIT_TOLERANCE;
                    if !is_unit {
                        return Err(BuildError::Normal { wall: k, length });
                    }
                }
                WallShape::Tube { radius } | WallShape::Bowl { radius } => {
                    positive(|| format!("radius (m) of wall {k}"), *radius)?;
                    if *radius <= largest {
                        let limit = largest;
                        return Err(BuildError::NarrowWall { wall: k, radius: *radius, limit });
                    }
                }
                WallShape::Ball { radius } => {
                    positive(|| format!("radius (m) of wall {k}"), *radius)?;
                }
                // Checked when they were created.
                WallShape::Triangles(_) => {}
                WallShape::Frame => {
                    if !membrane.holders.iter().any(|holder| *holder as usize == k) {
                        return Err(BuildError::IdleWall { wall: k });
                    }
                }
            }
        }
        Ok(())
    }

    fn check_period(&self, reach: Real) -> Result<(), BuildError> {
        let Some(period) = &self.period else { return Ok(()) };
        finite(|| "period (m)".to_owned(), period)?;
        let n_touched = self.bodies.iter().filter(|it| it.of_grains.is_some()).count();
        let (n_walls, n_membranes) = (self.walls.len() + n_touched, self.membranes.len());
        if 0 < n_walls + n_membranes {
            return Err(BuildError::NotAlone { n_walls, n_membranes });
        }
        let limit = 2.0 * reach;
        match (0..3).find(|&axis| period[axis] < limit) {
            Some(axis) => Err(BuildError::Period { axis, edge: period[axis], limit }),
            None => Ok(()),
        }
    }

    fn find_substep(
        &self,
        [smallest, largest]: [Real; 2],
        membrane: &MembraneModel,
    ) -> Result<Real, BuildError> {
        let substep = match (self.substep, &self.material) {
            (Substep::Given(substep), _) => substep,
            (Substep::OfCritical(share), Some(material)) => {
                let law = &self.membrane_law;
                let stiffness = stiffness_at_vertex(membrane, law, largest, self.pressure_max);
                let density = material.density * self.density_scaling;
                let material = Material { density, ..*material };
                share * critical_step(smallest, &material, membrane, stiffness)
            }
            (Substep::OfCritical(_), None) | (Substep::Unknown, _) => {
                return Err(BuildError::NoSubstep);
            }
        };
        positive(|| "substep (s)".to_owned(), substep)?;
        Ok(substep)
    }
}

fn finite(place: impl FnOnce() -> String, vector: &Vec3) -> Result<(), BuildError> {
    match vector.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(BuildError::NotFinite { place: place(), value }),
        None => Ok(()),
    }
}

fn positive(place: impl FnOnce() -> String, value: Real) -> Result<(), BuildError> {
    if !value.is_finite() {
        return Err(BuildError::NotFinite { place: place(), value });
    }
    if value > 0.0 { Ok(()) } else { Err(BuildError::NotPositive { place: place(), value }) }
}
