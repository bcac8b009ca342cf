//! Reads the zero-copy streams of a run on this host and prints a summary once a second.
//!
//!     cargo run --release --example stream_subscriber
//!
//! It wakes after every tick, takes all waiting states, and reads grains and membrane in place, in
//! the memory that the run wrote them to. A number as argument sets the number of states after
//! which it stops. `JAMGRIP_STREAM_PREFIX` selects one of several runs.

use std::{
    error::Error,
    io::Write,
    time::{Duration, Instant},
};

use jamgrip::shm::{
    rows::StateRow,
    stream::{Services, prefix},
};

/// Totals since the last line of output.
struct Tally {
    since: Instant,
    n_states: u64,
    n_missed: u64,
    n_lists: u64,
    last: StateRow,
    lowest_grain_m: f64,
    lowest_vertex_m: f64,
}

#[expect(clippy::disallowed_methods, reason = "a reader measures its own rate in wall-clock time")]
fn now() -> Instant {
    Instant::now()
}

fn main() -> Result<(), Box<dyn Error>> {
    let states_max = std::env::args().nth(1).map(|it| it.parse::<u64>()).transpose()?;
    let services = Services::join(&prefix())?;
    let tick = services.tick()?.listener_builder().create()?;
    let states = services.state()?.subscriber_builder().create()?;
    let grains = services.grains()?.subscriber_builder().create()?;
    let membrane = services.membrane()?.subscriber_builder().create()?;

    let mut total = 0;
    let mut tally = Tally::new(StateRow::default());
    while states_max.is_none_or(|max| total < max) {
        tick.timed_wait(|_| (), Duration::from_millis(100))?;
        while let Some(sample) = states.receive()? {
            tally.take(*sample);
            total += 1;
        }
        while let Some(sample) = grains.receive()? {
            let heights = sample.payload().iter().map(|it| it.position[2] - it.radius);
            tally.lowest_grain_m = heights.fold(f64::INFINITY, f64::min);
            tally.n_lists += 1;
        }
        while let Some(sample) = membrane.receive()? {
            let heights = sample.payload().iter().map(|it| it.position[2]);
            tally.lowest_vertex_m = heights.fold(f64::INFINITY, f64::min);
            tally.n_lists += 1;
        }
        if Duration::from_secs(1) <= now() - tally.since {
            tally.print(&mut std::io::stdout().lock())?;
            tally = Tally::new(tally.last);
        }
    }
    tally.print(&mut std::io::stdout().lock())?;
    Ok(())
}

impl Tally {
    fn new(last: StateRow) -> Self {
        Self {
            since: now(),
            n_states: 0,
            n_missed: 0,
            n_lists: 0,
            last,
            lowest_grain_m: f64::INFINITY,
            lowest_vertex_m: f64::INFINITY,
        }
    }

    fn take(&mut self, row: StateRow) {
        let is_next = self.last.tick == 0 || row.tick <= self.last.tick;
        self.n_missed += if is_next { 0 } else { row.tick - self.last.tick - 1 };
        self.n_states += 1;
        self.last = row;
    }

    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        let seconds = (now() - self.since).as_secs_f64();
        let count = u32::try_from(self.n_states).unwrap_or(u32::MAX);
        writeln!(
            out,
            "tick {} at {:.3} s: {:.0} states/s, {} missed, {} lists; object at {:.1} mm, push {:.2} N, \
             {:.1} kPa; {} grains down to {:.1} mm, {} vertices down to {:.1} mm",
            self.last.tick,
            Duration::from_nanos(self.last.time_ns).as_secs_f64(),
            f64::from(count) / seconds,
            self.n_missed,
            self.n_lists,
            self.last.object.position[2] * 1e3,
            self.last.contact_force[2],
            self.last.gauge * 1e-3,
            self.last.n_grains,
            self.lowest_grain_m * 1e3,
            self.last.n_vertices,
            self.lowest_vertex_m * 1e3,
        )?;
        out.flush()
    }
}
