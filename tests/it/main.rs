//! All integration tests, in one binary.
#![expect(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

#[cfg(feature = "bag")]
mod bags; // recordings, read back by independent libraries
#[cfg(feature = "bag")]
mod bags_damaged; // damaged recordings and their repair
#[cfg(feature = "bag")]
mod bags_played; // playing recordings
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
mod runner; // experiments: in parallel, stopped and resumed, result files
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
mod private_network; // a network namespace for DDS tests
#[cfg(feature = "bag")]
mod replays; // recordings verified, branched, and used as commands
mod rig; // a bare system without a scene
mod ros_layouts; // layouts of viewers refer to existing topics
#[cfg(feature = "ros")]
mod ros_loop; // published messages and received commands
#[cfg(all(feature = "ros", feature = "bag"))]
mod ros_floods; // ten thousand commands a second
#[cfg(feature = "ros")]
mod ros_gripper; // interfaces of gripper drivers, and ticks that wait for a controller
#[cfg(feature = "ros")]
mod ros_program; // the program and clients of its services
#[cfg(feature = "ros")]
mod ros_qos; // quality of service
#[cfg(feature = "ros")]
mod ros_simulator; // the simulator services
#[cfg(feature = "ros")]
mod ros_worlds; // loading scenes and spawning objects
mod setpoints; // how commands become setpoints
mod scenes; // valid and invalid scenes
mod spheres; // grains on a membrane of vertex spheres
#[cfg(feature = "shm")]
mod stream; // streams in shared memory
mod synthetic; // a synthetic scene and snapshots
mod triaxial; // a small specimen under confining pressure
