//! Ticks that wait for a controller: a command stamped not before the present time lets some pass.
//! Or for another simulator: a tick begins when its end is not beyond that one's clock.
//!
//! Commands that come while a tick waits are kept for it in the order of arrival, so a controller
//! that sends everything before its stamped command knows at which tick it acts: the next one.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use crate::{
    command::Command,
    scene::{Lockstep, OnTimeout},
};

/// Whether the next tick may begin.
pub struct Gate {
    rules: Lockstep,
    /// Ticks that may still pass.
    left: u64,
    pending: Vec<Command>,
    has_missed: bool,
    /// The other simulator's clock, and the length of a tick (ns).
    clock: Option<(Arc<AtomicU64>, u64)>,
}

/// What a missed command leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missed {
    /// It is said, nothing else.
    Said,
    /// The simulation is paused.
    Paused,
    /// The run ends.
    Ended,
}

impl Gate {
    /// A gate with these rules.
    pub fn new(rules: Lockstep) -> Self {
        Self { rules, left: 0, pending: Vec::new(), has_missed: false, clock: None }
    }

    /// The same that follows a clock (ns), in ticks of `tick_ns`.
    pub fn following(self, clock: Option<Arc<AtomicU64>>, tick_ns: u64) -> Self {
        Self { clock: clock.map(|it| (it, tick_ns)), ..self }
    }

    /// True if ticks wait for others.
    pub fn is_lockstep(&self) -> bool {
        self.rules.is_on || self.clock.is_some()
    }

    /// Takes commands that came; `now_ns` is the simulated time.
    pub fn offer(&mut self, commands: Vec<Command>, now_ns: u64) {
        let now_ns = i64::try_from(now_ns).unwrap_or(i64::MAX);
        let is_answer = |it: &Command| it.stamp_ns().is_some_and(|it| it == 0 || now_ns <= it);
        if commands.iter().any(is_answer) {
            self.left = self.rules.steps_per_command;
            self.has_missed = false;
        }
        self.pending.extend(commands);
    }

    /// True if the next tick may begin; `is_asked_for` says that someone waits for steps, `now_ns` is
    /// the simulated time.
    pub fn is_open(&self, is_asked_for: bool, now_ns: u64) -> bool {
        if is_asked_for {
            return true;
        }
        match &self.clock {
            Some((clock, tick_ns)) => now_ns + tick_ns <= clock.load(Ordering::Acquire),
            None => !self.rules.is_on || 0 < self.left,
        }
    }

    /// What came so far is not for the next tick.
    pub fn forget(&mut self) {
        self.pending.clear();
        self.left = 0;
    }

    /// The next tick begins, under these commands.
    pub fn pass(&mut self) -> Vec<Command> {
        if self.clock.is_some() {
            self.has_missed = false;
        }
        self.left = self.left.saturating_sub(1);
        std::mem::take(&mut self.pending)
    }

    /// A tick has waited for `waited_s` of wall time; says once what that leads to.
    pub fn miss(&mut self, waited_s: f64) -> Option<Missed> {
        let is_late = self.rules.timeout.is_some_and(|timeout| timeout < waited_s);
        if self.has_missed || !is_late {
            return None;
        }
        self.has_missed = true;
        Some(match self.rules.on_timeout {
            OnTimeout::Hold => Missed::Said,
            OnTimeout::Pause => Missed::Paused,
            OnTimeout::End => Missed::Ended,
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
    /// as the rules say; what came before it acts in the first of them.
    #[test]
    fn stamped_commands_let_ticks_pass() {
        let mut gate = Gate::new(Lockstep { is_on: true, steps_per_command: 2, ..Lockstep::OFF });
        gate.offer(vec![Command::Vacuum { gauge_pa: -1.0 }], 5_000_000);
        gate.offer(joints(4_999_999), 5_000_000);
        assert!(!gate.is_open(false, 0), "no stamp, or one of the past");
        assert!(gate.is_open(true, 0), "steps that are asked for wait for nobody");
        gate.offer(joints(5_000_000), 5_000_000);
        assert!(gate.is_open(false, 0));
        assert_eq!(gate.pass().len(), 3, "all of them, in one tick");
        assert!(gate.is_open(false, 0));
        assert!(gate.pass().is_empty());
        assert!(!gate.is_open(false, 0), "two ticks have passed");
    }

    /// Oracle: the contract. No tick ends beyond the other clock.
    #[test]
    fn ticks_follow_another_clock() {
        let clock = Arc::new(AtomicU64::new(0));
        let gate = Gate::new(Lockstep { follows_clock: true, ..Lockstep::OFF });
        let gate = gate.following(Some(Arc::clone(&clock)), 1_000_000);
        assert!(gate.is_lockstep() && !gate.is_open(false, 0));
        clock.store(2_500_000, Ordering::Release);
        let open: Vec<bool> = (0..3).map(|tick| gate.is_open(false, tick * 1_000_000)).collect();
        assert_eq!(open, [true, true, false]);
    }

    /// Oracle: the contract. A missed command is noticed once, until one comes.
    #[test]
    fn a_missed_command_is_noticed_once() {
        let rules = Lockstep { is_on: true, timeout: Some(0.5), ..Lockstep::OFF };
        let mut gate = Gate::new(Lockstep { on_timeout: OnTimeout::Pause, ..rules });
        assert_eq!(gate.miss(0.4), None);
        assert_eq!(gate.miss(0.6), Some(Missed::Paused));
        assert_eq!(gate.miss(0.7), None);
        gate.offer(joints(0), 1);
        assert_eq!(gate.miss(0.6), Some(Missed::Paused));
    }
}
