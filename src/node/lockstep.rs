//! Ticks that wait for a controller or for another simulator.
//!
//! A controller releases ticks with a command stamped not before the current simulated time.
//! Another simulator releases a tick when its clock has reached the end of the tick.
//!
//! Commands that arrive while a tick waits are kept for it in the order of arrival. A controller
//! that sends its stamped command last therefore knows that all of them act in the next tick.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use crate::{
    command::Command,
    scene::{Lockstep, OnTimeout},
};

/// Decides when the next tick may begin.
pub struct Gate {
    rules: Lockstep,
    /// Ticks released and not yet run.
    left: u64,
    pending: Vec<Command>,
    has_missed: bool,
    /// Clock of the other simulator and length of a tick (ns).
    clock: Option<(Arc<AtomicU64>, u64)>,
}

/// What to do about a missed command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missed {
    /// Only log it.
    Log,
    /// Pause the simulation.
    Pause,
    /// End the run.
    End,
}

impl Gate {
    /// A gate with the lockstep rules of a scene.
    pub fn new(rules: Lockstep) -> Self {
        Self { rules, left: 0, pending: Vec::new(), has_missed: false, clock: None }
    }

    /// The same, following a clock (ns) in ticks of `tick_ns`.
    pub fn following(self, clock: Option<Arc<AtomicU64>>, tick_ns: u64) -> Self {
        Self { clock: clock.map(|it| (it, tick_ns)), ..self }
    }

    /// True if ticks wait for a controller or another simulator.
    pub fn is_lockstep(&self) -> bool {
        self.rules.is_on || self.clock.is_some()
    }

    /// Takes commands that arrived; `now_ns` is the simulated time.
    pub fn offer(&mut self, commands: Vec<Command>, now_ns: u64) {
        let now_ns = i64::try_from(now_ns).unwrap_or(i64::MAX);
        let is_release = |it: &Command| it.stamp_ns().is_some_and(|it| it == 0 || now_ns <= it);
        if commands.iter().any(is_release) {
            self.left = self.rules.steps_per_command;
            self.has_missed = false;
        }
        self.pending.extend(commands);
    }

    /// True if the next tick may begin. `is_requested` is true while a client waits for steps;
    /// `now_ns` is the simulated time.
    pub fn is_open(&self, is_requested: bool, now_ns: u64) -> bool {
        if is_requested {
            return true;
        }
        match &self.clock {
            Some((clock, tick_ns)) => now_ns + tick_ns <= clock.load(Ordering::Acquire),
            None => !self.rules.is_on || 0 < self.left,
        }
    }

    /// Drops the commands that arrived so far.
    pub fn forget(&mut self) {
        self.pending.clear();
        self.left = 0;
    }

    /// Begins the next tick and returns its commands.
    pub fn pass(&mut self) -> Vec<Command> {
        if self.clock.is_some() {
            self.has_missed = false;
        }
        self.left = self.left.saturating_sub(1);
        std::mem::take(&mut self.pending)
    }

    /// A tick has waited for `waited_s` of wall time. Returns once what to do about it.
    pub fn miss(&mut self, waited_s: f64) -> Option<Missed> {
        let is_late = self.rules.timeout.is_some_and(|timeout| timeout < waited_s);
        if self.has_missed || !is_late {
            return None;
        }
        self.has_missed = true;
        Some(match self.rules.on_timeout {
            OnTimeout::Hold => Missed::Log,
            OnTimeout::Pause => Missed::Pause,
            OnTimeout::End => Missed::End,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joints(stamp_ns: i64) -> Vec<Command> {
        vec![Command::Joints { stamp_ns, names: Vec::new(), positions: Vec::new() }]
    }

    /// Oracle: the contract. Only a command stamped not before now opens the gate, for as many ticks
    /// as the rules say; earlier commands act in the first of them.
    #[test]
    fn stamped_commands_release_ticks() {
        let mut gate = Gate::new(Lockstep { is_on: true, steps_per_command: 2, ..Lockstep::OFF });
        gate.offer(vec![Command::Vacuum { gauge_pa: -1.0 }], 5_000_000);
        gate.offer(joints(4_999_999), 5_000_000);
        assert!(!gate.is_open(false, 0), "no stamp, or a stamp in the past");
        assert!(gate.is_open(true, 0), "requested steps do not wait");
        gate.offer(joints(5_000_000), 5_000_000);
        assert!(gate.is_open(false, 0));
        assert_eq!(gate.pass().len(), 3, "all of them, in one tick");
        assert!(gate.is_open(false, 0));
        assert!(gate.pass().is_empty());
        assert!(!gate.is_open(false, 0), "two ticks have run");
    }

    /// Oracle: the contract. No tick ends beyond the other clock.
    #[test]
    fn ticks_follow_external_clock() {
        let clock = Arc::new(AtomicU64::new(0));
        let gate = Gate::new(Lockstep { follows_clock: true, ..Lockstep::OFF });
        let gate = gate.following(Some(Arc::clone(&clock)), 1_000_000);
        assert!(gate.is_lockstep() && !gate.is_open(false, 0));
        clock.store(2_500_000, Ordering::Release);
        let open: Vec<bool> = (0..3).map(|tick| gate.is_open(false, tick * 1_000_000)).collect();
        assert_eq!(open, [true, true, false]);
    }

    /// Oracle: the contract. A missed command is reported once, until one arrives.
    #[test]
    fn missed_command_is_reported_once() {
        let rules = Lockstep { is_on: true, timeout: Some(0.5), ..Lockstep::OFF };
        let mut gate = Gate::new(Lockstep { on_timeout: OnTimeout::Pause, ..rules });
        assert_eq!(gate.miss(0.4), None);
        assert_eq!(gate.miss(0.6), Some(Missed::Pause));
        assert_eq!(gate.miss(0.7), None);
        gate.offer(joints(0), 1);
        assert_eq!(gate.miss(0.6), Some(Missed::Pause));
    }
}
