//! All integration tests, in one binary.
#![expect(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

#[cfg(feature = "bag")]
mod bags; // recordings, read back by independent libraries
#[cfg(feature = "bag")]
mod bags_damaged; // damaged recordings and their repair
#[cfg(feature = "bag")]
mod bags_played; // playing recordings
mod bench; // how fast it is told to be
mod book; // links of the documentation, and pages made from the code
mod by_tick; // a made-up system whose numbers follow from its tick
mod changes; // back to the start, in, out and elsewhere
mod coarse; // a coarse gripper for tests of the physics
mod commands; // commands from ROS 2 messages
mod coupling; // action equals reaction
mod determinism; // the same bits every time
mod fanout; // sinks behind their queues: order, drops, failure, closing
mod generated_types; // msgs/*.msg and the Rust types agree
mod grains; // one, two and three grains
mod gripper; // the gripper experiment, coarse
mod hollow_sphere; // an object in an evacuated shell of grains
mod runner; // experiments: in parallel, stopped and resumed, result files
mod leaks; // what comes through the membranes
mod lifts; // whole runs: what is lifted, and what is not
#[cfg(feature = "ros")]
mod main_job; // the main job, commanded from other processes
#[cfg(feature = "ros")]
mod mock_run; // a whole run with a mock plant
mod oscillator; // a small experiment whose results are known in closed form
mod packings; // periodic boxes and dense packings
mod peers; // independent programs in Python
#[cfg(feature = "ros")]
mod private_network; // a network namespace for DDS tests
#[cfg(feature = "bag")]
mod replays; // recordings verified, branched, and used as commands
mod rig; // a bare model by hand
mod ros_layouts; // layouts of viewers refer to existing topics
#[cfg(feature = "ros")]
mod ros_loop; // published messages and received commands
#[cfg(all(feature = "ros", feature = "bag"))]
mod ros_floods; // ten thousand commands a second
#[cfg(feature = "ros")]
mod ros_gripper; // interfaces of gripper drivers, and ticks that wait for a controller
#[cfg(feature = "ros")]
mod ros_program; // the whole program, and clients of its services
#[cfg(feature = "ros")]
mod ros_qos; // quality of service
#[cfg(feature = "ros")]
mod ros_simulator; // the simulator services
#[cfg(feature = "ros")]
mod ros_worlds; // loading scenes and spawning objects
mod setpoints; // how commands become setpoints
mod scenes; // scenes that run, scenes that are refused
mod sheet; // a grain on the membrane
mod spheres; // grains on the spheres of the classic membrane
#[cfg(feature = "shm")]
mod stream; // streams in shared memory
mod synthetic; // a scene and snapshots made up for tests
mod triaxial; // a small specimen under confining pressure
