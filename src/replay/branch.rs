//! A new run that branches off a recorded moment: the same bits up to there, other values from there
//! on, the recorded commands throughout.

use super::{
    recorded_run::{RecordedRun, ReplayError},
    seconds,
};
use crate::{
    bag::recording::Alteration,
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

/// Where a run branches off, and how.
pub struct Branch {
    /// Simulated time of the last recorded tick that is kept (ns).
    pub from_ns: u64,
    /// Changes of the scene, as `key=value`, the outputs of the new run among them.
    pub overrides: Vec<String>,
}

/// Why no run branches off.
#[derive(Debug, thiserror::Error)]
pub enum BranchError {
    /// The recording cannot be taken up.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A change is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A value cannot change after the start.
    #[error(
        "`{key}` cannot change after the start, because {reason}; \
         start a new run of the scene with it"
    )]
    Fixed {
        /// The key.
        key: &'static str,
        /// Why.
        reason: &'static str,
    },
    /// The recording is shorter, or its start is not kept.
    #[error(
        "cannot branch at {from_s} s: the recording can be resumed from {first_s} s to {last_s} s; \
         choose a time between"
    )]
    OutOfRange {
        /// Asked for (s).
        from_s: f64,
        /// First tick (s).
        first_s: f64,
        /// Last tick (s).
        last_s: f64,
    },
    /// The run did not come to the recorded state again.
    #[error(
        "tick {tick} differs from the recording, so a run cannot branch from it; \
         verify the recording for details"
    )]
    Differs {
        /// The tick.
        tick: u64,
    },
    /// Objects were added or taken away before.
    #[error(
        "at tick {tick} there are other objects than the scene's: they were added or taken away \
         while it was recorded; choose a time with the scene's own objects"
    )]
    OtherObjects {
        /// The tick.
        tick: u64,
    },
    /// The world was changed later, which a branch does not repeat.
    #[error(
        "the recorded run was changed from outside at {at_s} s ({what}), which a branch does not \
         repeat; end before with --end {at_s}s, or choose a later time for --from"
    )]
    Changed {
        /// When, in time of the run (s).
        at_s: f64,
        /// What was done.
        what: String,
    },
    /// The new run could not begin or go on.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl BranchError {
    /// True if something else has to be asked for.
    pub fn is_of_command_line(&self) -> bool {
        match self {
            Self::Scene(_) | Self::Fixed { .. } | Self::OutOfRange { .. } => true,
            Self::OtherObjects { .. } | Self::Changed { .. } => true,
            Self::Replay(_) | Self::Differs { .. } | Self::Run(_) => false,
        }
    }
}

/// Branches a run off a recording and runs it to the recording's end, or to that of `options`.
///
/// # Errors
/// If the moment is not in the recording, or a change is not possible.
pub fn branch(
    again: &RecordedRun,
    branch: &Branch,
    options: &launch::Options,
) -> Result<Finished, BranchError> {
    let scene = again.changed_scene(&branch.overrides)?;
    if let Some((key, reason)) = fixed_change(&again.scene, &scene) {
        return Err(BranchError::Fixed { key, reason });
    }
    let tick_ns = again.scene.time.tick_ns;
    let tick = branch.from_ns / tick_ns;
    let last = seconds(again.course.last_tick() * tick_ns);
    let duration = options.duration.unwrap_or(last);
    refuse_changes(again, tick, duration)?;
    let bytes = moment(again, tick, options.n_threads)?;
    let begin = |compiled: Compiled, _: &Progress| {
        let resumed = Session::resume(compiled, &bytes);
        let session = resumed.map_err(|fault| RunError::Replay(Box::new(fault)))?;
        Ok(Started { session, origin: "branched" })
    };
    let script = again.script()?;
    let mut options = launch::Options { duration: Some(duration), ..options.clone() };
    let origin = format!("{} after tick {tick}", again.path.display());
    options.facts.push(("branched_from", origin));
    // External inputs are read-only: the commands are those of the recording.
    Ok(launch::launch_with(&scene, &options, begin, |_| Inputs::of_script(script))?)
}

/// Refuses to leave out what was done to the world from outside after `tick` and before `end_s`.
fn refuse_changes(again: &RecordedRun, tick: u64, end_s: f64) -> Result<(), BranchError> {
    let at_s = |it: &Alteration| seconds(it.tick * again.scene.time.tick_ns);
    let mut later = again.course.changes.iter().filter(|it| tick <= it.tick && at_s(it) < end_s);
    let refused = |it: &Alteration| BranchError::Changed { at_s: at_s(it), what: it.what.clone() };
    later.next().map_or(Ok(()), |it| Err(refused(it)))
}

/// The recorded run after `tick`, as bytes.
fn moment(again: &RecordedRun, tick: u64, n_threads: usize) -> Result<Vec<u8>, BranchError> {
    let tick_ns = again.scene.time.tick_ns;
    let (course, mut script) = (&again.course, again.script()?);
    let last = course.gap_after.unwrap_or(u64::MAX).min(course.last_tick());
    let out_of_range = || BranchError::OutOfRange {
        from_s: seconds(tick * tick_ns),
        first_s: seconds(course.checkpoints.first().map_or(0, |it| it.tick) * tick_ns),
        last_s: seconds(last * tick_ns),
    };
    if last < tick {
        return Err(out_of_range());
    }
    let session = again.session_before(tick, &again.scene, n_threads)?;
    let mut session = session.ok_or_else(out_of_range)?;
    while session.run_tick().0 < tick {
        let now = session.run_tick().0;
        for it in course.changes.iter().filter(|it| it.tick == now) {
            again.change(&mut session, it)?;
        }
        session.tick(&script.of(now + 1)).map_err(ReplayError::from)?;
    }
    let recorded = course.digests.iter().find(|(at, _)| *at == tick);
    if recorded.is_some_and(|(_, digest)| *digest != session.digest()) {
        return Err(BranchError::Differs { tick });
    }
    session.save().ok_or(BranchError::OtherObjects { tick })
}

/// The first value that differs though saved numbers depend on it, and why it cannot.
fn fixed_change(old: &Scene, new: &Scene) -> Option<(&'static str, &'static str)> {
    const RUN: &str = "recorded commands and digests are counted in ticks";
    const PACKING: &str = "the grains and the membrane that were recorded have it in them";
    const OBJECT: &str = "the recorded object has this shape";
    const START: &str = "it only says where things were at the start";
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

/// A shape without the path of the file it came from.
fn shape_text(shape: &crate::scene::Shape) -> String {
    match shape {
        crate::scene::Shape::Mesh { vertices, triangles, .. } => {
            format!("{vertices:?} {triangles:?}")
        }
        other => format!("{other:?}"),
    }
}
