//! A coarse gripper: the same laws with an eighth of the grains, settled once for all tests of this
//! binary.

use std::{path::Path, sync::OnceLock};

use jamgrip::{
    base::{Real, Vec3, parallel},
    command::{Command, PoseCommand},
    cosim::{Coupled, compile::Compiled, rapier_world::RapierWorld},
    physics::Model,
    scene::{Scene, text},
    session::Session,
};

/// Grains twice as large and a mesh twice as coarse as in the default scene; a light plastic cylinder
/// with vertical walls just below the membrane.
pub(crate) const TEXT: &str = "
name: coarse
membrane: { frequency: 8 }
grains: { count: 280, radius_min: 3.8 mm, radius_max: 4.2 mm }
object:
  name: cylinder
  shape:
    cylinder: { radius: 12 mm, height: 50 mm }
  density: 1200 kg/m^3
  position: [0 mm, 0 mm, 25 mm]
flange:
  position: [0 mm, 0 mm, 101 mm]
  speed_max: 500 mm/s
  acceleration_max: 10 m/s^2
chamber: { lag: 20 ms }
";

/// Another gripper: fewer grains, another mesh, and a ball.
pub(crate) const OTHER_TEXT: &str = "
name: other
seed: 2
membrane: { frequency: 6 }
grains: { count: 200, radius_min: 4 mm, radius_max: 4.4 mm }
object:
  name: ball
  shape: { sphere: { radius: 15 mm } }
  position: [0 mm, 0 mm, 15 mm]
flange: { position: [0 mm, 0 mm, 101 mm] }
";

/// The scene, with overrides as on the command line.
pub(crate) fn scene(overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|it| (*it).to_owned()).collect();
    text::parse(TEXT, "coarse", Path::new(""), &overrides).unwrap()
}

/// The scene compiled for `n_threads` solver threads.
pub(crate) fn compiled(n_threads: usize, overrides: &[&str]) -> Compiled {
    Compiled::new(&scene(overrides), &parallel::ThreadPool::new(n_threads).unwrap()).unwrap()
}

/// The serialized settled start state.
pub(crate) fn start_state() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| Session::settle(compiled(2, &[]), &mut |_| {}).unwrap().start_state())
}

/// A session that starts settled; overrides must not affect grains or membrane.
pub(crate) fn session(n_threads: usize, overrides: &[&str]) -> Session {
    Session::from_start_state(compiled(n_threads, overrides), start_state()).unwrap()
}

/// The coupled system without a session; `change` may modify the model.
pub(crate) fn coupled(change: impl FnOnce(&mut Model)) -> Coupled {
    let mut compiled = compiled(1, &[]);
    change(&mut compiled.model);
    coupled_of(compiled)
}

/// The coupled system of a compiled scene.
pub(crate) fn coupled_of(compiled: Compiled) -> Coupled {
    let mut state = compiled.read_start_state(start_state()).unwrap();
    state.grains.masses.iter_mut().for_each(|it| *it *= compiled.model.density_scaling);
    let Compiled { scene, model, plan, bulks, limits, .. } = compiled;
    state.springs.bodies = vec![Vec3::zeros(); model.n_samples() * model.bodies.len()];
    #[expect(clippy::cast_precision_loss, reason = "a small count")]
    let step = model.substep * plan.n_per_exchange as Real;
    let world = RapierWorld::new(&scene, &model, bulks, step);
    Coupled::new(model, plan, state, world, limits)
}

/// Commands the flange to height `z` (m) above the origin.
pub(crate) fn flange_to(z: Real) -> Command {
    Command::FlangePose(pose(Vec3::new(0.0, 0.0, z)))
}

/// A pose in the world frame without rotation.
pub(crate) fn pose(position: Vec3) -> PoseCommand {
    PoseCommand {
        frame_id: "world".to_owned(),
        stamp_ns: 0,
        position: position.into(),
        orientation: [0.0, 0.0, 0.0, 1.0],
    }
}
