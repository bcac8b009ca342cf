//! The result of a case, as JSON and as text.

use std::{collections::BTreeMap, fmt::Write};

use serde::{Deserialize, Serialize};

#[cfg(all(feature = "ros", feature = "shm"))]
use super::Latency;
use super::{
    ReferenceResult,
    repetitions::{Repetition, Work},
    sanity::StateSummary,
};
use crate::base::{
    Real,
    real::{real, real_of},
};

/// Stages below this share are not shown in the text.
const SHARE_SHOWN: Real = 5e-4;

/// Processor share below which other processes used the CPU.
const SHARE_MIN: Real = 0.9;

/// The result of a case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BenchResult {
    /// Name of the case.
    pub case: String,
    /// Number of grains.
    pub n_grains: usize,
    /// Number of vertices of the membrane.
    pub n_vertices: usize,
    /// Number of solver threads.
    pub threads: usize,
    /// Maximum SIMD width.
    pub lanes: u8,
    /// Length of a substep (s).
    pub substep_s: Real,
    /// Substeps per second, the median of all repetitions.
    pub steps_per_s: Real,
    /// Substeps per second of the fastest repetition.
    pub steps_per_s_best: Real,
    /// Time of the slowest repetition divided by that of the fastest, minus one.
    pub spread: Real,
    /// Processor time divided by wall-clock time and threads; below one, other processes used the
    /// processors. Null if unknown.
    pub processor_share: Option<Real>,
    /// Contacts between grains times substeps per second and thread.
    pub contact_steps_per_s_per_core: Real,
    /// Its inverse (ns).
    pub ns_per_contact_step: Real,
    /// Simulated time divided by wall-clock time.
    pub real_time_factor: Real,
    /// Digest of the state after `digest_after_steps` steps.
    pub digest: String,
    /// Steps from the start to the state of the digest.
    pub digest_after_steps: u64,
    /// Digest of the start state; only digests of runs with the same start are comparable.
    pub start_digest: String,
    /// Unmeasured steps at the start of a repetition.
    pub n_warm_steps: u64,
    /// Measured steps of a repetition.
    pub n_lap_steps: u64,
    /// Number of repetitions.
    pub n_laps: usize,
    /// Number of times that a repetition built the neighbor lists.
    pub n_builds_per_lap: u64,
    /// Contacts between grains, counted at the end of a repetition, as all contacts.
    pub n_contacts: usize,
    /// Contacts of grains with walls.
    pub n_wall_contacts: usize,
    /// Contacts of grains with the membrane.
    pub n_membrane_contacts: usize,
    /// Contacts of the membrane with bodies.
    pub n_body_contacts: usize,
    /// Largest overlap of two grains (m).
    pub overlap_max_m: Real,
    /// Largest overlap divided by the mean radius.
    pub overlap_ratio_max: Real,
    /// Kinetic energy (J).
    pub kinetic_energy_j: Real,
    /// Largest resident set during the repetitions (bytes); null if unknown.
    pub peak_rss_bytes: Option<u64>,
    /// Time of each stage of a substep.
    pub stages: Vec<Stage>,
    /// Real-time factor of each phase of a session.
    pub phases: BTreeMap<String, Real>,
    /// Latencies of the loop.
    #[cfg(all(feature = "ros", feature = "shm"))]
    pub latencies: Vec<Latency>,
    /// Results of the reference codes with the same packing.
    pub peers: Vec<ReferenceResult>,
    /// Reference codes that are not installed, with the remedy.
    pub peers_missing: Vec<String>,
}

/// The time of one stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stage {
    /// Name of the stage.
    pub name: String,
    /// Share of the total time.
    pub share: Real,
    /// Time per substep (ns).
    pub ns_per_step: Real,
}

impl BenchResult {
    /// Speeds from repetitions.
    pub(super) fn of_repetitions(repetitions: &[Repetition], work: Work, n_threads: usize) -> Self {
        let mut times: Vec<Real> = repetitions.iter().map(|repetition| repetition.wall_s).collect();
        times.sort_by(Real::total_cmp);
        let (Some(best), Some(worst)) = (times.first(), times.last()) else {
            return Self::default();
        };
        let n_steps = real_of(work.n_steps);
        let steps_per_s = n_steps / median(&times);
        let n_contacts = repetitions.iter().map(|repetition| repetition.n_contacts).sum::<Real>()
            / real(repetitions.len());
        let contact_steps = n_contacts * steps_per_s / real(n_threads);
        Self {
            steps_per_s,
            steps_per_s_best: n_steps / best,
            spread: worst / best - 1.0,
            processor_share: processor_share(
                repetitions.iter().map(|repetition| (repetition.wall_s, repetition.processor_s)),
                n_threads,
            ),
            contact_steps_per_s_per_core: contact_steps,
            ns_per_contact_step: 1e9 / contact_steps,
            n_laps: repetitions.len(),
            n_builds_per_lap: repetitions[0].n_builds,
            ..Self::default()
        }
    }

    /// Adds the real-time factor that follows from the speed.
    pub(super) fn with_real_time_factor(mut self) -> Self {
        self.real_time_factor = self.steps_per_s * self.substep_s;
        self
    }

    /// Adds a summary of the end state.
    pub(super) fn with_state(mut self, state: &StateSummary) -> Self {
        self.n_contacts = state.n_grain_contacts;
        self.n_wall_contacts = state.n_wall_contacts;
        self.n_membrane_contacts = state.n_membrane_contacts;
        self.n_body_contacts = state.n_body_contacts;
        self.overlap_max_m = state.overlap_max;
        self.overlap_ratio_max = state.overlap_ratio_max;
        self.kinetic_energy_j = state.kinetic_energy;
        self
    }

    /// The result as text of several lines.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text).expect("writing to a String cannot fail");
        text
    }

    #[cfg(all(feature = "ros", feature = "shm"))]
    fn write_latencies(&self, text: &mut String) -> std::fmt::Result {
        for it in &self.latencies {
            writeln!(
                text,
                "  {}: p50 {:.0} us, p99 {:.0} us, p99.9 {:.0} us, at most {:.0} us, {} samples, {} lost",
                it.path, it.p50_us, it.p99_us, it.p999_us, it.max_us, it.n, it.n_lost
            )?;
        }
        Ok(())
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        #[cfg(all(feature = "ros", feature = "shm"))]
        if !self.latencies.is_empty() {
            let Self { case, threads, real_time_factor, .. } = self;
            writeln!(
                text,
                "{case}: loop at 1 kHz, {threads} solver threads, real-time factor {real_time_factor:.4}"
            )?;
            return self.write_latencies(text);
        }
        let Self { case, n_grains, n_vertices, threads, lanes, n_laps, n_lap_steps, .. } = self;
        writeln!(
            text,
            "{case}: {n_grains} grains, {n_vertices} vertices, threads: {threads}, lanes: {lanes}"
        )?;
        let processors = or_unknown(self.processor_share, |it| format!("{:.0} %", 100.0 * it));
        writeln!(
            text,
            "  {:.1} steps/s (best {:.1}, spread {:.1} %, {n_laps} repetitions of {n_lap_steps} steps, processors \
             {processors}), step {:.3e} s, real-time factor {:.4}",
            self.steps_per_s,
            self.steps_per_s_best,
            100.0 * self.spread,
            self.substep_s,
            self.real_time_factor
        )?;
        writeln!(
            text,
            "  {:.2} M contact-steps/s per core ({:.1} ns), contacts: {} grains, {} walls, {} membrane, \
             {} bodies; lists built {} times per repetition",
            self.contact_steps_per_s_per_core / 1e6,
            self.ns_per_contact_step,
            self.n_contacts,
            self.n_wall_contacts,
            self.n_membrane_contacts,
            self.n_body_contacts,
            self.n_builds_per_lap
        )?;
        self.write_shares(text)?;
        self.write_peers(text)?;
        if self.processor_share.is_some_and(|it| it < SHARE_MIN) {
            writeln!(
                text,
                "  other processes used the processors: speeds and ratios are unreliable; use an idle machine"
            )?;
        }
        let memory = |bytes| format!("{:.0} MiB", real_of(bytes) / 1_048_576.0);
        writeln!(
            text,
            "  digest {} after {} steps from {}; largest overlap {:.4} radii, kinetic energy {:.3e} J; \
             memory {}",
            self.digest,
            self.digest_after_steps,
            self.start_digest,
            self.overlap_ratio_max,
            self.kinetic_energy_j,
            or_unknown(self.peak_rss_bytes, memory)
        )
    }

    fn write_shares(&self, text: &mut String) -> std::fmt::Result {
        let shown = self.stages.iter().filter(|stage| SHARE_SHOWN <= stage.share);
        let stage = |it: &Stage| {
            format!("{} {:.1} % ({:.1} us)", it.name, 100.0 * it.share, it.ns_per_step / 1e3)
        };
        let stages: Vec<String> = shown.map(stage).collect();
        writeln!(text, "  {}", stages.join(", "))?;
        if self.phases.is_empty() {
            return Ok(());
        }
        let phase = |(name, factor): (&String, &Real)| format!("{name} {factor:.3}");
        let phases: Vec<String> = self.phases.iter().map(phase).collect();
        writeln!(text, "  real-time factor by phase: {}", phases.join(", "))
    }

    fn write_peers(&self, text: &mut String) -> std::fmt::Result {
        for it in &self.peers {
            writeln!(
                text,
                "  {:.2} x {}: {:.2} M contact-steps/s per core (spread {:.1} %), {:.0} contacts, kinetic \
                 energy {:.3e} J; {}",
                it.ratio,
                it.peer,
                it.contact_steps_per_s_per_core / 1e6,
                100.0 * it.spread,
                it.n_contacts,
                it.kinetic_energy_j,
                it.version
            )?;
        }
        for line in &self.peers_missing {
            writeln!(text, "  {line}")?;
        }
        Ok(())
    }
}

fn or_unknown<T>(value: Option<T>, text: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| "unknown".to_owned(), text)
}

/// Processor time divided by wall-clock time (s) and threads.
pub(super) fn processor_share(
    repetitions: impl Iterator<Item = (Real, Option<Real>)>,
    n_threads: usize,
) -> Option<Real> {
    let (mut wall, mut processor) = (0.0, 0.0);
    for (wall_s, processor_s) in repetitions {
        wall += wall_s;
        processor += processor_s?;
    }
    Some(processor / (wall * real(n_threads)))
}

/// The median of sorted values.
pub(super) fn median(sorted: &[Real]) -> Real {
    let n = sorted.len();
    if n % 2 == 1 { sorted[n / 2] } else { 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]) }
}
