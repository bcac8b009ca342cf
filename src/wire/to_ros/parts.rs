//! Common parts of messages: stamps, headers, vectors, poses, wrenches.

use crate::{
    base::{
        Pose, Quat, Vec3,
        real::{Twist, Wrench},
    },
    wire::messages::{builtin_interfaces, geometry_msgs as ros, std_msgs},
};

/// Simulation time as a ROS time.
pub(super) fn time(time_ns: u64) -> builtin_interfaces::Time {
    #[expect(clippy::cast_possible_truncation, reason = "68 years of simulation time")]
    builtin_interfaces::Time {
        sec: (time_ns / 1_000_000_000) as i32,
        nanosec: (time_ns % 1_000_000_000) as u32,
    }
}

/// A time span as a ROS duration.
pub(super) fn duration(seconds: f64) -> builtin_interfaces::Duration {
    #[expect(clippy::cast_possible_truncation, reason = "seconds between two messages")]
    #[expect(clippy::cast_sign_loss, reason = "a fraction is not negative")]
    builtin_interfaces::Duration {
        sec: seconds.floor() as i32,
        nanosec: (seconds.fract() * 1e9) as u32,
    }
}

/// A header with time stamp and frame.
pub(super) fn header(time_ns: u64, frame_id: &str) -> std_msgs::Header {
    std_msgs::Header { stamp: time(time_ns), frame_id: frame_id.to_owned() }
}

/// A direction or a force.
pub(super) fn vector(v: &Vec3) -> ros::Vector3 {
    ros::Vector3 { x: v.x, y: v.y, z: v.z }
}

/// A point.
pub(super) fn point(v: &Vec3) -> ros::Point {
    ros::Point { x: v.x, y: v.y, z: v.z }
}

/// A rotation.
pub(super) fn quaternion(q: &Quat) -> ros::Quaternion {
    ros::Quaternion { x: q.i, y: q.j, z: q.k, w: q.w }
}

/// A pose in a frame.
pub(super) fn pose(pose: &Pose, time_ns: u64, frame_id: &str) -> ros::PoseStamped {
    ros::PoseStamped {
        header: header(time_ns, frame_id),
        pose: ros::Pose {
            position: point(&pose.translation.vector),
            orientation: quaternion(&pose.rotation),
        },
    }
}

/// A velocity along the axes of a frame.
pub(super) fn twist(twist: &Twist, time_ns: u64, frame_id: &str) -> ros::TwistStamped {
    ros::TwistStamped {
        header: header(time_ns, frame_id),
        twist: ros::Twist { linear: vector(&twist.linear), angular: vector(&twist.angular) },
    }
}

/// A force and a torque along the axes of a frame.
pub(super) fn wrench(wrench: &Wrench, time_ns: u64, frame_id: &str) -> ros::WrenchStamped {
    ros::WrenchStamped {
        header: header(time_ns, frame_id),
        wrench: ros::Wrench { force: vector(&wrench.force), torque: vector(&wrench.torque) },
    }
}

/// A frame relative to its parent.
pub(super) fn transform(
    parent: &str,
    child: String,
    pose: &Pose,
    time_ns: u64,
) -> ros::TransformStamped {
    ros::TransformStamped {
        header: header(time_ns, parent),
        child_frame_id: child,
        transform: ros::Transform {
            translation: vector(&pose.translation.vector),
            rotation: quaternion(&pose.rotation),
        },
    }
}
