//! A made-up system whose every number follows from its tick, so that readers can check them.

use jamgrip::{
    base::{
        Pose, Tick, Vec3,
        real::{Twist, Wrench},
    },
    command::CommandCounts,
    scene,
    snapshot::{
        BodySnapshot, ChamberSnapshot, GrainsSnapshot, JammingSnapshot, MembraneSnapshot,
        ObjectSnapshot, Snapshot, view::View,
    },
};

/// Grains of the default scene.
pub(crate) const N_GRAINS: usize = 3000;
/// Vertices of the default scene.
pub(crate) const N_VERTICES: usize = 1321;

/// The owner of what a session would own.
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
    /// The system at tick 0, its object called `name`.
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

    /// The grains as a snapshot has them when they are due.
    pub(crate) fn grains(&self) -> GrainsSnapshot {
        GrainsSnapshot {
            positions: self.positions.clone(),
            radii: self.radii.clone(),
            velocities: self.velocities.clone(),
            normal_forces: self.normal_forces.clone(),
        }
    }

    /// The membrane as a snapshot has it when it is due.
    pub(crate) fn membrane(&self) -> MembraneSnapshot {
        MembraneSnapshot {
            positions: self.vertices.clone(),
            normals: vec![Vec3::z(); N_VERTICES],
            contact_pressures: vec![0.0; N_VERTICES],
            strains: vec![0.0; N_VERTICES],
        }
    }

    /// The borrowed look that streams write from.
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

/// A scene whose only object is called `cylinder`; what leaves the process follows from its rates.
pub(crate) fn scene() -> scene::Scene {
    let material = scene::Material { youngs_modulus: 1e9, poisson_ratio: 0.3, density: 7800.0 };
    scene::Scene {
        name: "synthetic".to_owned(),
        seed: 1,
        time: scene::Time { tick_ns: 1_000_000, substep: None, safety: 0.2 },
        gravity: Vec3::new(0.0, 0.0, -9.81),
        grains: scene::Grains {
            count: N_GRAINS,
            radius_min: 0.0015,
            radius_max: 0.0025,
            material,
            friction: 0.3,
            dissipation_time: 1e-6,
            tangential_damping: 0.1,
        },
        membrane: scene::Membrane {
            radius: 0.04,
            frequency: 16,
            thickness: 0.0003,
            material,
            friction: 0.5,
            spring_damping: 0.1,
            bending_stiffness: 1e-6,
            bending_damping: 1e-9,
            rest_length_shrink: 0.0,
            fill_stretch: 1.0,
            dissipation_time: 1e-6,
            tangential_damping: 0.1,
        },
        chamber: scene::Chamber {
            ambient: 101_325.0,
            gauge_min: -90e3,
            gauge_max: 5e3,
            lag: 0.05,
            rate_max: 1e6,
        },
        flange: scene::Flange {
            pose: Pose::identity(),
            speed_max: 0.2,
            acceleration_max: 2.0,
            angular_speed_max: 1.0,
            angular_acceleration_max: 10.0,
        },
        table: scene::Table { height: 0.0, friction: 0.5 },
        objects: vec![scene::Object {
            name: "cylinder".to_owned(),
            shape: scene::Shape::Cylinder { radius: 0.015, height: 0.04 },
            material,
            friction: 0.5,
            pose: Pose::identity(),
            drive_timeout: 0.5,
        }],
        controller: scene::Controller::Topics { duration: None },
        outputs: outputs(),
    }
}

fn outputs() -> scene::Outputs {
    scene::Outputs {
        state_rate: 250.0,
        pressure_rate: 100.0,
        membrane_rate: 30.0,
        grains_rate: 30.0,
        contacts_rate: 30.0,
        statistics_rate: 1.0,
        grains_count_max: 5000,
        ros: scene::Ros { enabled: true, domain_id: None, lan: false },
        stream: true,
        bag: scene::Bag {
            enabled: false,
            folder: None,
            on_full: scene::OnFull::Wait,
            on_error: scene::OnError::Continue,
        },
        real_time: false,
    }
}

/// Whole numbers as reals, exact.
pub(crate) fn number(count: u64) -> f64 {
    f64::from(u32::try_from(count).unwrap())
}
