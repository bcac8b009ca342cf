//! A synthetic system in which every number follows from the tick, so that readers can check it.

use std::path::{Path, PathBuf};

use jamgrip::{
    base::{
        Pose, Tick, Vec3,
        real::{Twist, Wrench},
    },
    command::CommandCounts,
    scene::{Scene, load},
    snapshot::{
        BodySnapshot, ChamberSnapshot, GrainsSnapshot, JammingSnapshot, MembraneSnapshot,
        ObjectSnapshot, Snapshot, view::View,
    },
};

/// Grains of the default scene.
pub(crate) const N_GRAINS: usize = 3000;
/// Vertices of the default scene.
pub(crate) const N_VERTICES: usize = 1321;

/// Holds the data that a session would hold.
pub(crate) struct Synthetic {
    pub(crate) snapshot: Snapshot,
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
    spins: Vec<Vec3>,
    radii: Vec<f64>,
    normal_forces: Vec<f64>,
    vertices: Vec<Vec3>,
    vertex_forces: Vec<Vec3>,
}

impl Synthetic {
    /// The system at tick 0, with an object called `name`.
    pub(crate) fn new(name: &str) -> Self {
        let at_rest = BodySnapshot { pose: Pose::identity(), twist: Twist::zero() };
        let object = ObjectSnapshot {
            name: name.to_owned(),
            body: at_rest,
            contact_wrench: Wrench::zero(),
            membrane_wrench: Wrench::zero(),
            is_driven: false,
        };
        let mut this = Self {
            snapshot: Snapshot {
                tick: Tick(0),
                time_ns: 0,
                run_tick: Tick(0),
                flange: at_rest,
                objects: vec![object],
                contact_wrench: Wrench::zero(),
                mount_wrench: Wrench::zero(),
                chamber: ChamberSnapshot {
                    gauge_setpoint: 0.0,
                    gauge: 0.0,
                    ambient: 101_325.0,
                    volume: 1.3e-4,
                },
                jamming: JammingSnapshot::default(),
                membrane: None,
                grains: None,
                contacts: None,
                commands: Vec::new(),
                command_counts: CommandCounts::default(),
                digest: 0,
            },
            positions: vec![Vec3::zeros(); N_GRAINS],
            velocities: vec![Vec3::zeros(); N_GRAINS],
            spins: vec![Vec3::zeros(); N_GRAINS],
            radii: vec![0.002; N_GRAINS],
            normal_forces: vec![0.0; N_GRAINS],
            vertices: vec![Vec3::zeros(); N_VERTICES],
            vertex_forces: vec![Vec3::zeros(); N_VERTICES],
        };
        this.advance_to(0);
        this
    }

    /// Sets all numbers to those of `tick`.
    pub(crate) fn advance_to(&mut self, tick: u64) {
        self.snapshot.tick = Tick(tick);
        self.snapshot.time_ns = tick * 1_000_000;
        self.snapshot.run_tick = Tick(tick);
        self.snapshot.digest = tick.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.snapshot.contact_wrench.force.z = number(tick);
        self.snapshot.chamber.gauge = -number(tick);
        for i in 0..N_GRAINS {
            self.positions[i] = Vec3::new(number(tick), number(i as u64), 0.5);
            self.normal_forces[i] = number(tick + i as u64);
        }
        for i in 0..N_VERTICES {
            self.vertices[i] = Vec3::new(number(tick), number(i as u64), -0.5);
        }
    }

    /// Moves all grains and vertices to one height (m).
    pub(crate) fn lift_lists_to(&mut self, height: f64) {
        self.positions.iter_mut().chain(&mut self.vertices).for_each(|it| it.z = height);
    }

    /// The grains, as in a snapshot.
    pub(crate) fn grains(&self) -> GrainsSnapshot {
        GrainsSnapshot {
            positions: self.positions.clone(),
            radii: self.radii.clone(),
            velocities: self.velocities.clone(),
            normal_forces: self.normal_forces.clone(),
        }
    }

    /// The membrane, as in a snapshot.
    pub(crate) fn membrane(&self) -> MembraneSnapshot {
        MembraneSnapshot {
            positions: self.vertices.clone(),
            normals: vec![Vec3::z(); N_VERTICES],
            contact_pressures: vec![0.0; N_VERTICES],
            strains: vec![0.0; N_VERTICES],
        }
    }

    /// The view that streams write from.
    pub(crate) fn view(&self) -> View<'_> {
        View {
            snapshot: &self.snapshot,
            grain_positions: &self.positions,
            grain_velocities: &self.velocities,
            grain_spins: &self.spins,
            grain_radii: &self.radii,
            grain_normal_forces: &self.normal_forces,
            vertex_positions: &self.vertices,
            vertex_velocities: &self.vertices,
            vertex_contact_forces: &self.vertex_forces,
        }
    }
}

/// The main scene; its object is called `cylinder`.
pub(crate) fn scene() -> Scene {
    load(&main_scene(), &["outputs.state_rate=250 Hz".to_owned()]).unwrap()
}

/// The file of the main scene.
pub(crate) fn main_scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("launch_configs/pick_and_lift.yaml")
}

/// An integer as a real number, exactly.
pub(crate) fn number(count: u64) -> f64 {
    f64::from(u32::try_from(count).unwrap())
}

/// An example that `cargo test` has built next to this binary.
pub(crate) fn example(name: &str) -> PathBuf {
    let here = std::env::current_exe().unwrap();
    let profile = here.parent().and_then(|it| it.parent()).unwrap();
    let path = profile.join("examples").join(name);
    assert!(path.exists(), "{} is missing: run `cargo test` without `--test`", path.display());
    path
}
