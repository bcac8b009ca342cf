//! Co-simulation of granular jamming grippers: grains in a flexible membrane, rigid objects, and
//! vacuum as a command.
//!
//! This program fills a coarse gripper, evacuates it, and prints the force on its mount:
//!
//! ```
//! use jamgrip::{Command, Parts, Scene, Session, ThreadPool};
//!
//! fn main() -> Result<(), jamgrip::Error> {
//!     let scene = Scene::builder()
//!         .set("grains.count", 280)
//!         .set("grains.radius_min", "3.8 mm")
//!         .set("grains.radius_max", "4.2 mm")
//!         .set("membrane.frequency", 8)
//!         .build()?;
//!     let pool = ThreadPool::new(2)?;
//!     let mut session = Session::new(&scene, &pool)?;
//!     session.tick(&[Command::Vacuum { gauge_pa: -90e3 }])?;
//!     for _ in 1..10 {
//!         session.tick(&[])?;
//!     }
//!     let snapshot = session.snapshot(Parts::default());
//!     let (pressure, force) = (snapshot.chamber.gauge, snapshot.mount_wrench.force);
//!     println!("{:.1} kPa, {:.2} N on the mount", pressure / 1e3, force.z);
//!     assert!(pressure < -10e3 && force.z < 0.0);
//!     Ok(())
//! }
//! ```
//!
//! [`Scene`] describes the gripper, [`Session`] runs it, [`Command`] controls it between two
//! ticks, [`Change`] makes discontinuous changes, and [`Snapshot`] holds the results.
//! `examples/gripper.rs` pushes a gripper onto an object and evacuates it.
//!
//! All numbers are SI, angles are in radians, and gauge pressure is negative under vacuum.
//!
//! # Features
//!
//! All features are on by default. Without them the crate is the simulation alone.
//!
//! | feature | adds |
//! |---|---|
//! | `ros` | the ROS 2 node |
//! | `shm` | streams in shared memory |
//! | `bag` | recordings |
//! | `meshes` | objects from OBJ, STL and URDF files |
//! | `report` | plots and reports of experiments |
//! | `cli` | the program `jamgrip`; its experiments and benchmarks need `report` too |
//!
//! # Modules
//!
//! The list of modules in `src/lib.rs` is also the order of dependency: a module uses only modules
//! listed above it. `tests/architecture` checks that.

pub mod base; // vectors, ticks, digests, random streams, threads, SIMD lanes
pub mod scene; // text to checked numbers
pub mod physics; // grains, membrane, chamber
pub mod measure; // what a state shows
pub mod cosim; // one tick of the coupled system
pub mod command; // inputs of a session
pub mod session; // one run in memory
pub mod snapshot; // outputs of a session
pub mod error; // one error for all of the above
pub mod controller; // the built-in pick-and-lift controller
pub mod experiments; // validation experiments, divided into cases
pub mod host; // clock, signals, files, terminal
#[cfg(feature = "report")]
pub mod report; // pages and plots
#[cfg(all(feature = "cli", feature = "report"))]
pub mod runner; // runs experiments: threads, files, reports
#[cfg(feature = "node")]
pub mod wire; // ROS 2 messages and their encoding
#[cfg(feature = "node")]
pub mod io; // sinks, sources and their queues
#[cfg(feature = "ros")]
pub mod ros; // the ROS 2 node
#[cfg(feature = "shm")]
pub mod shm; // zero-copy streams
#[cfg(feature = "bag")]
pub mod bag; // recordings, written and read
#[cfg(feature = "node")]
pub mod simulator; // simulation_interfaces and gripper services
#[cfg(feature = "node")]
pub mod node; // the running node
#[cfg(feature = "bag")]
pub mod replay; // plays, verifies and branches recordings
#[cfg(all(feature = "cli", feature = "report"))]
pub mod benchmarks; // performance cases

pub use base::parallel::ThreadPool;
pub use command::{Command, change::Change};
pub use error::Error;
pub use scene::Scene;
pub use session::Session;
pub use snapshot::{Parts, Snapshot};
