//! When all cases will be done: from what the cases so far took and how far the running ones are.

/// Share of a case below which its pace says nothing yet.
const SHARE_MIN: f64 = 0.01;

/// What is known of one case.
#[derive(Clone, Copy, Debug)]
struct Case {
    /// Which experiment it belongs to.
    group: usize,
    /// Seconds that it was expected to take before anything was seen.
    expected_s: Option<f64>,
    stage: Stage,
}

#[derive(Clone, Copy, Debug)]
enum Stage {
    Waiting,
    Running {
        share_at_start: f64,
        share: f64,
        wall_s: f64,
    },
    /// With the time that it took, if it ran just now.
    Ended(Option<f64>),
}

/// Cases on threads.
#[derive(Clone, Debug)]
pub struct Forecast {
    n_threads: usize,
    cases: Vec<Case>,
}

impl Forecast {
    /// Cases in the order in which they are begun: their group, and how long they are expected to
    /// take (s).
    pub fn new(n_threads: usize, cases: impl Iterator<Item = (usize, Option<f64>)>) -> Self {
        let case = |(group, expected_s)| Case { group, expected_s, stage: Stage::Waiting };
        Self { n_threads: n_threads.max(1), cases: cases.map(case).collect() }
    }

    /// Case `i` runs: its share when it was begun now, its share now, and the time between (s).
    pub fn running(&mut self, i: usize, share_at_start: f64, share: f64, wall_s: f64) {
        self.cases[i].stage = Stage::Running { share_at_start, share, wall_s };
    }

    /// Case `i` has ended; how long it took as a whole (s), if it ran to its end.
    pub fn ended(&mut self, i: usize, took_s: Option<f64>) {
        self.cases[i].stage = Stage::Ended(took_s);
    }

    /// Cases that have ended.
    pub fn n_ended(&self) -> usize {
        self.cases.iter().filter(|case| matches!(case.stage, Stage::Ended(_))).count()
    }

    /// Share of the whole work that is done; cases count as long as they are expected to take.
    pub fn share(&self) -> f64 {
        let (mut done, mut all) = (0.0, 0.0);
        for case in &self.cases {
            let weight = self.whole_s(case).unwrap_or(1.0);
            all += weight;
            done += weight
                * match case.stage {
                    Stage::Waiting => 0.0,
                    Stage::Running { share, .. } => share.clamp(0.0, 1.0),
                    Stage::Ended(_) => 1.0,
                };
        }
        if all == 0.0 { 1.0 } else { done / all }
    }

    /// Time until case `i` is done (s), if that can be told yet.
    pub fn left_of(&self, i: usize) -> Option<f64> {
        let case = &self.cases[i];
        match case.stage {
            Stage::Ended(_) => Some(0.0),
            Stage::Waiting => self.whole_s(case),
            Stage::Running { share, .. } => Some(self.whole_s(case)? * (1.0 - share).max(0.0)),
        }
    }

    /// Time until all are done (s), if that can be told yet: waiting cases go to the thread that
    /// is free first.
    pub fn left_s(&self) -> Option<f64> {
        let is = |wanted: bool, case: &Case| matches!(case.stage, Stage::Waiting) == wanted;
        let mut threads = vec![0.0_f64; self.n_threads];
        for is_waiting in [false, true] {
            for i in (0..self.cases.len()).filter(|&i| is(is_waiting, &self.cases[i])) {
                let left = self.left_of(i)?;
                let free_first =
                    threads.iter_mut().min_by(|a, b| a.total_cmp(b)).expect("at least one thread");
                *free_first += left;
            }
        }
        threads.into_iter().reduce(f64::max)
    }

    /// How long a case takes as a whole (s): by its own pace, else as expected, else like the
    /// others of its group, else like all others.
    fn whole_s(&self, case: &Case) -> Option<f64> {
        let known = |group: Option<usize>| {
            let others = self.cases.iter().filter(|it| group.is_none_or(|group| it.group == group));
            let paces: Vec<f64> = others.filter_map(|it| pace_s(it.stage)).collect();
            let n = paces.len();
            (0 < n).then(|| paces.into_iter().sum::<f64>() / n as f64)
        };
        pace_s(case.stage)
            .or(case.expected_s)
            .or_else(|| known(Some(case.group)))
            .or_else(|| known(None))
    }
}

/// Time for a whole case at the pace seen (s).
fn pace_s(stage: Stage) -> Option<f64> {
    match stage {
        Stage::Waiting => None,
        Stage::Ended(took_s) => took_s,
        Stage::Running { share_at_start, share, wall_s } => {
            (SHARE_MIN <= share - share_at_start).then(|| wall_s / (share - share_at_start))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: Option<f64>, expected: f64) {
        // The tolerance is for the rounding of a few sums and quotients.
        let found = found.unwrap_or(f64::NAN);
        assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
    }

    /// Oracle: computed by hand. Two threads, four cases of one kind; the first has a quarter of
    /// its work done in 5 s, so each takes 20 s: 15 s on one thread, 20 s on the other, then the
    /// two that wait: 15 + 20 and 20 + 20.
    #[test]
    fn cases_that_wait_are_expected_to_take_as_long_as_those_that_run() {
        let mut forecast = Forecast::new(2, (0..4).map(|_| (0, None)));
        assert_eq!(forecast.left_s(), None, "nothing is known yet");
        forecast.running(0, 0.0, 0.25, 5.0);
        close(forecast.left_of(0), 15.0);
        close(forecast.left_of(3), 20.0);
        close(forecast.left_s(), 40.0);
        close(Some(forecast.share()), 0.25 / 4.0);
        forecast.ended(0, Some(18.0));
        forecast.ended(1, None);
        // Two wait, two threads are free, 18 s each.
        close(forecast.left_s(), 18.0);
        assert_eq!(forecast.n_ended(), 2);
        close(Some(forecast.share()), 0.5);
    }

    /// Oracle: computed by hand. Resumed at one half, a quarter more took 10 s: another 10 s.
    #[test]
    fn a_resumed_case_goes_on_at_the_pace_seen_now() {
        let mut forecast = Forecast::new(1, [(0, Some(300.0))].into_iter());
        close(forecast.left_s(), 300.0);
        forecast.running(0, 0.5, 0.505, 1.0);
        // Its pace says nothing yet: as expected before.
        close(forecast.left_s(), 300.0 * 0.495);
        forecast.running(0, 0.5, 0.75, 10.0);
        close(forecast.left_s(), 10.0);
    }

    #[test]
    fn nothing_to_do_is_done() {
        let forecast = Forecast::new(2, std::iter::empty());
        close(forecast.left_s(), 0.0);
        close(Some(forecast.share()), 1.0);
    }
}
