//! ROS 2 message types: generated from `msgs/`, never edited by hand.
//!
//! `tests/it/generated_types.rs` writes this file and tests that it is up to date.

/// Messages of `builtin_interfaces`.
pub mod builtin_interfaces {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `builtin_interfaces/msg/Duration`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Duration {
        /// `int32 sec`
        pub r#sec: i32,
        /// `uint32 nanosec`
        pub r#nanosec: u32,
    }

    impl RosMessage for Duration {
        const TYPE: MessageType = MessageType {
            name: "builtin_interfaces/msg/Duration",
            dds_name: "builtin_interfaces::msg::dds_::Duration_",
            type_hash: "RIHS01_e8d009f659816f758b75334ee1a9ca5b5c0b859843261f14c7f937349599d93b",
            definition: r##"int32 sec
uint32 nanosec
"##,
        };
    }

    /// `builtin_interfaces/msg/Time`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Time {
        /// `int32 sec`
        pub r#sec: i32,
        /// `uint32 nanosec`
        pub r#nanosec: u32,
    }

    impl RosMessage for Time {
        const TYPE: MessageType = MessageType {
            name: "builtin_interfaces/msg/Time",
            dds_name: "builtin_interfaces::msg::dds_::Time_",
            type_hash: "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197",
            definition: r##"int32 sec
uint32 nanosec
"##,
        };
    }
}

/// Messages of `diagnostic_msgs`.
pub mod diagnostic_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `diagnostic_msgs/msg/DiagnosticArray`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct DiagnosticArray {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `diagnostic_msgs/DiagnosticStatus[] status`
        pub r#status: Vec<DiagnosticStatus>,
    }

    impl RosMessage for DiagnosticArray {
        const TYPE: MessageType = MessageType {
            name: "diagnostic_msgs/msg/DiagnosticArray",
            dds_name: "diagnostic_msgs::msg::dds_::DiagnosticArray_",
            type_hash: "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e",
            definition: r##"std_msgs/Header header
diagnostic_msgs/DiagnosticStatus[] status
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: diagnostic_msgs/DiagnosticStatus
byte OK=0
byte WARN=1
byte ERROR=2
byte STALE=3
byte level
string name
string message
string hardware_id
diagnostic_msgs/KeyValue[] values
================================================================================
MSG: diagnostic_msgs/KeyValue
string key
string value
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `diagnostic_msgs/msg/DiagnosticStatus`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct DiagnosticStatus {
        /// `byte level`
        pub r#level: u8,
        /// `string name`
        pub r#name: String,
        /// `string message`
        pub r#message: String,
        /// `string hardware_id`
        pub r#hardware_id: String,
        /// `diagnostic_msgs/KeyValue[] values`
        pub r#values: Vec<KeyValue>,
    }

    impl DiagnosticStatus {
        /// `byte OK`
        pub const OK: u8 = 0;
        /// `byte WARN`
        pub const WARN: u8 = 1;
        /// `byte ERROR`
        pub const ERROR: u8 = 2;
        /// `byte STALE`
        pub const STALE: u8 = 3;
    }

    impl RosMessage for DiagnosticStatus {
        const TYPE: MessageType = MessageType {
            name: "diagnostic_msgs/msg/DiagnosticStatus",
            dds_name: "diagnostic_msgs::msg::dds_::DiagnosticStatus_",
            type_hash: "RIHS01_b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4",
            definition: r##"byte OK=0
byte WARN=1
byte ERROR=2
byte STALE=3
byte level
string name
string message
string hardware_id
diagnostic_msgs/KeyValue[] values
================================================================================
MSG: diagnostic_msgs/KeyValue
string key
string value
"##,
        };
    }

    /// `diagnostic_msgs/msg/KeyValue`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct KeyValue {
        /// `string key`
        pub r#key: String,
        /// `string value`
        pub r#value: String,
    }

    impl RosMessage for KeyValue {
        const TYPE: MessageType = MessageType {
            name: "diagnostic_msgs/msg/KeyValue",
            dds_name: "diagnostic_msgs::msg::dds_::KeyValue_",
            type_hash: "RIHS01_d68081eaa540288c5440753baecef0c4e16e81a5f78ad68902ded5100413bb42",
            definition: r##"string key
string value
"##,
        };
    }
}

/// Messages of `geometry_msgs`.
pub mod geometry_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `geometry_msgs/msg/Point`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Point {
        /// `float64 x`
        pub r#x: f64,
        /// `float64 y`
        pub r#y: f64,
        /// `float64 z`
        pub r#z: f64,
    }

    impl RosMessage for Point {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/Point",
            dds_name: "geometry_msgs::msg::dds_::Point_",
            type_hash: "RIHS01_6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881",
            definition: r##"float64 x
float64 y
float64 z
"##,
        };
    }

    /// `geometry_msgs/msg/Pose`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Pose {
        /// `geometry_msgs/Point position`
        pub r#position: Point,
        /// `geometry_msgs/Quaternion orientation`
        pub r#orientation: Quaternion,
    }

    impl RosMessage for Pose {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/Pose",
            dds_name: "geometry_msgs::msg::dds_::Pose_",
            type_hash: "RIHS01_d501954e9476cea2996984e812054b68026ae0bfae789d9a10b23daf35cc90fa",
            definition: r##"geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"##,
        };
    }

    /// `geometry_msgs/msg/PoseStamped`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct PoseStamped {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `geometry_msgs/Pose pose`
        pub r#pose: Pose,
    }

    impl RosMessage for PoseStamped {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/PoseStamped",
            dds_name: "geometry_msgs::msg::dds_::PoseStamped_",
            type_hash: "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8",
            definition: r##"std_msgs/Header header
geometry_msgs/Pose pose
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `geometry_msgs/msg/Quaternion`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Quaternion {
        /// `float64 x`
        pub r#x: f64,
        /// `float64 y`
        pub r#y: f64,
        /// `float64 z`
        pub r#z: f64,
        /// `float64 w`
        pub r#w: f64,
    }

    impl RosMessage for Quaternion {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/Quaternion",
            dds_name: "geometry_msgs::msg::dds_::Quaternion_",
            type_hash: "RIHS01_8a765f66778c8ff7c8ab94afcc590a2ed5325a1d9a076ffff38fbce36f458684",
            definition: r##"float64 x
float64 y
float64 z
float64 w
"##,
        };
    }

    /// `geometry_msgs/msg/Transform`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Transform {
        /// `geometry_msgs/Vector3 translation`
        pub r#translation: Vector3,
        /// `geometry_msgs/Quaternion rotation`
        pub r#rotation: Quaternion,
    }

    impl RosMessage for Transform {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/Transform",
            dds_name: "geometry_msgs::msg::dds_::Transform_",
            type_hash: "RIHS01_beb83fbe698636351461f6f35d1abb20010c43d55374d81bd041f1ba2581fddc",
            definition: r##"geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"##,
        };
    }

    /// `geometry_msgs/msg/TransformStamped`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct TransformStamped {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `string child_frame_id`
        pub r#child_frame_id: String,
        /// `geometry_msgs/Transform transform`
        pub r#transform: Transform,
    }

    impl RosMessage for TransformStamped {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/TransformStamped",
            dds_name: "geometry_msgs::msg::dds_::TransformStamped_",
            type_hash: "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206",
            definition: r##"std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `geometry_msgs/msg/Twist`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Twist {
        /// `geometry_msgs/Vector3 linear`
        pub r#linear: Vector3,
        /// `geometry_msgs/Vector3 angular`
        pub r#angular: Vector3,
    }

    impl RosMessage for Twist {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/Twist",
            dds_name: "geometry_msgs::msg::dds_::Twist_",
            type_hash: "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
            definition: r##"geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"##,
        };
    }

    /// `geometry_msgs/msg/TwistStamped`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct TwistStamped {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `geometry_msgs/Twist twist`
        pub r#twist: Twist,
    }

    impl RosMessage for TwistStamped {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/TwistStamped",
            dds_name: "geometry_msgs::msg::dds_::TwistStamped_",
            type_hash: "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64",
            definition: r##"std_msgs/Header header
geometry_msgs/Twist twist
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `geometry_msgs/msg/Vector3`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Vector3 {
        /// `float64 x`
        pub r#x: f64,
        /// `float64 y`
        pub r#y: f64,
        /// `float64 z`
        pub r#z: f64,
    }

    impl RosMessage for Vector3 {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/Vector3",
            dds_name: "geometry_msgs::msg::dds_::Vector3_",
            type_hash: "RIHS01_cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d",
            definition: r##"float64 x
float64 y
float64 z
"##,
        };
    }

    /// `geometry_msgs/msg/Wrench`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Wrench {
        /// `geometry_msgs/Vector3 force`
        pub r#force: Vector3,
        /// `geometry_msgs/Vector3 torque`
        pub r#torque: Vector3,
    }

    impl RosMessage for Wrench {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/Wrench",
            dds_name: "geometry_msgs::msg::dds_::Wrench_",
            type_hash: "RIHS01_018e8519d57c16adbe97c9fe1460ef21fec7e31bc541de3d653a35895677ce52",
            definition: r##"geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"##,
        };
    }

    /// `geometry_msgs/msg/WrenchStamped`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct WrenchStamped {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `geometry_msgs/Wrench wrench`
        pub r#wrench: Wrench,
    }

    impl RosMessage for WrenchStamped {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/WrenchStamped",
            dds_name: "geometry_msgs::msg::dds_::WrenchStamped_",
            type_hash: "RIHS01_8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77",
            definition: r##"std_msgs/Header header
geometry_msgs/Wrench wrench
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }
}

/// Messages of `jamgrip_msgs`.
pub mod jamgrip_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// One contact between the gripper's membrane and an object.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Contact {
        /// Name of the object in the scene.
        pub r#object: String,
        /// Contact point \[m\].
        pub r#point: super::geometry_msgs::Point,
        /// Unit normal, from the object to the membrane \[-\].
        pub r#normal: super::geometry_msgs::Vector3,
        /// Magnitude of the normal force, at least zero \[N\].
        pub r#normal_force: f64,
        /// Tangential part of the force on the object \[N\].
        pub r#tangential_force: super::geometry_msgs::Vector3,
        /// Force on the object, normal and tangential part together \[N\].
        pub r#force: super::geometry_msgs::Vector3,
        /// Overlap of membrane and object \[m\].
        pub r#overlap: f64,
    }

    impl RosMessage for Contact {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/Contact",
            dds_name: "jamgrip_msgs::msg::dds_::Contact_",
            type_hash: "RIHS01_cf224873144eed89ed6be8a05b66b411793da94ae9c3406a7fabd98282ff2a1d",
            definition: r##"# One contact between the gripper's membrane and an object.

# Name of the object in the scene.
string object
# Contact point [m].
geometry_msgs/Point point
# Unit normal, from the object to the membrane [-].
geometry_msgs/Vector3 normal
# Magnitude of the normal force, at least zero [N].
float64 normal_force
# Tangential part of the force on the object [N].
geometry_msgs/Vector3 tangential_force
# Force on the object, normal and tangential part together [N].
geometry_msgs/Vector3 force
# Overlap of membrane and object [m].
float64 overlap
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"##,
        };
    }

    /// All contacts between the gripper's membrane and the objects.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ContactArray {
        /// Simulated time \[s\]; points and directions are in this frame.
        pub r#header: super::std_msgs::Header,
        /// The contacts; none while nothing touches.
        pub r#contacts: Vec<Contact>,
    }

    impl RosMessage for ContactArray {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/ContactArray",
            dds_name: "jamgrip_msgs::msg::dds_::ContactArray_",
            type_hash: "RIHS01_7fef0e31d2fc0d40570d5afae09abc82d400c52f30a5754cc8a019499a6ae729",
            definition: r##"# All contacts between the gripper's membrane and the objects.

# Simulated time [s]; points and directions are in this frame.
std_msgs/Header header
# The contacts; none while nothing touches.
jamgrip_msgs/Contact[] contacts
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: jamgrip_msgs/Contact
# One contact between the gripper's membrane and an object.

# Name of the object in the scene.
string object
# Contact point [m].
geometry_msgs/Point point
# Unit normal, from the object to the membrane [-].
geometry_msgs/Vector3 normal
# Magnitude of the normal force, at least zero [N].
float64 normal_force
# Tangential part of the force on the object [N].
geometry_msgs/Vector3 tangential_force
# Force on the object, normal and tangential part together [N].
geometry_msgs/Vector3 force
# Overlap of membrane and object [m].
float64 overlap
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// Drives an object along poses, or gives it back to the physics.
    ///
    /// A pose command, given by MODE_DRIVE of this message or as geometry_msgs/PoseStamped on
    /// ~/object/\<name>/pose_cmd, drives the object kinematically: it moves to the commanded pose within
    /// the scene's limits of speed and pushes what is in its way. It is driven as long as commands keep
    /// coming. When none has come for the scene's `drive_timeout` (default 0.5 s of simulated time), or at
    /// MODE_RELEASE, the object is given back to dynamics with the velocity it has at that moment.
    ///
    /// A command with numbers that are not finite, an orientation whose length is not 1 within 0.001,
    /// an unknown frame, object or mode is refused and counted in ~/statistics.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ObjectCommand {
        /// Frame of the pose: world (also if empty) or another frame of the scene. The stamp is recorded, not used \[s\].
        pub r#header: super::std_msgs::Header,
        /// Name of the object in the scene.
        pub r#object: String,
        /// One of the modes above \[-\].
        pub r#mode: u8,
        /// Pose of the object's body frame: position \[m\], unit quaternion \[-\].
        pub r#pose: super::geometry_msgs::Pose,
    }

    impl ObjectCommand {
        /// Drive the object to `pose`.
        pub const MODE_DRIVE: u8 = 0;
        /// Give the object back to dynamics; `pose` is not used.
        pub const MODE_RELEASE: u8 = 1;
    }

    impl RosMessage for ObjectCommand {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/ObjectCommand",
            dds_name: "jamgrip_msgs::msg::dds_::ObjectCommand_",
            type_hash: "RIHS01_3bcaba02d143f6e9e63c5802d4ed6f93224cf683c568559bceb053f2f0bead6e",
            definition: r##"# Drives an object along poses, or gives it back to the physics.
#
# A pose command, given by MODE_DRIVE of this message or as geometry_msgs/PoseStamped on
# ~/object/<name>/pose_cmd, drives the object kinematically: it moves to the commanded pose within
# the scene's limits of speed and pushes what is in its way. It is driven as long as commands keep
# coming. When none has come for the scene's `drive_timeout` (default 0.5 s of simulated time), or at
# MODE_RELEASE, the object is given back to dynamics with the velocity it has at that moment.
#
# A command with numbers that are not finite, an orientation whose length is not 1 within 0.001,
# an unknown frame, object or mode is refused and counted in ~/statistics.

# Drive the object to `pose`.
uint8 MODE_DRIVE = 0
# Give the object back to dynamics; `pose` is not used.
uint8 MODE_RELEASE = 1

# Frame of the pose: world (also if empty) or another frame of the scene. The stamp is recorded, not used [s].
std_msgs/Header header
# Name of the object in the scene.
string object
# One of the modes above [-].
uint8 mode
# Pose of the object's body frame: position [m], unit quaternion [-].
geometry_msgs/Pose pose
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// Whether the gripper holds something, with the values that drivers of vacuum grippers use.
    ///
    /// The simulated gripper has no such sensor; the status is told from contact and pressure:
    /// no contact between membrane and objects is NO_OBJECT_DETECTED. With contact it depends on the
    /// share of the commanded vacuum that is reached: from 95 % on OBJECT_DETECTED_AT_MAX_PRESSURE,
    /// from one sixth on OBJECT_DETECTED_AT_MIN_PRESSURE, below that or without vacuum UNKNOWN.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ObjectDetectionStatus {
        /// One of the values above \[-\].
        pub r#status: i8,
    }

    impl ObjectDetectionStatus {
        /// Touched, but not gripped.
        pub const UNKNOWN: i8 = 0;
        /// Touched, and the vacuum has built up enough to hold.
        pub const OBJECT_DETECTED_AT_MIN_PRESSURE: i8 = 1;
        /// Touched, and the commanded vacuum is reached.
        pub const OBJECT_DETECTED_AT_MAX_PRESSURE: i8 = 2;
        /// Nothing touches the membrane.
        pub const NO_OBJECT_DETECTED: i8 = 3;
    }

    impl RosMessage for ObjectDetectionStatus {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/ObjectDetectionStatus",
            dds_name: "jamgrip_msgs::msg::dds_::ObjectDetectionStatus_",
            type_hash: "RIHS01_a8faf93427d99626ee5aea78e75af0cf633ea47d974d9a6dfaf1048eb540f986",
            definition: r##"# Whether the gripper holds something, with the values that drivers of vacuum grippers use.
#
# The simulated gripper has no such sensor; the status is told from contact and pressure:
# no contact between membrane and objects is NO_OBJECT_DETECTED. With contact it depends on the
# share of the commanded vacuum that is reached: from 95 % on OBJECT_DETECTED_AT_MAX_PRESSURE,
# from one sixth on OBJECT_DETECTED_AT_MIN_PRESSURE, below that or without vacuum UNKNOWN.

# Touched, but not gripped.
int8 UNKNOWN = 0
# Touched, and the vacuum has built up enough to hold.
int8 OBJECT_DETECTED_AT_MIN_PRESSURE = 1
# Touched, and the commanded vacuum is reached.
int8 OBJECT_DETECTED_AT_MAX_PRESSURE = 2
# Nothing touches the membrane.
int8 NO_OBJECT_DETECTED = 3

# One of the values above [-].
int8 status
"##,
        };
    }

    /// What became of the ticks' results at one place they go to.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SinkStatistics {
        /// Name of the place: ros, shm or bag.
        pub r#name: String,
        /// Results written \[1\].
        pub r#n_written: u64,
        /// Results dropped because the place was too slow \[1\].
        pub r#n_dropped: u64,
        /// Results that the place failed on \[1\].
        pub r#n_failed: u64,
    }

    impl RosMessage for SinkStatistics {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/SinkStatistics",
            dds_name: "jamgrip_msgs::msg::dds_::SinkStatistics_",
            type_hash: "RIHS01_2f97f5f1f0484fab6fda62425d4289fd6f6c1b37e98b40d35aed4543682e4b88",
            definition: r##"# What became of the ticks' results at one place they go to.

# Name of the place: ros, shm or bag.
string name
# Results written [1].
uint64 n_written
# Results dropped because the place was too slow [1].
uint64 n_dropped
# Results that the place failed on [1].
uint64 n_failed
"##,
        };
    }

    /// Fingerprint of the whole state at the end of a tick. Only recordings hold it.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct StateDigest {
        /// Ticks since the start of the run \[1\].
        pub r#tick: u64,
        /// Digest of the whole state; equal digests are equal states, bit by bit.
        pub r#digest: u64,
        /// Digest of the chain so far: the scene's text, and of every tick its commands and its digest.
        pub r#chain: u64,
    }

    impl RosMessage for StateDigest {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/StateDigest",
            dds_name: "jamgrip_msgs::msg::dds_::StateDigest_",
            type_hash: "RIHS01_8ace4a29b566a96b4c49aaaef2b97f13b73b877caaa3d473f1e00de9509106b9",
            definition: r##"# Fingerprint of the whole state at the end of a tick. Only recordings hold it.

# Ticks since the start of the run [1].
uint64 tick
# Digest of the whole state; equal digests are equal states, bit by bit.
uint64 digest
# Digest of the chain so far: the scene's text, and of every tick its commands and its digest.
uint64 chain
"##,
        };
    }

    /// How the simulation runs, and whether its model is valid.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Statistics {
        /// Simulated time \[s\].
        pub r#header: super::std_msgs::Header,
        /// Simulated time since the start of the run \[s\].
        pub r#sim_time: f64,
        /// Wall time since the first tick \[s\].
        pub r#wall_time: f64,
        /// Simulated over wall time, over the last second of wall time \[-\].
        pub r#real_time_factor: f64,
        /// Simulated over wall time, since the first tick \[-\].
        pub r#real_time_factor_mean: f64,
        /// Ticks since the start of the run \[1\].
        pub r#tick: u64,
        /// Length of a substep \[s\].
        pub r#substep: f64,
        /// Kinetic energy of grains and membrane \[J\].
        pub r#kinetic_energy: f64,
        /// Contacts between grains \[1\].
        pub r#n_grain_contacts: u32,
        /// Contacts between grains and membrane \[1\].
        pub r#n_membrane_contacts: u32,
        /// Contacts between membrane and objects \[1\].
        pub r#n_object_contacts: u32,
        /// Digest of the whole state; equal digests are equal states, bit by bit.
        pub r#state_digest: u64,
        /// Seed of the scene's random streams.
        pub r#seed: u64,
        /// Commands carried out as asked \[1\].
        pub r#n_commands_applied: u64,
        /// Commands carried out within a limit \[1\].
        pub r#n_commands_limited: u64,
        /// Commands not carried out \[1\].
        pub r#n_commands_refused: u64,
        /// What became of the results, place by place.
        pub r#sinks: Vec<SinkStatistics>,
        /// Largest overlap between grains over their mean diameter; the contact law holds for small ones \[-\].
        pub r#overlap_ratio_max: f64,
        /// Largest overlap between a grain and the membrane over the grains' mean diameter \[-\].
        pub r#membrane_overlap_ratio_max: f64,
        /// False when overlap_ratio_max is beyond 0.1: the contact law is no longer a good description.
        pub r#is_valid: bool,
        /// What the built-in controller is doing; empty without one.
        pub r#phase: String,
    }

    impl RosMessage for Statistics {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/Statistics",
            dds_name: "jamgrip_msgs::msg::dds_::Statistics_",
            type_hash: "RIHS01_5ec922689d3677c948c46f4aff57b7eb06502f87efe527eb40d8611ecc864d09",
            definition: r##"# How the simulation runs, and whether its model is valid.

# Simulated time [s].
std_msgs/Header header
# Simulated time since the start of the run [s].
float64 sim_time
# Wall time since the first tick [s].
float64 wall_time
# Simulated over wall time, over the last second of wall time [-].
float64 real_time_factor
# Simulated over wall time, since the first tick [-].
float64 real_time_factor_mean
# Ticks since the start of the run [1].
uint64 tick
# Length of a substep [s].
float64 substep
# Kinetic energy of grains and membrane [J].
float64 kinetic_energy
# Contacts between grains [1].
uint32 n_grain_contacts
# Contacts between grains and membrane [1].
uint32 n_membrane_contacts
# Contacts between membrane and objects [1].
uint32 n_object_contacts
# Digest of the whole state; equal digests are equal states, bit by bit.
uint64 state_digest
# Seed of the scene's random streams.
uint64 seed
# Commands carried out as asked [1].
uint64 n_commands_applied
# Commands carried out within a limit [1].
uint64 n_commands_limited
# Commands not carried out [1].
uint64 n_commands_refused
# What became of the results, place by place.
jamgrip_msgs/SinkStatistics[] sinks
# Largest overlap between grains over their mean diameter; the contact law holds for small ones [-].
float64 overlap_ratio_max
# Largest overlap between a grain and the membrane over the grains' mean diameter [-].
float64 membrane_overlap_ratio_max
# False when overlap_ratio_max is beyond 0.1: the contact law is no longer a good description.
bool is_valid
# What the built-in controller is doing; empty without one.
string phase
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: jamgrip_msgs/SinkStatistics
# What became of the ticks' results at one place they go to.

# Name of the place: ros, shm or bag.
string name
# Results written [1].
uint64 n_written
# Results dropped because the place was too slow [1].
uint64 n_dropped
# Results that the place failed on [1].
uint64 n_failed
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// The air in the membrane and how jammed the grains are.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct VacuumState {
        /// Simulated time \[s\].
        pub r#header: super::std_msgs::Header,
        /// Actual gauge pressure, negative under vacuum \[Pa\].
        pub r#gauge: f64,
        /// Commanded gauge pressure, after the pump's limits \[Pa\].
        pub r#gauge_setpoint: f64,
        /// Volume that membrane and flange enclose \[m^3\].
        pub r#volume: f64,
        /// Share of grains with at least four contacts, those that can carry load \[-\].
        pub r#jammed_fraction: f64,
        /// Mean number of contacts per grain \[-\].
        pub r#coordination_number: f64,
        /// Volume of the grains over the enclosed volume \[-\].
        pub r#solid_fraction: f64,
        /// Share of sliding contacts among the contacts between grains \[-\].
        pub r#sliding_fraction: f64,
        /// Whether something is held.
        pub r#object_detection: ObjectDetectionStatus,
    }

    impl RosMessage for VacuumState {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/VacuumState",
            dds_name: "jamgrip_msgs::msg::dds_::VacuumState_",
            type_hash: "RIHS01_72a7a4556b7a2097dad83a97e4a7cfa2cb84ae66f86b3f53a80d8bbe4734b29d",
            definition: r##"# The air in the membrane and how jammed the grains are.

# Simulated time [s].
std_msgs/Header header
# Actual gauge pressure, negative under vacuum [Pa].
float64 gauge
# Commanded gauge pressure, after the pump's limits [Pa].
float64 gauge_setpoint
# Volume that membrane and flange enclose [m^3].
float64 volume
# Share of grains with at least four contacts, those that can carry load [-].
float64 jammed_fraction
# Mean number of contacts per grain [-].
float64 coordination_number
# Volume of the grains over the enclosed volume [-].
float64 solid_fraction
# Share of sliding contacts among the contacts between grains [-].
float64 sliding_fraction
# Whether something is held.
jamgrip_msgs/ObjectDetectionStatus object_detection
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: jamgrip_msgs/ObjectDetectionStatus
# Whether the gripper holds something, with the values that drivers of vacuum grippers use.
#
# The simulated gripper has no such sensor; the status is told from contact and pressure:
# no contact between membrane and objects is NO_OBJECT_DETECTED. With contact it depends on the
# share of the commanded vacuum that is reached: from 95 % on OBJECT_DETECTED_AT_MAX_PRESSURE,
# from one sixth on OBJECT_DETECTED_AT_MIN_PRESSURE, below that or without vacuum UNKNOWN.

# Touched, but not gripped.
int8 UNKNOWN = 0
# Touched, and the vacuum has built up enough to hold.
int8 OBJECT_DETECTED_AT_MIN_PRESSURE = 1
# Touched, and the commanded vacuum is reached.
int8 OBJECT_DETECTED_AT_MAX_PRESSURE = 2
# Nothing touches the membrane.
int8 NO_OBJECT_DETECTED = 3

# One of the values above [-].
int8 status
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }
}

/// Messages of `rosgraph_msgs`.
pub mod rosgraph_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `rosgraph_msgs/msg/Clock`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Clock {
        /// `builtin_interfaces/Time clock`
        pub r#clock: super::builtin_interfaces::Time,
    }

    impl RosMessage for Clock {
        const TYPE: MessageType = MessageType {
            name: "rosgraph_msgs/msg/Clock",
            dds_name: "rosgraph_msgs::msg::dds_::Clock_",
            type_hash: "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564",
            definition: r##"builtin_interfaces/Time clock
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }
}

/// Messages of `sensor_msgs`.
pub mod sensor_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `sensor_msgs/msg/CompressedImage`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct CompressedImage {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `string format`
        pub r#format: String,
        /// `uint8[] data`
        #[serde(with = "serde_bytes")]
        pub r#data: Vec<u8>,
    }

    impl RosMessage for CompressedImage {
        const TYPE: MessageType = MessageType {
            name: "sensor_msgs/msg/CompressedImage",
            dds_name: "sensor_msgs::msg::dds_::CompressedImage_",
            type_hash: "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a",
            definition: r##"std_msgs/Header header
string format
uint8[] data
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `sensor_msgs/msg/FluidPressure`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct FluidPressure {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `float64 fluid_pressure`
        pub r#fluid_pressure: f64,
        /// `float64 variance`
        pub r#variance: f64,
    }

    impl RosMessage for FluidPressure {
        const TYPE: MessageType = MessageType {
            name: "sensor_msgs/msg/FluidPressure",
            dds_name: "sensor_msgs::msg::dds_::FluidPressure_",
            type_hash: "RIHS01_22dfb2b145a0bd5a31a1ac3882a1b32148b51d9b2f3bab250290d66f3595bc32",
            definition: r##"std_msgs/Header header
float64 fluid_pressure
float64 variance
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `sensor_msgs/msg/JointState`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct JointState {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `string[] name`
        pub r#name: Vec<String>,
        /// `float64[] position`
        pub r#position: Vec<f64>,
        /// `float64[] velocity`
        pub r#velocity: Vec<f64>,
        /// `float64[] effort`
        pub r#effort: Vec<f64>,
    }

    impl RosMessage for JointState {
        const TYPE: MessageType = MessageType {
            name: "sensor_msgs/msg/JointState",
            dds_name: "sensor_msgs::msg::dds_::JointState_",
            type_hash: "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e",
            definition: r##"std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `sensor_msgs/msg/PointCloud2`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct PointCloud2 {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `uint32 height`
        pub r#height: u32,
        /// `uint32 width`
        pub r#width: u32,
        /// `sensor_msgs/PointField[] fields`
        pub r#fields: Vec<PointField>,
        /// `bool is_bigendian`
        pub r#is_bigendian: bool,
        /// `uint32 point_step`
        pub r#point_step: u32,
        /// `uint32 row_step`
        pub r#row_step: u32,
        /// `uint8[] data`
        #[serde(with = "serde_bytes")]
        pub r#data: Vec<u8>,
        /// `bool is_dense`
        pub r#is_dense: bool,
    }

    impl RosMessage for PointCloud2 {
        const TYPE: MessageType = MessageType {
            name: "sensor_msgs/msg/PointCloud2",
            dds_name: "sensor_msgs::msg::dds_::PointCloud2_",
            type_hash: "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5",
            definition: r##"std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: sensor_msgs/PointField
uint8 INT8=1
uint8 UINT8=2
uint8 INT16=3
uint8 UINT16=4
uint8 INT32=5
uint8 UINT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset
uint8 datatype
uint32 count
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `sensor_msgs/msg/PointField`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct PointField {
        /// `string name`
        pub r#name: String,
        /// `uint32 offset`
        pub r#offset: u32,
        /// `uint8 datatype`
        pub r#datatype: u8,
        /// `uint32 count`
        pub r#count: u32,
    }

    impl PointField {
        /// `uint8 INT8`
        pub const INT8: u8 = 1;
        /// `uint8 UINT8`
        pub const UINT8: u8 = 2;
        /// `uint8 INT16`
        pub const INT16: u8 = 3;
        /// `uint8 UINT16`
        pub const UINT16: u8 = 4;
        /// `uint8 INT32`
        pub const INT32: u8 = 5;
        /// `uint8 UINT32`
        pub const UINT32: u8 = 6;
        /// `uint8 FLOAT32`
        pub const FLOAT32: u8 = 7;
        /// `uint8 FLOAT64`
        pub const FLOAT64: u8 = 8;
    }

    impl RosMessage for PointField {
        const TYPE: MessageType = MessageType {
            name: "sensor_msgs/msg/PointField",
            dds_name: "sensor_msgs::msg::dds_::PointField_",
            type_hash: "RIHS01_5c6a4750728c2bcfbbf7037225b20b02d4429634732146b742dee1726637ef01",
            definition: r##"uint8 INT8=1
uint8 UINT8=2
uint8 INT16=3
uint8 UINT16=4
uint8 INT32=5
uint8 UINT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset
uint8 datatype
uint32 count
"##,
        };
    }
}

/// Messages of `shape_msgs`.
pub mod shape_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `shape_msgs/msg/Mesh`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Mesh {
        /// `shape_msgs/MeshTriangle[] triangles`
        pub r#triangles: Vec<MeshTriangle>,
        /// `geometry_msgs/Point[] vertices`
        pub r#vertices: Vec<super::geometry_msgs::Point>,
    }

    impl RosMessage for Mesh {
        const TYPE: MessageType = MessageType {
            name: "shape_msgs/msg/Mesh",
            dds_name: "shape_msgs::msg::dds_::Mesh_",
            type_hash: "RIHS01_f2150b82d8ee7e8bc3f396a2b158aefb4b9a5510a474be271ba1268aebb55289",
            definition: r##"shape_msgs/MeshTriangle[] triangles
geometry_msgs/Point[] vertices
================================================================================
MSG: shape_msgs/MeshTriangle
uint32[3] vertex_indices
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
"##,
        };
    }

    /// `shape_msgs/msg/MeshTriangle`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct MeshTriangle {
        /// `uint32[3] vertex_indices`
        pub r#vertex_indices: [u32; 3],
    }

    impl RosMessage for MeshTriangle {
        const TYPE: MessageType = MessageType {
            name: "shape_msgs/msg/MeshTriangle",
            dds_name: "shape_msgs::msg::dds_::MeshTriangle_",
            type_hash: "RIHS01_618e5c073eeb729e433ef6226e72c01d995c459fb7d76348c9700409a5020bd0",
            definition: r##"uint32[3] vertex_indices
"##,
        };
    }
}

/// Messages of `std_msgs`.
pub mod std_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `std_msgs/msg/ColorRGBA`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ColorRGBA {
        /// `float32 r`
        pub r#r: f32,
        /// `float32 g`
        pub r#g: f32,
        /// `float32 b`
        pub r#b: f32,
        /// `float32 a`
        pub r#a: f32,
    }

    impl RosMessage for ColorRGBA {
        const TYPE: MessageType = MessageType {
            name: "std_msgs/msg/ColorRGBA",
            dds_name: "std_msgs::msg::dds_::ColorRGBA_",
            type_hash: "RIHS01_77a7a5b9ae477306097665106e0413ba74440245b1f3d0c6d6405fe5c7813fe8",
            definition: r##"float32 r
float32 g
float32 b
float32 a
"##,
        };
    }

    /// `std_msgs/msg/Float64`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Float64 {
        /// `float64 data`
        pub r#data: f64,
    }

    impl RosMessage for Float64 {
        const TYPE: MessageType = MessageType {
            name: "std_msgs/msg/Float64",
            dds_name: "std_msgs::msg::dds_::Float64_",
            type_hash: "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a",
            definition: r##"float64 data
"##,
        };
    }

    /// `std_msgs/msg/Header`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Header {
        /// `builtin_interfaces/Time stamp`
        pub r#stamp: super::builtin_interfaces::Time,
        /// `string frame_id`
        pub r#frame_id: String,
    }

    impl RosMessage for Header {
        const TYPE: MessageType = MessageType {
            name: "std_msgs/msg/Header",
            dds_name: "std_msgs::msg::dds_::Header_",
            type_hash: "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
            definition: r##"builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }
}

/// Messages of `tf2_msgs`.
pub mod tf2_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `tf2_msgs/msg/TFMessage`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct TFMessage {
        /// `geometry_msgs/TransformStamped[] transforms`
        pub r#transforms: Vec<super::geometry_msgs::TransformStamped>,
    }

    impl RosMessage for TFMessage {
        const TYPE: MessageType = MessageType {
            name: "tf2_msgs/msg/TFMessage",
            dds_name: "tf2_msgs::msg::dds_::TFMessage_",
            type_hash: "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
            definition: r##"geometry_msgs/TransformStamped[] transforms
================================================================================
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }
}

/// Messages of `visualization_msgs`.
pub mod visualization_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `visualization_msgs/msg/Marker`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Marker {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `string ns`
        pub r#ns: String,
        /// `int32 id`
        pub r#id: i32,
        /// `int32 type`
        pub r#type: i32,
        /// `int32 action`
        pub r#action: i32,
        /// `geometry_msgs/Pose pose`
        pub r#pose: super::geometry_msgs::Pose,
        /// `geometry_msgs/Vector3 scale`
        pub r#scale: super::geometry_msgs::Vector3,
        /// `std_msgs/ColorRGBA color`
        pub r#color: super::std_msgs::ColorRGBA,
        /// `builtin_interfaces/Duration lifetime`
        pub r#lifetime: super::builtin_interfaces::Duration,
        /// `bool frame_locked`
        pub r#frame_locked: bool,
        /// `geometry_msgs/Point[] points`
        pub r#points: Vec<super::geometry_msgs::Point>,
        /// `std_msgs/ColorRGBA[] colors`
        pub r#colors: Vec<super::std_msgs::ColorRGBA>,
        /// `string texture_resource`
        pub r#texture_resource: String,
        /// `sensor_msgs/CompressedImage texture`
        pub r#texture: super::sensor_msgs::CompressedImage,
        /// `visualization_msgs/UVCoordinate[] uv_coordinates`
        pub r#uv_coordinates: Vec<UVCoordinate>,
        /// `string text`
        pub r#text: String,
        /// `string mesh_resource`
        pub r#mesh_resource: String,
        /// `visualization_msgs/MeshFile mesh_file`
        pub r#mesh_file: MeshFile,
        /// `bool mesh_use_embedded_materials`
        pub r#mesh_use_embedded_materials: bool,
    }

    impl Marker {
        /// `int32 ARROW`
        pub const ARROW: i32 = 0;
        /// `int32 CUBE`
        pub const CUBE: i32 = 1;
        /// `int32 SPHERE`
        pub const SPHERE: i32 = 2;
        /// `int32 CYLINDER`
        pub const CYLINDER: i32 = 3;
        /// `int32 LINE_STRIP`
        pub const LINE_STRIP: i32 = 4;
        /// `int32 LINE_LIST`
        pub const LINE_LIST: i32 = 5;
        /// `int32 CUBE_LIST`
        pub const CUBE_LIST: i32 = 6;
        /// `int32 SPHERE_LIST`
        pub const SPHERE_LIST: i32 = 7;
        /// `int32 POINTS`
        pub const POINTS: i32 = 8;
        /// `int32 TEXT_VIEW_FACING`
        pub const TEXT_VIEW_FACING: i32 = 9;
        /// `int32 MESH_RESOURCE`
        pub const MESH_RESOURCE: i32 = 10;
        /// `int32 TRIANGLE_LIST`
        pub const TRIANGLE_LIST: i32 = 11;
        /// `int32 ARROW_STRIP`
        pub const ARROW_STRIP: i32 = 12;
        /// `int32 ADD`
        pub const ADD: i32 = 0;
        /// `int32 MODIFY`
        pub const MODIFY: i32 = 0;
        /// `int32 DELETE`
        pub const DELETE: i32 = 2;
        /// `int32 DELETEALL`
        pub const DELETEALL: i32 = 3;
    }

    impl RosMessage for Marker {
        const TYPE: MessageType = MessageType {
            name: "visualization_msgs/msg/Marker",
            dds_name: "visualization_msgs::msg::dds_::Marker_",
            type_hash: "RIHS01_45b13ccf791f225962bf74e746f9644518855d783a6f42ba0cc14fde2b4f3ce0",
            definition: r##"int32 ARROW=0
int32 CUBE=1
int32 SPHERE=2
int32 CYLINDER=3
int32 LINE_STRIP=4
int32 LINE_LIST=5
int32 CUBE_LIST=6
int32 SPHERE_LIST=7
int32 POINTS=8
int32 TEXT_VIEW_FACING=9
int32 MESH_RESOURCE=10
int32 TRIANGLE_LIST=11
int32 ARROW_STRIP=12
int32 ADD=0
int32 MODIFY=0
int32 DELETE=2
int32 DELETEALL=3
std_msgs/Header header
string ns
int32 id
int32 type
int32 action
geometry_msgs/Pose pose
geometry_msgs/Vector3 scale
std_msgs/ColorRGBA color
builtin_interfaces/Duration lifetime
bool frame_locked
geometry_msgs/Point[] points
std_msgs/ColorRGBA[] colors
string texture_resource
sensor_msgs/CompressedImage texture
visualization_msgs/UVCoordinate[] uv_coordinates
string text
string mesh_resource
visualization_msgs/MeshFile mesh_file
bool mesh_use_embedded_materials
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: std_msgs/ColorRGBA
float32 r
float32 g
float32 b
float32 a
================================================================================
MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: sensor_msgs/CompressedImage
std_msgs/Header header
string format
uint8[] data
================================================================================
MSG: visualization_msgs/UVCoordinate
float32 u
float32 v
================================================================================
MSG: visualization_msgs/MeshFile
string filename
uint8[] data
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `visualization_msgs/msg/MarkerArray`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct MarkerArray {
        /// `visualization_msgs/Marker[] markers`
        pub r#markers: Vec<Marker>,
    }

    impl RosMessage for MarkerArray {
        const TYPE: MessageType = MessageType {
            name: "visualization_msgs/msg/MarkerArray",
            dds_name: "visualization_msgs::msg::dds_::MarkerArray_",
            type_hash: "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf",
            definition: r##"visualization_msgs/Marker[] markers
================================================================================
MSG: visualization_msgs/Marker
int32 ARROW=0
int32 CUBE=1
int32 SPHERE=2
int32 CYLINDER=3
int32 LINE_STRIP=4
int32 LINE_LIST=5
int32 CUBE_LIST=6
int32 SPHERE_LIST=7
int32 POINTS=8
int32 TEXT_VIEW_FACING=9
int32 MESH_RESOURCE=10
int32 TRIANGLE_LIST=11
int32 ARROW_STRIP=12
int32 ADD=0
int32 MODIFY=0
int32 DELETE=2
int32 DELETEALL=3
std_msgs/Header header
string ns
int32 id
int32 type
int32 action
geometry_msgs/Pose pose
geometry_msgs/Vector3 scale
std_msgs/ColorRGBA color
builtin_interfaces/Duration lifetime
bool frame_locked
geometry_msgs/Point[] points
std_msgs/ColorRGBA[] colors
string texture_resource
sensor_msgs/CompressedImage texture
visualization_msgs/UVCoordinate[] uv_coordinates
string text
string mesh_resource
visualization_msgs/MeshFile mesh_file
bool mesh_use_embedded_materials
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: std_msgs/ColorRGBA
float32 r
float32 g
float32 b
float32 a
================================================================================
MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: sensor_msgs/CompressedImage
std_msgs/Header header
string format
uint8[] data
================================================================================
MSG: visualization_msgs/UVCoordinate
float32 u
float32 v
================================================================================
MSG: visualization_msgs/MeshFile
string filename
uint8[] data
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `visualization_msgs/msg/MeshFile`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct MeshFile {
        /// `string filename`
        pub r#filename: String,
        /// `uint8[] data`
        #[serde(with = "serde_bytes")]
        pub r#data: Vec<u8>,
    }

    impl RosMessage for MeshFile {
        const TYPE: MessageType = MessageType {
            name: "visualization_msgs/msg/MeshFile",
            dds_name: "visualization_msgs::msg::dds_::MeshFile_",
            type_hash: "RIHS01_7710ece15a148fb7c9b546364cfb215bb06098087bd6394fe5b73a493508f8c4",
            definition: r##"string filename
uint8[] data
"##,
        };
    }

    /// `visualization_msgs/msg/UVCoordinate`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct UVCoordinate {
        /// `float32 u`
        pub r#u: f32,
        /// `float32 v`
        pub r#v: f32,
    }

    impl RosMessage for UVCoordinate {
        const TYPE: MessageType = MessageType {
            name: "visualization_msgs/msg/UVCoordinate",
            dds_name: "visualization_msgs::msg::dds_::UVCoordinate_",
            type_hash: "RIHS01_f27f7ed21fe360c6066944f856b801a0c0d1e94e815b6886444b42d90b196a26",
            definition: r##"float32 u
float32 v
"##,
        };
    }
}
