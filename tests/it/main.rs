//! All integration tests, in one binary.
#![expect(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

#[cfg(feature = "bag")]
mod bags; // recordings, read back by independent libraries
#[cfg(feature = "bag")]
mod bags_damaged; // killed, cut off, full disks, and what is saved of it
#[cfg(feature = "bag")]
mod bags_played; // a recording published again
mod bench; // the benchmark command
mod book; // links of the documentation, and generated pages
mod by_tick; // a synthetic system whose numbers follow from its tick
mod changes; // reset, insert, remove, teleport
mod coarse; // a coarse gripper for tests of the physics
mod commands; // commands from ROS 2 messages
mod coupling; // balance of forces and momentum
mod determinism; // runs are reproducible bit for bit
mod fanout; // sinks and their queues: order, drops, failure, closing
mod generated_types; // Rust types match msgs/
mod grains; // one, two and three grains
mod gripper; // the gripper experiment, coarse
mod hollow_sphere; // an object in an evacuated shell of grains
mod lab; // experiments: side by side, stopped and resumed, told in files
mod leaks; // grains that pass through a membrane
mod lifts; // complete pick-and-lift runs
#[cfg(feature = "ros")]
mod main_job; // pick-and-lift, commanded by other processes
mod membrane; // a grain on the membrane
#[cfg(feature = "ros")]
mod mock_run; // a complete run with a mock plant
mod oscillator; // a small experiment with closed-form results
mod packings; // periodic boxes and dense packings
mod peers; // independent programs in Python
#[cfg(feature = "ros")]
mod private_network; // where tests may speak DDS
#[cfg(feature = "bag")]
mod replays; // recordings simulated again, branched off, and taken as commands
mod rig; // a bare system without a scene
mod ros_layouts; // layouts for viewers name topics that there are
#[cfg(feature = "ros")]
mod ros_loop; // what goes out reaches others, what others say comes in
#[cfg(all(feature = "ros", feature = "bag"))]
mod ros_floods; // ten thousand commands a second
#[cfg(feature = "ros")]
mod ros_gripper; // what drivers of grippers offer, and ticks that wait for a controller
#[cfg(feature = "ros")]
mod ros_program; // the program and clients of its services
#[cfg(feature = "ros")]
mod ros_qos; // who hears what
#[cfg(feature = "ros")]
mod ros_simulator; // what ROS 2 users ask of a simulator
#[cfg(feature = "ros")]
mod ros_worlds; // another scene while the program runs
mod setpoints; // how commands become setpoints
mod scenes; // valid and invalid scenes
mod spheres; // grains on a membrane of vertex spheres
#[cfg(feature = "shm")]
mod stream; // what other processes read in shared memory
mod synthetic; // a synthetic scene and snapshots
mod triaxial; // a small specimen under confining pressure
