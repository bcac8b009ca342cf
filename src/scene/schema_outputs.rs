//! The keys of `outputs` in a scene file.

use super::{
    Bag, BagCompression, OnError, OnFull, Outputs, Ros,
    quantity::{FREQUENCY, TIME},
    schema::integer_usize,
    visit::{Quantity, Range, Visitor},
};

/// Visits all keys of `outputs`.
pub(super) fn outputs(walk: &mut impl Visitor, outputs: &mut Outputs) {
    let rate = Quantity::above_zero(&FREQUENCY);
    walk.doc("Rate of wrenches, poses, twists, joint states and tf.");
    walk.quantity("state_rate", rate, &mut outputs.state_rate);
    walk.doc("Rate of pressure and vacuum state.");
    walk.quantity("pressure_rate", rate, &mut outputs.pressure_rate);
    walk.doc("Rate of the membrane cloud and marker.");
    walk.quantity("membrane_rate", rate, &mut outputs.membrane_rate);
    walk.doc("Rate of the grain cloud.");
    walk.quantity("grains_rate", rate, &mut outputs.grains_rate);
    walk.doc("Rate of contacts and their markers.");
    walk.quantity("contacts_rate", rate, &mut outputs.contacts_rate);
    walk.doc("Rate of statistics and diagnostics.");
    walk.quantity("statistics_rate", rate, &mut outputs.statistics_rate);
    walk.doc("Maximum number of grains in one message; larger packings are thinned out.");
    integer_usize(walk, "grains_count_max", (1, 1_000_000), &mut outputs.grains_count_max);
    walk.doc("The ROS 2 node.");
    walk.section("ros", |walk| ros(walk, &mut outputs.ros));
    walk.doc("Publish shared memory streams (iceoryx2).");
    walk.flag("stream", &mut outputs.stream);
    walk.doc("The recording.");
    walk.section("bag", |walk| bag(walk, &mut outputs.bag));
    walk.doc("Do not run faster than real time.");
    walk.flag("real_time", &mut outputs.real_time);
}

fn ros(walk: &mut impl Visitor, ros: &mut Ros) {
    walk.doc("Start the ROS 2 node.");
    walk.flag("enabled", &mut ros.enabled);
    let mut domain = ros.domain_id.map(u64::from);
    // DDS derives UDP ports from the domain; above 232 they do not fit.
    walk.doc("DDS domain; `auto` takes `ROS_DOMAIN_ID`, or 0.");
    walk.integer_or("domain_id", "auto", 232, &mut domain);
    ros.domain_id = domain.and_then(|it| u16::try_from(it).ok());
    walk.doc("Discover nodes on the local network, not only on this host.");
    walk.flag("lan", &mut ros.lan);
    walk.doc("Full name of the node.");
    walk.text("node", &mut ros.node);
    let mut version = ros.interfaces_version.map(u64::from);
    walk.doc(
        "Wire format of `simulation_interfaces`, 1 or 2; `auto` takes that of `ROS_DISTRO`, or 2.",
    );
    walk.integer_or("interfaces_version", "auto", 2, &mut version);
    ros.interfaces_version = version.and_then(|it| u8::try_from(it).ok());
    walk.doc(
        "Second prefix under which the services of `simulation_interfaces` are offered, such as \
         `/gzserver`.",
    );
    walk.text_or("interfaces_prefix", "none", &mut ros.interfaces_prefix);
    walk.doc("Keep simulated time running through resets.");
    walk.flag("monotonic_clock", &mut ros.monotonic_clock);
}

fn bag(walk: &mut impl Visitor, bag: &mut Bag) {
    walk.doc("Record the run.");
    walk.flag("enabled", &mut bag.enabled);
    let mut folder = bag.folder.as_ref().map(|it| it.to_string_lossy().into_owned());
    walk.doc("Folder of the recording; `auto` makes `bags/SCENE_TIME`.");
    walk.text_or("folder", "auto", &mut folder);
    bag.folder = folder.map(Into::into);
    let on_full = match bag.on_full {
        OnFull::Wait => "wait",
        OnFull::DropOldest => "drop_oldest",
    };
    walk.doc("When the disk is too slow: wait for it, or drop the oldest messages.");
    bag.on_full = match walk.choice("on_full", &["wait", "drop_oldest"], on_full) {
        "wait" => OnFull::Wait,
        _ => OnFull::DropOldest,
    };
    let on_error = match bag.on_error {
        OnError::Continue => "continue",
        OnError::Stop => "stop",
    };
    walk.doc("When writing fails: continue without recording, or end the run.");
    bag.on_error = match walk.choice("on_error", &["continue", "stop"], on_error) {
        "stop" => OnError::Stop,
        _ => OnError::Continue,
    };
    let rate = Quantity { dimension: &FREQUENCY, range: Range::AboveUpTo(0.0, 1e6) };
    walk.doc(
        "Rate of checkpoints, from which a run can be resumed or verified; `never` keeps only the \
         start.",
    );
    walk.quantity_or("checkpoint_rate", "never", rate, &mut bag.checkpoint_rate);
    let compression = match bag.compression {
        BagCompression::Zstd => "zstd",
        BagCompression::Lz4 => "lz4",
        BagCompression::Uncompressed => "none",
    };
    walk.doc("Compression of the messages.");
    bag.compression = match walk.choice("compression", &["zstd", "lz4", "none"], compression) {
        "lz4" => BagCompression::Lz4,
        "none" => BagCompression::Uncompressed,
        _ => BagCompression::Zstd,
    };
    walk.doc("Size in MiB at which a new file is started.");
    walk.integer_or("split_mebibytes", "never", 1 << 30, &mut bag.split_size);
    let time = Quantity::above_zero(&TIME);
    walk.doc("Simulated time after which a new file is started.");
    walk.quantity_or("split_duration", "never", time, &mut bag.split_duration);
}
