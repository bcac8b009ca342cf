//! A crate outside the tree: runs ten ticks of a coarse gripper and prints the force on its mount.

use jamgrip::{Command, Error, Parts, Scene, Session, ThreadPool};

fn main() -> Result<(), Error> {
    let scene = Scene::builder()
        .set("grains.count", 280)
        .set("grains.radius_min", "3.8 mm")
        .set("grains.radius_max", "4.2 mm")
        .set("membrane.frequency", 8)
        .build()?;
    let pool = ThreadPool::new(2)?;
    let mut session = Session::new(&scene, &pool)?;
    session.tick(&[Command::Vacuum { gauge_pa: -90e3 }])?;
    for _ in 1..10 {
        session.tick(&[])?;
    }
    let snapshot = session.snapshot(Parts::default());
    let (pressure, force) = (snapshot.chamber.gauge, snapshot.mount_wrench.force);
    println!("{:.1} kPa, {:.2} N on the mount", pressure / 1e3, force.z);
    assert_eq!(snapshot.tick.0, 10);
    Ok(())
}
