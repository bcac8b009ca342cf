//! Pushes a coarse gripper onto an object, evacuates it, lifts it, and prints forces over time.
//!
//! ```text
//! cargo run --release --no-default-features --example gripper
//! ```

use std::io::Write;

use jamgrip::{
    Command, Parts, Scene, Session, Snapshot, ThreadPool,
    command::{PoseCommand, WORLD},
};

/// Grains twice as large as the default ones in a membrane with a mesh twice as coarse, above a
/// light cylinder.
const OVERRIDES: [(&str, &str); 10] = [
    ("grains.count", "280"),
    ("grains.radius_min", "3.8 mm"),
    ("grains.radius_max", "4.2 mm"),
    ("membrane.frequency", "8"),
    ("object.shape.cylinder.radius", "12 mm"),
    ("object.shape.cylinder.height", "50 mm"),
    ("object.position", "[0 mm, 0 mm, 25 mm]"),
    ("object.density", "1200 kg/m^3"),
    ("flange.position", "[0 mm, 0 mm, 101 mm]"),
    ("flange.speed_max", "500 mm/s"),
];
/// Flange height at the start, when pushed onto the object, and when lifted (m).
const HEIGHTS: [f64; 3] = [0.101, 0.070, 0.120];
/// Ticks between two lines of output.
const PRINT_EVERY: u64 = 50;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut builder = Scene::builder();
    for (key, value) in OVERRIDES {
        builder = builder.set(key, value);
    }
    let scene = builder.build()?;
    let mut session = Session::new(&scene, &ThreadPool::new(2)?)?;
    let [start, pushed, lifted] = HEIGHTS;
    let mut out = std::io::stdout().lock();
    writeln!(out, "  time   pressure  force on gripper  object height")?;
    for tick in 0..1500_u64 {
        let command = match tick {
            0..500 => Some(flange_at(start + (pushed - start) * share(tick, 0, 300))),
            500 => Some(Command::Vacuum { gauge_pa: -90e3 }),
            800.. => Some(flange_at(pushed + (lifted - pushed) * share(tick, 800, 500))),
            _ => None,
        };
        session.tick(command.as_slice())?;
        if (tick + 1) % PRINT_EVERY == 0 {
            writeln!(out, "{}", line(&session.snapshot(Parts::default())))?;
        }
    }
    Ok(())
}

/// How much of a motion of `duration` ticks is done, from 0 to 1.
fn share(tick: u64, start: u64, duration: u32) -> f64 {
    let elapsed = u32::try_from(tick - start).unwrap_or(u32::MAX);
    (f64::from(elapsed) / f64::from(duration)).min(1.0)
}

/// A command that moves the flange to a height above the table (m).
fn flange_at(height: f64) -> Command {
    Command::FlangePose(PoseCommand {
        frame_id: WORLD.to_owned(),
        stamp_ns: 0,
        position: [0.0, 0.0, height],
        orientation: [0.0, 0.0, 0.0, 1.0],
    })
}

fn line(snapshot: &Snapshot) -> String {
    let milliseconds = snapshot.time_ns / 1_000_000;
    let pressure = snapshot.chamber.gauge / 1e3;
    let force = snapshot.contact_force_world().z;
    let height = snapshot.objects[0].body.pose.translation.vector.z * 1e3;
    format!("{milliseconds:4} ms  {pressure:5.1} kPa  {force:14.2} N  {height:10.1} mm")
}
