//! Flange and objects: frames, and the gripper as joints.

use super::{FLANGE, MEMBRANE, WORLD, parts};
use crate::{
    base::{Mat3, Pose, Real, Vec3},
    command::JOINTS,
    scene::Chamber,
    snapshot::{ChamberSnapshot, Snapshot},
    wire::messages::{sensor_msgs::JointState, tf2_msgs::TFMessage},
};

/// world → gripper_flange and world → object/<name>.
pub(super) fn frames(snapshot: &Snapshot) -> TFMessage {
    let time_ns = snapshot.time_ns;
    let flange = parts::transform(WORLD, FLANGE.to_owned(), &snapshot.flange.pose, time_ns);
    let objects = snapshot.objects.iter().map(|object| {
        let frame = format!("object/{}", object.name);
        parts::transform(WORLD, frame, &object.body.pose, time_ns)
    });
    TFMessage { transforms: std::iter::once(flange).chain(objects).collect() }
}

/// gripper_flange → membrane: the identity, because the flange frame lies in the plane of the rim.
pub(super) fn static_frames(time_ns: u64) -> TFMessage {
    let membrane = parts::transform(FLANGE, MEMBRANE.to_owned(), &Pose::identity(), time_ns);
    TFMessage { transforms: vec![membrane] }
}

/// The gripper as joints, for robot tools.
///
/// `vacuum`: position 0 is vented, 1 is the strongest vacuum of the pump; the effort is the gauge
/// pressure (Pa). `flange_x` … `flange_yaw`: the pose of the flange in the world (m, rad) as three
/// prismatic and three revolute joints (rotations about the fixed axes x, y, z); the effort is the
/// force or torque with which these joints hold the gripper (N, N m).
pub(super) fn joint_states(snapshot: &Snapshot, chamber: &Chamber) -> JointState {
    let pose = &snapshot.flange.pose;
    let (roll, pitch, yaw) = pose.rotation.euler_angles();
    let p = pose.translation.vector;
    let v = snapshot.flange.twist.linear;
    let axes = rotation_axes(pitch, yaw);
    let angle_rates = axes
        .try_inverse() // singular if two axes coincide; the rates are undefined there
        .map_or(Vec3::zeros(), |inverse| inverse * snapshot.flange.twist.angular);
    let force = -(pose.rotation * snapshot.mount_wrench.force);
    let torque = -(axes.transpose() * (pose.rotation * snapshot.mount_wrench.torque));
    let air = &snapshot.chamber;
    JointState {
        header: parts::header(snapshot.time_ns, WORLD),
        name: JOINTS.map(str::to_owned).to_vec(),
        position: vec![vacuum_fraction(air.gauge, chamber), p.x, p.y, p.z, roll, pitch, yaw],
        velocity: [&[vacuum_rate(air, chamber)], v.as_slice(), angle_rates.as_slice()].concat(),
        effort: [&[air.gauge], force.as_slice(), torque.as_slice()].concat(),
    }
}

/// Axes of roll, pitch and yaw in the world, as columns.
fn rotation_axes(pitch: Real, yaw: Real) -> Mat3 {
    let roll_axis = Vec3::new(yaw.cos() * pitch.cos(), yaw.sin() * pitch.cos(), -pitch.sin());
    let pitch_axis = Vec3::new(-yaw.sin(), yaw.cos(), 0.0);
    Mat3::from_columns(&[roll_axis, pitch_axis, Vec3::z()])
}

/// Fraction of the pump's strongest vacuum; 0 for a pump without vacuum.
fn vacuum_fraction(gauge: Real, chamber: &Chamber) -> Real {
    if chamber.gauge_min < 0.0 { gauge / chamber.gauge_min } else { 0.0 }
}

/// Rate of `vacuum_fraction` (1/s), from the law of the pressure: first-order lag with a limited
/// rate.
fn vacuum_rate(air: &ChamberSnapshot, chamber: &Chamber) -> Real {
    let difference = air.gauge_setpoint - air.gauge;
    let rate = if 0.0 < chamber.lag { difference / chamber.lag } else { 0.0 };
    vacuum_fraction(rate.clamp(-chamber.rate_max, chamber.rate_max), chamber)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Quat;

    #[test]
    fn angle_rates_match_the_angles() {
        // Oracle: finite differences of the angles of a body that rotates with a known velocity.
        let (roll, pitch, yaw) = (0.3, -0.4, 1.1);
        let angular_velocity = Vec3::new(0.2, -0.5, 0.7);
        let rates = rotation_axes(pitch, yaw).try_inverse().unwrap() * angular_velocity;
        let dt = 1e-6;
        let later = Quat::from_scaled_axis(angular_velocity * dt)
            * Quat::from_euler_angles(roll, pitch, yaw);
        let (roll_later, pitch_later, yaw_later) = later.euler_angles();
        let measured = Vec3::new(roll_later - roll, pitch_later - pitch, yaw_later - yaw) / dt;
        // Tolerance: the error of a one-sided difference is of the order of dt.
        assert!((rates - measured).norm() < 1e-5, "{rates} is not {measured}");
    }
}
