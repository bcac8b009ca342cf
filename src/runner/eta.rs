//! Estimates the remaining time of all cases from finished cases and the progress of running ones.

/// Fraction of a case below which its pace is not used.
const FRACTION_MIN: f64 = 0.01;

/// What is known about a case.
#[derive(Clone, Copy, Debug)]
struct Case {
    /// Index of its experiment.
    group: usize,
    /// Expected time before anything was measured (s).
    expected_s: Option<f64>,
    state: CaseState,
}

#[derive(Clone, Copy, Debug)]
enum CaseState {
    Waiting,
    Running {
        start_share: f64,
        share: f64,
        wall_s: f64,
    },
    /// Ended, with the time that it took if it ran in this process (s).
    Ended(Option<f64>),
}

/// An estimate for cases that run in parallel.
#[derive(Clone, Debug)]
pub struct TimeEstimate {
    n_threads: usize,
    cases: Vec<Case>,
}

impl TimeEstimate {
    /// Takes the cases in the order in which they are started, as group and expected time (s).
    pub fn new(n_threads: usize, cases: impl Iterator<Item = (usize, Option<f64>)>) -> Self {
        let case = |(group, expected_s)| Case { group, expected_s, state: CaseState::Waiting };
        Self { n_threads: n_threads.max(1), cases: cases.map(case).collect() }
    }

    /// Case `i` is running: its completed fraction at the start of this run and now, and the time
    /// between (s).
    pub fn running(&mut self, i: usize, start_share: f64, share: f64, wall_s: f64) {
        self.cases[i].state = CaseState::Running { start_share, share, wall_s };
    }

    /// Case `i` has ended, after this total time if it ran to its end (s).
    pub fn ended(&mut self, i: usize, took_s: Option<f64>) {
        self.cases[i].state = CaseState::Ended(took_s);
    }

    /// Number of ended cases.
    pub fn n_ended(&self) -> usize {
        self.cases.iter().filter(|case| matches!(case.state, CaseState::Ended(_))).count()
    }

    /// Fraction of the whole work that is done; cases are weighted by their expected times.
    pub fn share(&self) -> f64 {
        let (mut done, mut all) = (0.0, 0.0);
        for case in &self.cases {
            let weight = self.total_s(case).unwrap_or(1.0);
            all += weight;
            done += weight
                * match case.state {
                    CaseState::Waiting => 0.0,
                    CaseState::Running { share, .. } => share.clamp(0.0, 1.0),
                    CaseState::Ended(_) => 1.0,
                };
        }
        if all == 0.0 { 1.0 } else { done / all }
    }

    /// Remaining time of case `i` (s), if it can be estimated yet.
    pub fn remaining_of(&self, i: usize) -> Option<f64> {
        let case = &self.cases[i];
        match case.state {
            CaseState::Ended(_) => Some(0.0),
            CaseState::Waiting => self.total_s(case),
            CaseState::Running { share, .. } => Some(self.total_s(case)? * (1.0 - share).max(0.0)),
        }
    }

    /// Remaining time of all cases (s), if it can be estimated yet: a waiting case goes to the
    /// first free thread.
    pub fn remaining_s(&self) -> Option<f64> {
        let is = |wanted: bool, case: &Case| matches!(case.state, CaseState::Waiting) == wanted;
        let mut threads = vec![0.0_f64; self.n_threads];
        for is_waiting in [false, true] {
            for i in (0..self.cases.len()).filter(|&i| is(is_waiting, &self.cases[i])) {
                let remaining = self.remaining_of(i)?;
                let free_first =
                    threads.iter_mut().min_by(|a, b| a.total_cmp(b)).expect("at least one thread");
                *free_first += remaining;
            }
        }
        threads.into_iter().reduce(f64::max)
    }

    /// Total time of a case (s): from its own pace, else as expected, else like others of its
    /// group, else like all others.
    fn total_s(&self, case: &Case) -> Option<f64> {
        let mean_of = |group: Option<usize>| {
            let others = self.cases.iter().filter(|it| group.is_none_or(|group| it.group == group));
            let totals: Vec<f64> = others.filter_map(|it| pace_s(it.state)).collect();
            let n = totals.len();
            (0 < n).then(|| totals.into_iter().sum::<f64>() / n as f64)
        };
        pace_s(case.state)
            .or(case.expected_s)
            .or_else(|| mean_of(Some(case.group)))
            .or_else(|| mean_of(None))
    }
}

/// Total time of a case at its measured pace (s).
fn pace_s(state: CaseState) -> Option<f64> {
    match state {
        CaseState::Waiting => None,
        CaseState::Ended(took_s) => took_s,
        CaseState::Running { start_share, share, wall_s } => {
            (FRACTION_MIN <= share - start_share).then(|| wall_s / (share - start_share))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: Option<f64>, expected: f64) {
        // The tolerance is for the rounding of a few sums and quotients.
        let found = found.unwrap_or(f64::NAN);
        assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
    }

    /// Oracle: computed by hand. Two threads, four cases of one kind; a quarter of the first is
    /// done in 5 s, so each takes 20 s: 15 s on one thread, 20 s on the other, then the two waiting
    /// cases: 15 + 20 and 20 + 20.
    #[test]
    fn waiting_cases_are_estimated_from_running_ones() {
        let mut estimate = TimeEstimate::new(2, (0..4).map(|_| (0, None)));
        assert_eq!(estimate.remaining_s(), None, "nothing is known yet");
        estimate.running(0, 0.0, 0.25, 5.0);
        assert_close(estimate.remaining_of(0), 15.0);
        assert_close(estimate.remaining_of(3), 20.0);
        assert_close(estimate.remaining_s(), 40.0);
        assert_close(Some(estimate.share()), 0.25 / 4.0);
        estimate.ended(0, Some(18.0));
        estimate.ended(1, None);
        // Two cases wait, two threads are free, 18 s each.
        assert_close(estimate.remaining_s(), 18.0);
        assert_eq!(estimate.n_ended(), 2);
        assert_close(Some(estimate.share()), 0.5);
    }

    /// Oracle: computed by hand. Resumed at one half; another quarter took 10 s, so 10 s remain.
    #[test]
    fn a_resumed_case_is_estimated_from_its_present_pace() {
        let mut estimate = TimeEstimate::new(1, [(0, Some(300.0))].into_iter());
        assert_close(estimate.remaining_s(), 300.0);
        estimate.running(0, 0.5, 0.505, 1.0);
        // Its pace is not used yet: the expected time counts.
        assert_close(estimate.remaining_s(), 300.0 * 0.495);
        estimate.running(0, 0.5, 0.75, 10.0);
        assert_close(estimate.remaining_s(), 10.0);
    }

    #[test]
    fn no_cases_are_done() {
        let estimate = TimeEstimate::new(2, std::iter::empty());
        assert_close(estimate.remaining_s(), 0.0);
        assert_close(Some(estimate.share()), 1.0);
    }
}
