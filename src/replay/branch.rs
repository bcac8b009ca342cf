//! A new run that branches from a recorded one: identical up to a tick, with changed values after
//! it, and with the recorded commands throughout.

use super::{
    recorded_run::{RecordedRun, ReplayError},
    seconds,
};
use crate::{
    bag::recording::RecordedChange,
    cosim::compile::Compiled,
    host::progress_bar::Progress,
    node::{
        Inputs,
        launch::{self, Finished, RunError},
        start::Started,
    },
    scene::{Grains, Membrane, Scene, SceneError},
    session::Session,
};

/// Where to branch, and what to change.
pub struct Branch {
    /// Simulation time of the last recorded tick to keep (ns).
    pub from_ns: u64,
    /// Overrides of the scene, as `key=value`, including the outputs of the new run.
    pub overrides: Vec<String>,
}

/// Why a run cannot be branched.
#[derive(Debug, thiserror::Error)]
pub enum BranchError {
    /// The recorded run cannot be simulated again.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// An override is invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A value that cannot change after the start.
    #[error(
        "`{key}` cannot change after the start, because {reason}; \
         start a new run of the scene with it"
    )]
    Fixed {
        /// The key.
        key: &'static str,
        /// The reason.
        reason: &'static str,
    },
    /// The time is outside the recording, or its start was not recorded.
    #[error(
        "cannot branch at {from_s} s: the recording can be resumed from {first_s} s to {last_s} s; \
         choose a time between"
    )]
    OutOfRange {
        /// The requested time (s).
        from_s: f64,
        /// Time of the first tick (s).
        first_s: f64,
        /// Time of the last tick (s).
        last_s: f64,
    },
    /// The simulation did not reproduce the recorded state.
    #[error(
        "tick {tick} differs from the recording, so a run cannot branch from it; \
         verify the recording for details"
    )]
    Differs {
        /// The tick.
        tick: u64,
    },
    /// Objects were spawned or deleted before.
    #[error(
        "at tick {tick} the objects are not those of the scene: some were spawned or deleted \
         during the recording; choose a time with the scene's own objects"
    )]
    OtherObjects {
        /// The tick.
        tick: u64,
    },
    /// The world was changed later, which a branch does not repeat.
    #[error(
        "the recorded world was changed at {at_s} s ({what}), which a branch does not \
         repeat; end before it with --end {at_s}s, or choose a later time for --from"
    )]
    Changed {
        /// Time of the change in the run (s).
        at_s: f64,
        /// Description of the change.
        what: String,
    },
    /// The new run failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl BranchError {
    /// True if the command line is invalid.
    pub fn is_of_command_line(&self) -> bool {
        match self {
            Self::Scene(_) | Self::Fixed { .. } | Self::OutOfRange { .. } => true,
            Self::OtherObjects { .. } | Self::Changed { .. } => true,
            Self::Replay(_) | Self::Differs { .. } | Self::Run(_) => false,
        }
    }
}

/// Branches a run from a recorded one and continues it to the recording's end, or to that of
/// `options`.
///
/// # Errors
/// If the time is not in the recording, or an override is not possible.
pub fn branch(
    run: &RecordedRun,
    branch: &Branch,
    options: &launch::Options,
) -> Result<Finished, BranchError> {
    let scene = run.changed_scene(&branch.overrides)?;
    if let Some((key, reason)) = fixed_change(&run.scene, &scene) {
        return Err(BranchError::Fixed { key, reason });
    }
    let tick_ns = run.scene.time.tick_ns;
    let tick = branch.from_ns / tick_ns;
    let last = seconds(run.history.last_tick() * tick_ns);
    let duration = options.duration.unwrap_or(last);
    reject_later_changes(run, tick, duration)?;
    let bytes = state_after(run, tick, options.n_threads)?;
    let begin = |compiled: Compiled, _: &Progress| {
        let resumed = Session::resume(compiled, &bytes);
        let session = resumed.map_err(|error| RunError::Replay(Box::new(error)))?;
        Ok(Started { session, origin: "branched" })
    };
    let script = run.script()?;
    let mut options = launch::Options { duration: Some(duration), ..options.clone() };
    let origin = format!("{} after tick {tick}", run.path.display());
    options.facts.push(("branched_from", origin));
    // External inputs are read-only: the commands are those of the recording.
    Ok(launch::launch_with(&scene, &options, begin, |_| Inputs::of_script(script))?)
}

/// Rejects changes of the world after `tick` and before `end_s`, because a branch does not repeat them.
fn reject_later_changes(run: &RecordedRun, tick: u64, end_s: f64) -> Result<(), BranchError> {
    let at_s = |it: &RecordedChange| seconds(it.tick * run.scene.time.tick_ns);
    let mut later = run.history.changes.iter().filter(|it| tick <= it.tick && at_s(it) < end_s);
    let error =
        |it: &RecordedChange| BranchError::Changed { at_s: at_s(it), what: it.what.clone() };
    later.next().map_or(Ok(()), |it| Err(error(it)))
}

/// The saved state of the recorded run after `tick`.
fn state_after(run: &RecordedRun, tick: u64, n_threads: usize) -> Result<Vec<u8>, BranchError> {
    let tick_ns = run.scene.time.tick_ns;
    let (history, mut script) = (&run.history, run.script()?);
    let last = history.gap_after.unwrap_or(u64::MAX).min(history.last_tick());
    let out_of_range = || BranchError::OutOfRange {
        from_s: seconds(tick * tick_ns),
        first_s: seconds(history.checkpoints.first().map_or(0, |it| it.tick) * tick_ns),
        last_s: seconds(last * tick_ns),
    };
    if last < tick {
        return Err(out_of_range());
    }
    let session = run.session_before(tick, &run.scene, n_threads)?;
    let mut session = session.ok_or_else(out_of_range)?;
    while session.run_tick().0 < tick {
        let now = session.run_tick().0;
        for it in history.changes.iter().filter(|it| it.tick == now) {
            run.change(&mut session, it)?;
        }
        session.tick(&script.commands_in(now + 1)).map_err(ReplayError::from)?;
    }
    let recorded = history.digests.iter().find(|(at, _)| *at == tick);
    if recorded.is_some_and(|(_, digest)| *digest != session.digest()) {
        return Err(BranchError::Differs { tick });
    }
    session.save().ok_or(BranchError::OtherObjects { tick })
}

/// The first changed value that cannot change because saved numbers depend on it, with the reason.
fn fixed_change(old: &Scene, new: &Scene) -> Option<(&'static str, &'static str)> {
    const RUN: &str = "recorded commands and digests are counted in ticks";
    const PACKING: &str = "the recorded grains and membrane depend on it";
    const OBJECT: &str = "the recorded object has this shape";
    const START: &str = "it only sets the start pose";
    let grains = |it: &Grains| {
        let Grains { count, radius_min, radius_max, material, .. } = *it;
        (count, [radius_min, radius_max, material.density].map(f64::to_bits))
    };
    let membrane = |it: &Membrane| {
        let Membrane { radius, frequency, rest_length_shrink, fill_stretch, .. } = *it;
        (frequency, [radius, rest_length_shrink, fill_stretch].map(f64::to_bits))
    };
    let objects = |it: &Scene| -> Vec<String> {
        it.objects.iter().map(|it| format!("{:?}", (&it.name, it.pose))).collect()
    };
    let shapes =
        |it: &Scene| -> Vec<String> { it.objects.iter().map(|it| shape_text(&it.shape)).collect() };
    let checks = [
        (old.time.tick_ns != new.time.tick_ns, "time.tick", RUN),
        (old.seed != new.seed, "seed", PACKING),
        (grains(&old.grains) != grains(&new.grains), "grains", PACKING),
        (membrane(&old.membrane) != membrane(&new.membrane), "membrane", PACKING),
        (shapes(old) != shapes(new), "object.shape", OBJECT),
        (objects(old) != objects(new), "object", START),
        (old.flange.pose != new.flange.pose, "flange.position", START),
        (old.table.height.to_bits() != new.table.height.to_bits(), "table.height", OBJECT),
    ];
    checks.into_iter().find(|(differs, ..)| *differs).map(|(_, key, reason)| (key, reason))
}

/// The text of a shape, without the path of its file.
fn shape_text(shape: &crate::scene::Shape) -> String {
    match shape {
        crate::scene::Shape::Mesh { vertices, triangles, .. } => {
            format!("{vertices:?} {triangles:?}")
        }
        other => format!("{other:?}"),
    }
}
