//! ROS 2 message types: generated from `msgs/`, never edited by hand.
//!
//! `tests/it/generated_types.rs` writes this file and tests that it is up to date.

/// Messages of `action_msgs`.
pub mod action_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `action_msgs/msg/CancelGoalRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct CancelGoalRequest {
        /// `action_msgs/GoalInfo goal_info`
        pub r#goal_info: GoalInfo,
    }

    /// `action_msgs/msg/CancelGoalResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct CancelGoalResponse {
        /// `int8 return_code`
        pub r#return_code: i8,
        /// `action_msgs/GoalInfo[] goals_canceling`
        pub r#goals_canceling: Vec<GoalInfo>,
    }

    impl CancelGoalResponse {
        /// `int8 ERROR_NONE`
        pub const ERROR_NONE: i8 = 0;
        /// `int8 ERROR_REJECTED`
        pub const ERROR_REJECTED: i8 = 1;
        /// `int8 ERROR_UNKNOWN_GOAL_ID`
        pub const ERROR_UNKNOWN_GOAL_ID: i8 = 2;
        /// `int8 ERROR_GOAL_TERMINATED`
        pub const ERROR_GOAL_TERMINATED: i8 = 3;
    }

    /// `action_msgs/msg/GoalInfo`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GoalInfo {
        /// `unique_identifier_msgs/UUID goal_id`
        pub r#goal_id: super::unique_identifier_msgs::UUID,
        /// `builtin_interfaces/Time stamp`
        pub r#stamp: super::builtin_interfaces::Time,
    }

    impl RosMessage for GoalInfo {
        const TYPE: MessageType = MessageType {
            name: "action_msgs/msg/GoalInfo",
            dds_name: "action_msgs::msg::dds_::GoalInfo_",
            type_hash: "RIHS01_6398fe763154554353930716b225947f93b672f0fb2e49fdd01bb7a7e37933e9",
            definition: r##"unique_identifier_msgs/UUID goal_id
builtin_interfaces/Time stamp
================================================================================
MSG: unique_identifier_msgs/UUID
uint8[16] uuid
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `action_msgs/msg/GoalStatus`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GoalStatus {
        /// `action_msgs/GoalInfo goal_info`
        pub r#goal_info: GoalInfo,
        /// `int8 status`
        pub r#status: i8,
    }

    impl GoalStatus {
        /// `int8 STATUS_UNKNOWN`
        pub const STATUS_UNKNOWN: i8 = 0;
        /// `int8 STATUS_ACCEPTED`
        pub const STATUS_ACCEPTED: i8 = 1;
        /// `int8 STATUS_EXECUTING`
        pub const STATUS_EXECUTING: i8 = 2;
        /// `int8 STATUS_CANCELING`
        pub const STATUS_CANCELING: i8 = 3;
        /// `int8 STATUS_SUCCEEDED`
        pub const STATUS_SUCCEEDED: i8 = 4;
        /// `int8 STATUS_CANCELED`
        pub const STATUS_CANCELED: i8 = 5;
        /// `int8 STATUS_ABORTED`
        pub const STATUS_ABORTED: i8 = 6;
    }

    impl RosMessage for GoalStatus {
        const TYPE: MessageType = MessageType {
            name: "action_msgs/msg/GoalStatus",
            dds_name: "action_msgs::msg::dds_::GoalStatus_",
            type_hash: "RIHS01_32f4cfd717735d17657e1178f24431c1ce996c878c515230f6c5b3476819dbb9",
            definition: r##"int8 STATUS_UNKNOWN=0
int8 STATUS_ACCEPTED=1
int8 STATUS_EXECUTING=2
int8 STATUS_CANCELING=3
int8 STATUS_SUCCEEDED=4
int8 STATUS_CANCELED=5
int8 STATUS_ABORTED=6
action_msgs/GoalInfo goal_info
int8 status
================================================================================
MSG: action_msgs/GoalInfo
unique_identifier_msgs/UUID goal_id
builtin_interfaces/Time stamp
================================================================================
MSG: unique_identifier_msgs/UUID
uint8[16] uuid
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// `action_msgs/msg/GoalStatusArray`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GoalStatusArray {
        /// `action_msgs/GoalStatus[] status_list`
        pub r#status_list: Vec<GoalStatus>,
    }

    impl RosMessage for GoalStatusArray {
        const TYPE: MessageType = MessageType {
            name: "action_msgs/msg/GoalStatusArray",
            dds_name: "action_msgs::msg::dds_::GoalStatusArray_",
            type_hash: "RIHS01_6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e",
            definition: r##"action_msgs/GoalStatus[] status_list
================================================================================
MSG: action_msgs/GoalStatus
int8 STATUS_UNKNOWN=0
int8 STATUS_ACCEPTED=1
int8 STATUS_EXECUTING=2
int8 STATUS_CANCELING=3
int8 STATUS_SUCCEEDED=4
int8 STATUS_CANCELED=5
int8 STATUS_ABORTED=6
action_msgs/GoalInfo goal_info
int8 status
================================================================================
MSG: action_msgs/GoalInfo
unique_identifier_msgs/UUID goal_id
builtin_interfaces/Time stamp
================================================================================
MSG: unique_identifier_msgs/UUID
uint8[16] uuid
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// Services of `action_msgs`.
    pub mod srv {
        use crate::wire::messages::{RosService, ServiceType};

        /// `action_msgs/srv/CancelGoal`.
        #[derive(Clone, Copy, Debug)]
        pub struct CancelGoal;

        impl RosService for CancelGoal {
            type Request = super::CancelGoalRequest;
            type Response = super::CancelGoalResponse;
            const TYPE: ServiceType = ServiceType {
                name: "action_msgs/srv/CancelGoal",
                request_dds_name: "action_msgs::srv::dds_::CancelGoal_Request_",
                response_dds_name: "action_msgs::srv::dds_::CancelGoal_Response_",
            };
        }
    }
}

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

/// Messages of `control_msgs`.
pub mod control_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `control_msgs/msg/GripperCommand`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GripperCommand {
        /// `float64 position`
        pub r#position: f64,
        /// `float64 max_effort`
        pub r#max_effort: f64,
    }

    impl RosMessage for GripperCommand {
        const TYPE: MessageType = MessageType {
            name: "control_msgs/msg/GripperCommand",
            dds_name: "control_msgs::msg::dds_::GripperCommand_",
            type_hash: "RIHS01_57eb8f326c9889ca8bb34ead82cc94cc09bf6bc5c3b6c09546dca3a00b589890",
            definition: r##"float64 position
float64 max_effort
"##,
        };
    }

    /// `control_msgs/msg/GripperCommandFeedback`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GripperCommandFeedback {
        /// `float64 position`
        pub r#position: f64,
        /// `float64 effort`
        pub r#effort: f64,
        /// `bool stalled`
        pub r#stalled: bool,
        /// `bool reached_goal`
        pub r#reached_goal: bool,
    }

    /// `control_msgs/msg/GripperCommandGoal`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GripperCommandGoal {
        /// `control_msgs/GripperCommand command`
        pub r#command: GripperCommand,
    }

    /// `control_msgs/msg/GripperCommandResult`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GripperCommandResult {
        /// `float64 position`
        pub r#position: f64,
        /// `float64 effort`
        pub r#effort: f64,
        /// `bool stalled`
        pub r#stalled: bool,
        /// `bool reached_goal`
        pub r#reached_goal: bool,
    }

    /// `control_msgs/msg/ParallelGripperCommandFeedback`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ParallelGripperCommandFeedback {
        /// `sensor_msgs/JointState state`
        pub r#state: super::sensor_msgs::JointState,
    }

    /// `control_msgs/msg/ParallelGripperCommandGoal`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ParallelGripperCommandGoal {
        /// `sensor_msgs/JointState command`
        pub r#command: super::sensor_msgs::JointState,
    }

    /// `control_msgs/msg/ParallelGripperCommandResult`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ParallelGripperCommandResult {
        /// `sensor_msgs/JointState state`
        pub r#state: super::sensor_msgs::JointState,
        /// `bool stalled`
        pub r#stalled: bool,
        /// `bool reached_goal`
        pub r#reached_goal: bool,
    }

    /// Actions of `control_msgs`.
    pub mod action {
        use crate::wire::messages::{ActionType, RosAction, ServiceType};

        /// `control_msgs/action/GripperCommand`.
        #[derive(Clone, Copy, Debug)]
        pub struct GripperCommand;

        impl RosAction for GripperCommand {
            type Goal = super::GripperCommandGoal;
            type Result = super::GripperCommandResult;
            type Feedback = super::GripperCommandFeedback;
            const TYPE: ActionType = ActionType {
                name: "control_msgs/action/GripperCommand",
                send_goal: ServiceType {
                    name: "control_msgs/action/GripperCommand_SendGoal",
                    request_dds_name: "control_msgs::action::dds_::GripperCommand_SendGoal_Request_",
                    response_dds_name: "control_msgs::action::dds_::GripperCommand_SendGoal_Response_",
                },
                get_result: ServiceType {
                    name: "control_msgs/action/GripperCommand_GetResult",
                    request_dds_name: "control_msgs::action::dds_::GripperCommand_GetResult_Request_",
                    response_dds_name: "control_msgs::action::dds_::GripperCommand_GetResult_Response_",
                },
                feedback_dds_name: "control_msgs::action::dds_::GripperCommand_FeedbackMessage_",
            };
        }

        /// `control_msgs/action/ParallelGripperCommand`.
        #[derive(Clone, Copy, Debug)]
        pub struct ParallelGripperCommand;

        impl RosAction for ParallelGripperCommand {
            type Goal = super::ParallelGripperCommandGoal;
            type Result = super::ParallelGripperCommandResult;
            type Feedback = super::ParallelGripperCommandFeedback;
            const TYPE: ActionType = ActionType {
                name: "control_msgs/action/ParallelGripperCommand",
                send_goal: ServiceType {
                    name: "control_msgs/action/ParallelGripperCommand_SendGoal",
                    request_dds_name: "control_msgs::action::dds_::ParallelGripperCommand_SendGoal_Request_",
                    response_dds_name: "control_msgs::action::dds_::ParallelGripperCommand_SendGoal_Response_",
                },
                get_result: ServiceType {
                    name: "control_msgs/action/ParallelGripperCommand_GetResult",
                    request_dds_name: "control_msgs::action::dds_::ParallelGripperCommand_GetResult_Request_",
                    response_dds_name: "control_msgs::action::dds_::ParallelGripperCommand_GetResult_Response_",
                },
                feedback_dds_name: "control_msgs::action::dds_::ParallelGripperCommand_FeedbackMessage_",
            };
        }
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

    /// `geometry_msgs/msg/Accel`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Accel {
        /// `geometry_msgs/Vector3 linear`
        pub r#linear: Vector3,
        /// `geometry_msgs/Vector3 angular`
        pub r#angular: Vector3,
    }

    impl RosMessage for Accel {
        const TYPE: MessageType = MessageType {
            name: "geometry_msgs/msg/Accel",
            dds_name: "geometry_msgs::msg::dds_::Accel_",
            type_hash: "RIHS01_dc448243ded9b1fcbcca24aba0c22f013dae06c354ba2d849571c0a2a3f57ca0",
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
        /// Total force on the object: normal plus tangential part \[N\].
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
# Total force on the object: normal plus tangential part [N].
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
        /// Simulated time \[s\], and the frame of points and directions.
        pub r#header: super::std_msgs::Header,
        /// The contacts; empty without contact.
        pub r#contacts: Vec<Contact>,
    }

    impl RosMessage for ContactArray {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/ContactArray",
            dds_name: "jamgrip_msgs::msg::dds_::ContactArray_",
            type_hash: "RIHS01_7fef0e31d2fc0d40570d5afae09abc82d400c52f30a5754cc8a019499a6ae729",
            definition: r##"# All contacts between the gripper's membrane and the objects.

# Simulated time [s], and the frame of points and directions.
std_msgs/Header header
# The contacts; empty without contact.
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
# Total force on the object: normal plus tangential part [N].
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

    /// Drives an object along poses, or releases it.
    ///
    /// A pose command, given by MODE_DRIVE of this message or as geometry_msgs/PoseStamped on
    /// ~/object/\<name>/pose_cmd, drives the object kinematically: it moves to the commanded pose within
    /// the speed limits of the scene and pushes other bodies away. It is driven as long as commands
    /// arrive. After `drive_timeout` of the scene without a command (default 0.5 s of simulated time), or
    /// with MODE_RELEASE, the object moves freely again, starting with its current velocity.
    ///
    /// A command with a number that is not finite, an orientation whose length differs from 1 by more than
    /// 0.001, or an unknown frame, object or mode is rejected and counted in ~/statistics.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ObjectCommand {
        /// Frame of the pose: world (also if empty) or another frame of the scene. The stamp is recorded but not used \[s\].
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
        /// Release the object; `pose` is not used.
        pub const MODE_RELEASE: u8 = 1;
    }

    impl RosMessage for ObjectCommand {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/ObjectCommand",
            dds_name: "jamgrip_msgs::msg::dds_::ObjectCommand_",
            type_hash: "RIHS01_3bcaba02d143f6e9e63c5802d4ed6f93224cf683c568559bceb053f2f0bead6e",
            definition: r##"# Drives an object along poses, or releases it.
#
# A pose command, given by MODE_DRIVE of this message or as geometry_msgs/PoseStamped on
# ~/object/<name>/pose_cmd, drives the object kinematically: it moves to the commanded pose within
# the speed limits of the scene and pushes other bodies away. It is driven as long as commands
# arrive. After `drive_timeout` of the scene without a command (default 0.5 s of simulated time), or
# with MODE_RELEASE, the object moves freely again, starting with its current velocity.
#
# A command with a number that is not finite, an orientation whose length differs from 1 by more than
# 0.001, or an unknown frame, object or mode is rejected and counted in ~/statistics.

# Drive the object to `pose`.
uint8 MODE_DRIVE = 0
# Release the object; `pose` is not used.
uint8 MODE_RELEASE = 1

# Frame of the pose: world (also if empty) or another frame of the scene. The stamp is recorded but not used [s].
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

    /// Whether the gripper holds an object, with the values that drivers of vacuum grippers use.
    ///
    /// The simulated gripper has no such sensor; the status is derived from contact and pressure:
    /// NO_OBJECT_DETECTED without contact between membrane and objects. With contact it depends on the
    /// fraction of the commanded vacuum that is reached: OBJECT_DETECTED_AT_MAX_PRESSURE from 95 %,
    /// OBJECT_DETECTED_AT_MIN_PRESSURE from one sixth, UNKNOWN below that or without vacuum.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ObjectDetectionStatus {
        /// One of the values above \[-\].
        pub r#status: i8,
    }

    impl ObjectDetectionStatus {
        /// Contact, but not gripped.
        pub const UNKNOWN: i8 = 0;
        /// Contact, and the vacuum is sufficient to hold the object.
        pub const OBJECT_DETECTED_AT_MIN_PRESSURE: i8 = 1;
        /// Contact, and the commanded vacuum is reached.
        pub const OBJECT_DETECTED_AT_MAX_PRESSURE: i8 = 2;
        /// No contact with the membrane.
        pub const NO_OBJECT_DETECTED: i8 = 3;
    }

    impl RosMessage for ObjectDetectionStatus {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/ObjectDetectionStatus",
            dds_name: "jamgrip_msgs::msg::dds_::ObjectDetectionStatus_",
            type_hash: "RIHS01_a8faf93427d99626ee5aea78e75af0cf633ea47d974d9a6dfaf1048eb540f986",
            definition: r##"# Whether the gripper holds an object, with the values that drivers of vacuum grippers use.
#
# The simulated gripper has no such sensor; the status is derived from contact and pressure:
# NO_OBJECT_DETECTED without contact between membrane and objects. With contact it depends on the
# fraction of the commanded vacuum that is reached: OBJECT_DETECTED_AT_MAX_PRESSURE from 95 %,
# OBJECT_DETECTED_AT_MIN_PRESSURE from one sixth, UNKNOWN below that or without vacuum.

# Contact, but not gripped.
int8 UNKNOWN = 0
# Contact, and the vacuum is sufficient to hold the object.
int8 OBJECT_DETECTED_AT_MIN_PRESSURE = 1
# Contact, and the commanded vacuum is reached.
int8 OBJECT_DETECTED_AT_MAX_PRESSURE = 2
# No contact with the membrane.
int8 NO_OBJECT_DETECTED = 3

# One of the values above [-].
int8 status
"##,
        };
    }

    /// Counters of one output.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SinkStatistics {
        /// Name of the output: ros, shm or bag.
        pub r#name: String,
        /// Results written \[1\].
        pub r#n_written: u64,
        /// Results dropped because the output was too slow \[1\].
        pub r#n_dropped: u64,
        /// Results that could not be written \[1\].
        pub r#n_failed: u64,
    }

    impl RosMessage for SinkStatistics {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/SinkStatistics",
            dds_name: "jamgrip_msgs::msg::dds_::SinkStatistics_",
            type_hash: "RIHS01_2f97f5f1f0484fab6fda62425d4289fd6f6c1b37e98b40d35aed4543682e4b88",
            definition: r##"# Counters of one output.

# Name of the output: ros, shm or bag.
string name
# Results written [1].
uint64 n_written
# Results dropped because the output was too slow [1].
uint64 n_dropped
# Results that could not be written [1].
uint64 n_failed
"##,
        };
    }

    /// Digest of the complete state at the end of a tick. Only in recordings.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct StateDigest {
        /// Ticks since the start of the run \[1\].
        pub r#tick: u64,
        /// Digest of the complete state; equal digests mean equal states, bit for bit.
        pub r#digest: u64,
        /// Chained digest of the scene's text and of the commands and the digest of every tick so far.
        pub r#chain: u64,
    }

    impl RosMessage for StateDigest {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/StateDigest",
            dds_name: "jamgrip_msgs::msg::dds_::StateDigest_",
            type_hash: "RIHS01_8ace4a29b566a96b4c49aaaef2b97f13b73b877caaa3d473f1e00de9509106b9",
            definition: r##"# Digest of the complete state at the end of a tick. Only in recordings.

# Ticks since the start of the run [1].
uint64 tick
# Digest of the complete state; equal digests mean equal states, bit for bit.
uint64 digest
# Chained digest of the scene's text and of the commands and the digest of every tick so far.
uint64 chain
"##,
        };
    }

    /// Statistics of the simulation, and whether its model is valid.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Statistics {
        /// Simulated time \[s\].
        pub r#header: super::std_msgs::Header,
        /// Simulated time since the start of the run \[s\].
        pub r#sim_time: f64,
        /// Wall-clock time since the first tick \[s\].
        pub r#wall_time: f64,
        /// Simulated time over wall-clock time, during the last second of wall-clock time \[-\].
        pub r#real_time_factor: f64,
        /// Simulated time over wall-clock time, since the first tick \[-\].
        pub r#real_time_factor_mean: f64,
        /// Ticks since the start of the run \[1\].
        pub r#tick: u64,
        /// Length of a substep \[s\].
        pub r#substep: f64,
        /// Kinetic energy of grains and membrane \[J\].
        pub r#kinetic_energy: f64,
        /// Number of contacts between grains \[1\].
        pub r#n_grain_contacts: u32,
        /// Number of contacts between grains and membrane \[1\].
        pub r#n_membrane_contacts: u32,
        /// Number of contacts between membrane and objects \[1\].
        pub r#n_object_contacts: u32,
        /// Digest of the complete state; equal digests mean equal states, bit for bit.
        pub r#state_digest: u64,
        /// Seed of all random numbers.
        pub r#seed: u64,
        /// Commands applied without change \[1\].
        pub r#n_commands_applied: u64,
        /// Commands limited to an allowed range \[1\].
        pub r#n_commands_limited: u64,
        /// Commands rejected \[1\].
        pub r#n_commands_refused: u64,
        /// Counters of each output.
        pub r#sinks: Vec<SinkStatistics>,
        /// Largest overlap between grains over their mean diameter; the contact law is valid for small values \[-\].
        pub r#overlap_ratio_max: f64,
        /// Largest overlap between a grain and the membrane over the mean diameter of the grains \[-\].
        pub r#membrane_overlap_ratio_max: f64,
        /// False if overlap_ratio_max exceeds 0.1, the limit of validity of the contact law.
        pub r#is_valid: bool,
        /// Phase of the built-in controller; empty without one.
        pub r#phase: String,
    }

    impl RosMessage for Statistics {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/Statistics",
            dds_name: "jamgrip_msgs::msg::dds_::Statistics_",
            type_hash: "RIHS01_5ec922689d3677c948c46f4aff57b7eb06502f87efe527eb40d8611ecc864d09",
            definition: r##"# Statistics of the simulation, and whether its model is valid.

# Simulated time [s].
std_msgs/Header header
# Simulated time since the start of the run [s].
float64 sim_time
# Wall-clock time since the first tick [s].
float64 wall_time
# Simulated time over wall-clock time, during the last second of wall-clock time [-].
float64 real_time_factor
# Simulated time over wall-clock time, since the first tick [-].
float64 real_time_factor_mean
# Ticks since the start of the run [1].
uint64 tick
# Length of a substep [s].
float64 substep
# Kinetic energy of grains and membrane [J].
float64 kinetic_energy
# Number of contacts between grains [1].
uint32 n_grain_contacts
# Number of contacts between grains and membrane [1].
uint32 n_membrane_contacts
# Number of contacts between membrane and objects [1].
uint32 n_object_contacts
# Digest of the complete state; equal digests mean equal states, bit for bit.
uint64 state_digest
# Seed of all random numbers.
uint64 seed
# Commands applied without change [1].
uint64 n_commands_applied
# Commands limited to an allowed range [1].
uint64 n_commands_limited
# Commands rejected [1].
uint64 n_commands_refused
# Counters of each output.
jamgrip_msgs/SinkStatistics[] sinks
# Largest overlap between grains over their mean diameter; the contact law is valid for small values [-].
float64 overlap_ratio_max
# Largest overlap between a grain and the membrane over the mean diameter of the grains [-].
float64 membrane_overlap_ratio_max
# False if overlap_ratio_max exceeds 0.1, the limit of validity of the contact law.
bool is_valid
# Phase of the built-in controller; empty without one.
string phase
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: jamgrip_msgs/SinkStatistics
# Counters of one output.

# Name of the output: ros, shm or bag.
string name
# Results written [1].
uint64 n_written
# Results dropped because the output was too slow [1].
uint64 n_dropped
# Results that could not be written [1].
uint64 n_failed
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"##,
        };
    }

    /// State of the air inside the membrane, and jamming of the grains.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct VacuumState {
        /// Simulated time \[s\].
        pub r#header: super::std_msgs::Header,
        /// Actual gauge pressure, negative under vacuum \[Pa\].
        pub r#gauge: f64,
        /// Commanded gauge pressure, within the limits of the pump \[Pa\].
        pub r#gauge_setpoint: f64,
        /// Volume enclosed by membrane and flange \[m^3\].
        pub r#volume: f64,
        /// Fraction of grains with at least four contacts, which can carry load \[-\].
        pub r#jammed_fraction: f64,
        /// Mean number of contacts per grain \[-\].
        pub r#coordination_number: f64,
        /// Volume of the grains over the enclosed volume \[-\].
        pub r#solid_fraction: f64,
        /// Fraction of sliding contacts among the contacts between grains \[-\].
        pub r#sliding_fraction: f64,
        /// Whether an object is held.
        pub r#object_detection: ObjectDetectionStatus,
    }

    impl RosMessage for VacuumState {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/VacuumState",
            dds_name: "jamgrip_msgs::msg::dds_::VacuumState_",
            type_hash: "RIHS01_72a7a4556b7a2097dad83a97e4a7cfa2cb84ae66f86b3f53a80d8bbe4734b29d",
            definition: r##"# State of the air inside the membrane, and jamming of the grains.

# Simulated time [s].
std_msgs/Header header
# Actual gauge pressure, negative under vacuum [Pa].
float64 gauge
# Commanded gauge pressure, within the limits of the pump [Pa].
float64 gauge_setpoint
# Volume enclosed by membrane and flange [m^3].
float64 volume
# Fraction of grains with at least four contacts, which can carry load [-].
float64 jammed_fraction
# Mean number of contacts per grain [-].
float64 coordination_number
# Volume of the grains over the enclosed volume [-].
float64 solid_fraction
# Fraction of sliding contacts among the contacts between grains [-].
float64 sliding_fraction
# Whether an object is held.
jamgrip_msgs/ObjectDetectionStatus object_detection
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: jamgrip_msgs/ObjectDetectionStatus
# Whether the gripper holds an object, with the values that drivers of vacuum grippers use.
#
# The simulated gripper has no such sensor; the status is derived from contact and pressure:
# NO_OBJECT_DETECTED without contact between membrane and objects. With contact it depends on the
# fraction of the commanded vacuum that is reached: OBJECT_DETECTED_AT_MAX_PRESSURE from 95 %,
# OBJECT_DETECTED_AT_MIN_PRESSURE from one sixth, UNKNOWN below that or without vacuum.

# Contact, but not gripped.
int8 UNKNOWN = 0
# Contact, and the vacuum is sufficient to hold the object.
int8 OBJECT_DETECTED_AT_MIN_PRESSURE = 1
# Contact, and the commanded vacuum is reached.
int8 OBJECT_DETECTED_AT_MAX_PRESSURE = 2
# No contact with the membrane.
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

    /// A change of the world between two ticks: a reset, a teleport, an object inserted or removed. Only in
    /// recordings.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct WorldChange {
        /// Ticks since the start of the run, before the change \[1\].
        pub r#tick: u64,
        /// Description of the change.
        pub r#what: String,
        /// The serialized change, which only the simulator reads.
        #[serde(with = "serde_bytes")]
        pub r#change: Vec<u8>,
    }

    impl RosMessage for WorldChange {
        const TYPE: MessageType = MessageType {
            name: "jamgrip_msgs/msg/WorldChange",
            dds_name: "jamgrip_msgs::msg::dds_::WorldChange_",
            type_hash: "RIHS01_22a4a646e7733b7483d705af67570a5da4cb816a79530683d373850e3b9a77e6",
            definition: r##"# A change of the world between two ticks: a reset, a teleport, an object inserted or removed. Only in
# recordings.

# Ticks since the start of the run, before the change [1].
uint64 tick
# Description of the change.
string what
# The serialized change, which only the simulator reads.
uint8[] change
"##,
        };
    }
}

/// Messages of `rcl_interfaces`.
pub mod rcl_interfaces {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `rcl_interfaces/msg/DescribeParametersRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct DescribeParametersRequest {
        /// `string[] names`
        pub r#names: Vec<String>,
    }

    /// `rcl_interfaces/msg/DescribeParametersResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct DescribeParametersResponse {
        /// `rcl_interfaces/ParameterDescriptor[] descriptors`
        pub r#descriptors: Vec<ParameterDescriptor>,
    }

    /// `rcl_interfaces/msg/FloatingPointRange`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct FloatingPointRange {
        /// `float64 from_value`
        pub r#from_value: f64,
        /// `float64 to_value`
        pub r#to_value: f64,
        /// `float64 step`
        pub r#step: f64,
    }

    impl RosMessage for FloatingPointRange {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/FloatingPointRange",
            dds_name: "rcl_interfaces::msg::dds_::FloatingPointRange_",
            type_hash: "RIHS01_e6af23a23c177fee5f3075c8b1e435162a9b63c863d78c06017460b49684262d",
            definition: r##"float64 from_value
float64 to_value
float64 step
"##,
        };
    }

    /// `rcl_interfaces/msg/GetParameterTypesRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetParameterTypesRequest {
        /// `string[] names`
        pub r#names: Vec<String>,
    }

    /// `rcl_interfaces/msg/GetParameterTypesResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetParameterTypesResponse {
        /// `uint8[] types`
        #[serde(with = "serde_bytes")]
        pub r#types: Vec<u8>,
    }

    /// `rcl_interfaces/msg/GetParametersRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetParametersRequest {
        /// `string[] names`
        pub r#names: Vec<String>,
    }

    /// `rcl_interfaces/msg/GetParametersResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetParametersResponse {
        /// `rcl_interfaces/ParameterValue[] values`
        pub r#values: Vec<ParameterValue>,
    }

    /// `rcl_interfaces/msg/IntegerRange`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct IntegerRange {
        /// `int64 from_value`
        pub r#from_value: i64,
        /// `int64 to_value`
        pub r#to_value: i64,
        /// `uint64 step`
        pub r#step: u64,
    }

    impl RosMessage for IntegerRange {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/IntegerRange",
            dds_name: "rcl_interfaces::msg::dds_::IntegerRange_",
            type_hash: "RIHS01_f7b7fdc0f65f07702e099218e13288c3963bcb9345bde78b560e6cd19800fc5a",
            definition: r##"int64 from_value
int64 to_value
uint64 step
"##,
        };
    }

    /// `rcl_interfaces/msg/ListParametersRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ListParametersRequest {
        /// `string[] prefixes`
        pub r#prefixes: Vec<String>,
        /// `uint64 depth`
        pub r#depth: u64,
    }

    impl ListParametersRequest {
        /// `uint64 DEPTH_RECURSIVE`
        pub const DEPTH_RECURSIVE: u64 = 0;
    }

    /// `rcl_interfaces/msg/ListParametersResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ListParametersResponse {
        /// `rcl_interfaces/ListParametersResult result`
        pub r#result: ListParametersResult,
    }

    /// `rcl_interfaces/msg/ListParametersResult`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ListParametersResult {
        /// `string[] names`
        pub r#names: Vec<String>,
        /// `string[] prefixes`
        pub r#prefixes: Vec<String>,
    }

    impl RosMessage for ListParametersResult {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/ListParametersResult",
            dds_name: "rcl_interfaces::msg::dds_::ListParametersResult_",
            type_hash: "RIHS01_237ae3428413dcbcfb452b510c42355f3a2b021dc091afa3e18526d57022f1cd",
            definition: r##"string[] names
string[] prefixes
"##,
        };
    }

    /// `rcl_interfaces/msg/Parameter`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Parameter {
        /// `string name`
        pub r#name: String,
        /// `rcl_interfaces/ParameterValue value`
        pub r#value: ParameterValue,
    }

    impl RosMessage for Parameter {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/Parameter",
            dds_name: "rcl_interfaces::msg::dds_::Parameter_",
            type_hash: "RIHS01_ddfe6442cffc462317adb5c92536a7b6dd55858c5c3e1e328165a6b73c2831af",
            definition: r##"string name
rcl_interfaces/ParameterValue value
================================================================================
MSG: rcl_interfaces/ParameterValue
uint8 type
bool bool_value
int64 integer_value
float64 double_value
string string_value
byte[] byte_array_value
bool[] bool_array_value
int64[] integer_array_value
float64[] double_array_value
string[] string_array_value
"##,
        };
    }

    /// `rcl_interfaces/msg/ParameterDescriptor`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ParameterDescriptor {
        /// `string name`
        pub r#name: String,
        /// `uint8 type`
        pub r#type: u8,
        /// `string description`
        pub r#description: String,
        /// `string additional_constraints`
        pub r#additional_constraints: String,
        /// `bool read_only`
        pub r#read_only: bool,
        /// `bool dynamic_typing`
        pub r#dynamic_typing: bool,
        /// `rcl_interfaces/FloatingPointRange[<=1] floating_point_range`
        pub r#floating_point_range: Vec<FloatingPointRange>,
        /// `rcl_interfaces/IntegerRange[<=1] integer_range`
        pub r#integer_range: Vec<IntegerRange>,
    }

    impl RosMessage for ParameterDescriptor {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/ParameterDescriptor",
            dds_name: "rcl_interfaces::msg::dds_::ParameterDescriptor_",
            type_hash: "RIHS01_52175dbfda6c51153101d33d2a9da05743f66f02d5ab2ca9ec4709b46b73d704",
            definition: r##"string name
uint8 type
string description
string additional_constraints
bool read_only
bool dynamic_typing
rcl_interfaces/FloatingPointRange[<=1] floating_point_range
rcl_interfaces/IntegerRange[<=1] integer_range
================================================================================
MSG: rcl_interfaces/FloatingPointRange
float64 from_value
float64 to_value
float64 step
================================================================================
MSG: rcl_interfaces/IntegerRange
int64 from_value
int64 to_value
uint64 step
"##,
        };
    }

    /// `rcl_interfaces/msg/ParameterEvent`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ParameterEvent {
        /// `builtin_interfaces/Time stamp`
        pub r#stamp: super::builtin_interfaces::Time,
        /// `string node`
        pub r#node: String,
        /// `rcl_interfaces/Parameter[] new_parameters`
        pub r#new_parameters: Vec<Parameter>,
        /// `rcl_interfaces/Parameter[] changed_parameters`
        pub r#changed_parameters: Vec<Parameter>,
        /// `rcl_interfaces/Parameter[] deleted_parameters`
        pub r#deleted_parameters: Vec<Parameter>,
    }

    impl RosMessage for ParameterEvent {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/ParameterEvent",
            dds_name: "rcl_interfaces::msg::dds_::ParameterEvent_",
            type_hash: "RIHS01_043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204",
            definition: r##"builtin_interfaces/Time stamp
string node
rcl_interfaces/Parameter[] new_parameters
rcl_interfaces/Parameter[] changed_parameters
rcl_interfaces/Parameter[] deleted_parameters
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: rcl_interfaces/Parameter
string name
rcl_interfaces/ParameterValue value
================================================================================
MSG: rcl_interfaces/ParameterValue
uint8 type
bool bool_value
int64 integer_value
float64 double_value
string string_value
byte[] byte_array_value
bool[] bool_array_value
int64[] integer_array_value
float64[] double_array_value
string[] string_array_value
"##,
        };
    }

    /// `rcl_interfaces/msg/ParameterType`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ParameterType {
    }

    impl ParameterType {
        /// `uint8 PARAMETER_NOT_SET`
        pub const PARAMETER_NOT_SET: u8 = 0;
        /// `uint8 PARAMETER_BOOL`
        pub const PARAMETER_BOOL: u8 = 1;
        /// `uint8 PARAMETER_INTEGER`
        pub const PARAMETER_INTEGER: u8 = 2;
        /// `uint8 PARAMETER_DOUBLE`
        pub const PARAMETER_DOUBLE: u8 = 3;
        /// `uint8 PARAMETER_STRING`
        pub const PARAMETER_STRING: u8 = 4;
        /// `uint8 PARAMETER_BYTE_ARRAY`
        pub const PARAMETER_BYTE_ARRAY: u8 = 5;
        /// `uint8 PARAMETER_BOOL_ARRAY`
        pub const PARAMETER_BOOL_ARRAY: u8 = 6;
        /// `uint8 PARAMETER_INTEGER_ARRAY`
        pub const PARAMETER_INTEGER_ARRAY: u8 = 7;
        /// `uint8 PARAMETER_DOUBLE_ARRAY`
        pub const PARAMETER_DOUBLE_ARRAY: u8 = 8;
        /// `uint8 PARAMETER_STRING_ARRAY`
        pub const PARAMETER_STRING_ARRAY: u8 = 9;
    }

    impl RosMessage for ParameterType {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/ParameterType",
            dds_name: "rcl_interfaces::msg::dds_::ParameterType_",
            type_hash: "RIHS01_df29ed057a834862187be24dd187d981790ff3ea6502f4cd27b432cbc42c6d46",
            definition: r##"uint8 PARAMETER_NOT_SET=0
uint8 PARAMETER_BOOL=1
uint8 PARAMETER_INTEGER=2
uint8 PARAMETER_DOUBLE=3
uint8 PARAMETER_STRING=4
uint8 PARAMETER_BYTE_ARRAY=5
uint8 PARAMETER_BOOL_ARRAY=6
uint8 PARAMETER_INTEGER_ARRAY=7
uint8 PARAMETER_DOUBLE_ARRAY=8
uint8 PARAMETER_STRING_ARRAY=9
"##,
        };
    }

    /// `rcl_interfaces/msg/ParameterValue`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ParameterValue {
        /// `uint8 type`
        pub r#type: u8,
        /// `bool bool_value`
        pub r#bool_value: bool,
        /// `int64 integer_value`
        pub r#integer_value: i64,
        /// `float64 double_value`
        pub r#double_value: f64,
        /// `string string_value`
        pub r#string_value: String,
        /// `byte[] byte_array_value`
        #[serde(with = "serde_bytes")]
        pub r#byte_array_value: Vec<u8>,
        /// `bool[] bool_array_value`
        pub r#bool_array_value: Vec<bool>,
        /// `int64[] integer_array_value`
        pub r#integer_array_value: Vec<i64>,
        /// `float64[] double_array_value`
        pub r#double_array_value: Vec<f64>,
        /// `string[] string_array_value`
        pub r#string_array_value: Vec<String>,
    }

    impl RosMessage for ParameterValue {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/ParameterValue",
            dds_name: "rcl_interfaces::msg::dds_::ParameterValue_",
            type_hash: "RIHS01_115fc089a387e23c7ecd3525c9189c379109119d6ab82e8dfbde0fdf6a7f9b68",
            definition: r##"uint8 type
bool bool_value
int64 integer_value
float64 double_value
string string_value
byte[] byte_array_value
bool[] bool_array_value
int64[] integer_array_value
float64[] double_array_value
string[] string_array_value
"##,
        };
    }

    /// `rcl_interfaces/msg/SetParametersAtomicallyRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetParametersAtomicallyRequest {
        /// `rcl_interfaces/Parameter[] parameters`
        pub r#parameters: Vec<Parameter>,
    }

    /// `rcl_interfaces/msg/SetParametersAtomicallyResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetParametersAtomicallyResponse {
        /// `rcl_interfaces/SetParametersResult result`
        pub r#result: SetParametersResult,
    }

    /// `rcl_interfaces/msg/SetParametersRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetParametersRequest {
        /// `rcl_interfaces/Parameter[] parameters`
        pub r#parameters: Vec<Parameter>,
    }

    /// `rcl_interfaces/msg/SetParametersResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetParametersResponse {
        /// `rcl_interfaces/SetParametersResult[] results`
        pub r#results: Vec<SetParametersResult>,
    }

    /// `rcl_interfaces/msg/SetParametersResult`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetParametersResult {
        /// `bool successful`
        pub r#successful: bool,
        /// `string reason`
        pub r#reason: String,
    }

    impl RosMessage for SetParametersResult {
        const TYPE: MessageType = MessageType {
            name: "rcl_interfaces/msg/SetParametersResult",
            dds_name: "rcl_interfaces::msg::dds_::SetParametersResult_",
            type_hash: "RIHS01_cfcc0fb0371ee5159b403960ef4300f8f9d2f1fd6117c8666b7f9654d528a9b1",
            definition: r##"bool successful
string reason
"##,
        };
    }

    /// Services of `rcl_interfaces`.
    pub mod srv {
        use crate::wire::messages::{RosService, ServiceType};

        /// `rcl_interfaces/srv/DescribeParameters`.
        #[derive(Clone, Copy, Debug)]
        pub struct DescribeParameters;

        impl RosService for DescribeParameters {
            type Request = super::DescribeParametersRequest;
            type Response = super::DescribeParametersResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rcl_interfaces/srv/DescribeParameters",
                request_dds_name: "rcl_interfaces::srv::dds_::DescribeParameters_Request_",
                response_dds_name: "rcl_interfaces::srv::dds_::DescribeParameters_Response_",
            };
        }

        /// `rcl_interfaces/srv/GetParameterTypes`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetParameterTypes;

        impl RosService for GetParameterTypes {
            type Request = super::GetParameterTypesRequest;
            type Response = super::GetParameterTypesResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rcl_interfaces/srv/GetParameterTypes",
                request_dds_name: "rcl_interfaces::srv::dds_::GetParameterTypes_Request_",
                response_dds_name: "rcl_interfaces::srv::dds_::GetParameterTypes_Response_",
            };
        }

        /// `rcl_interfaces/srv/GetParameters`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetParameters;

        impl RosService for GetParameters {
            type Request = super::GetParametersRequest;
            type Response = super::GetParametersResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rcl_interfaces/srv/GetParameters",
                request_dds_name: "rcl_interfaces::srv::dds_::GetParameters_Request_",
                response_dds_name: "rcl_interfaces::srv::dds_::GetParameters_Response_",
            };
        }

        /// `rcl_interfaces/srv/ListParameters`.
        #[derive(Clone, Copy, Debug)]
        pub struct ListParameters;

        impl RosService for ListParameters {
            type Request = super::ListParametersRequest;
            type Response = super::ListParametersResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rcl_interfaces/srv/ListParameters",
                request_dds_name: "rcl_interfaces::srv::dds_::ListParameters_Request_",
                response_dds_name: "rcl_interfaces::srv::dds_::ListParameters_Response_",
            };
        }

        /// `rcl_interfaces/srv/SetParameters`.
        #[derive(Clone, Copy, Debug)]
        pub struct SetParameters;

        impl RosService for SetParameters {
            type Request = super::SetParametersRequest;
            type Response = super::SetParametersResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rcl_interfaces/srv/SetParameters",
                request_dds_name: "rcl_interfaces::srv::dds_::SetParameters_Request_",
                response_dds_name: "rcl_interfaces::srv::dds_::SetParameters_Response_",
            };
        }

        /// `rcl_interfaces/srv/SetParametersAtomically`.
        #[derive(Clone, Copy, Debug)]
        pub struct SetParametersAtomically;

        impl RosService for SetParametersAtomically {
            type Request = super::SetParametersAtomicallyRequest;
            type Response = super::SetParametersAtomicallyResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rcl_interfaces/srv/SetParametersAtomically",
                request_dds_name: "rcl_interfaces::srv::dds_::SetParametersAtomically_Request_",
                response_dds_name: "rcl_interfaces::srv::dds_::SetParametersAtomically_Response_",
            };
        }
    }
}

/// Messages of `rosbag2_interfaces`.
pub mod rosbag2_interfaces {

    /// `rosbag2_interfaces/msg/BurstRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct BurstRequest {
        /// `uint64 num_messages`
        pub r#num_messages: u64,
    }

    /// `rosbag2_interfaces/msg/BurstResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct BurstResponse {
        /// `uint64 actually_burst`
        pub r#actually_burst: u64,
    }

    /// `rosbag2_interfaces/msg/GetRateRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetRateRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/GetRateResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetRateResponse {
        /// `float64 rate`
        pub r#rate: f64,
    }

    /// `rosbag2_interfaces/msg/IsPausedRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct IsPausedRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/IsPausedResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct IsPausedResponse {
        /// `bool paused`
        pub r#paused: bool,
    }

    /// `rosbag2_interfaces/msg/PauseRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct PauseRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/PauseResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct PauseResponse {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/PlayNextRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct PlayNextRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/PlayNextResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct PlayNextResponse {
        /// `bool success`
        pub r#success: bool,
    }

    /// `rosbag2_interfaces/msg/ResumeRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ResumeRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/ResumeResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ResumeResponse {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/SeekRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SeekRequest {
        /// `builtin_interfaces/Time time`
        pub r#time: super::builtin_interfaces::Time,
    }

    /// `rosbag2_interfaces/msg/SeekResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SeekResponse {
        /// `bool success`
        pub r#success: bool,
    }

    /// `rosbag2_interfaces/msg/SetRateRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetRateRequest {
        /// `float64 rate`
        pub r#rate: f64,
    }

    /// `rosbag2_interfaces/msg/SetRateResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetRateResponse {
        /// `bool success`
        pub r#success: bool,
    }

    /// `rosbag2_interfaces/msg/StopRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct StopRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/StopResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct StopResponse {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/TogglePausedRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct TogglePausedRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `rosbag2_interfaces/msg/TogglePausedResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct TogglePausedResponse {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// Services of `rosbag2_interfaces`.
    pub mod srv {
        use crate::wire::messages::{RosService, ServiceType};

        /// `rosbag2_interfaces/srv/Burst`.
        #[derive(Clone, Copy, Debug)]
        pub struct Burst;

        impl RosService for Burst {
            type Request = super::BurstRequest;
            type Response = super::BurstResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/Burst",
                request_dds_name: "rosbag2_interfaces::srv::dds_::Burst_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::Burst_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/GetRate`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetRate;

        impl RosService for GetRate {
            type Request = super::GetRateRequest;
            type Response = super::GetRateResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/GetRate",
                request_dds_name: "rosbag2_interfaces::srv::dds_::GetRate_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::GetRate_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/IsPaused`.
        #[derive(Clone, Copy, Debug)]
        pub struct IsPaused;

        impl RosService for IsPaused {
            type Request = super::IsPausedRequest;
            type Response = super::IsPausedResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/IsPaused",
                request_dds_name: "rosbag2_interfaces::srv::dds_::IsPaused_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::IsPaused_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/Pause`.
        #[derive(Clone, Copy, Debug)]
        pub struct Pause;

        impl RosService for Pause {
            type Request = super::PauseRequest;
            type Response = super::PauseResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/Pause",
                request_dds_name: "rosbag2_interfaces::srv::dds_::Pause_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::Pause_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/PlayNext`.
        #[derive(Clone, Copy, Debug)]
        pub struct PlayNext;

        impl RosService for PlayNext {
            type Request = super::PlayNextRequest;
            type Response = super::PlayNextResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/PlayNext",
                request_dds_name: "rosbag2_interfaces::srv::dds_::PlayNext_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::PlayNext_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/Resume`.
        #[derive(Clone, Copy, Debug)]
        pub struct Resume;

        impl RosService for Resume {
            type Request = super::ResumeRequest;
            type Response = super::ResumeResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/Resume",
                request_dds_name: "rosbag2_interfaces::srv::dds_::Resume_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::Resume_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/Seek`.
        #[derive(Clone, Copy, Debug)]
        pub struct Seek;

        impl RosService for Seek {
            type Request = super::SeekRequest;
            type Response = super::SeekResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/Seek",
                request_dds_name: "rosbag2_interfaces::srv::dds_::Seek_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::Seek_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/SetRate`.
        #[derive(Clone, Copy, Debug)]
        pub struct SetRate;

        impl RosService for SetRate {
            type Request = super::SetRateRequest;
            type Response = super::SetRateResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/SetRate",
                request_dds_name: "rosbag2_interfaces::srv::dds_::SetRate_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::SetRate_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/Stop`.
        #[derive(Clone, Copy, Debug)]
        pub struct Stop;

        impl RosService for Stop {
            type Request = super::StopRequest;
            type Response = super::StopResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/Stop",
                request_dds_name: "rosbag2_interfaces::srv::dds_::Stop_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::Stop_Response_",
            };
        }

        /// `rosbag2_interfaces/srv/TogglePaused`.
        #[derive(Clone, Copy, Debug)]
        pub struct TogglePaused;

        impl RosService for TogglePaused {
            type Request = super::TogglePausedRequest;
            type Response = super::TogglePausedResponse;
            const TYPE: ServiceType = ServiceType {
                name: "rosbag2_interfaces/srv/TogglePaused",
                request_dds_name: "rosbag2_interfaces::srv::dds_::TogglePaused_Request_",
                response_dds_name: "rosbag2_interfaces::srv::dds_::TogglePaused_Response_",
            };
        }
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

/// Messages of `simulation_interfaces`.
pub mod simulation_interfaces {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `simulation_interfaces/msg/Bounds`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Bounds {
        /// `uint8 type`
        pub r#type: u8,
        /// `geometry_msgs/Vector3[] points`
        pub r#points: Vec<super::geometry_msgs::Vector3>,
    }

    impl Bounds {
        /// `uint8 TYPE_EMPTY`
        pub const TYPE_EMPTY: u8 = 0;
        /// `uint8 TYPE_BOX`
        pub const TYPE_BOX: u8 = 1;
        /// `uint8 TYPE_CONVEX_HULL`
        pub const TYPE_CONVEX_HULL: u8 = 2;
        /// `uint8 TYPE_SPHERE`
        pub const TYPE_SPHERE: u8 = 3;
    }

    impl RosMessage for Bounds {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/Bounds",
            dds_name: "simulation_interfaces::msg::dds_::Bounds_",
            type_hash: "RIHS01_e8624fe51f0f5548197542697d924c5699ac7198f1e4c68e50c3ca2af73f5b3f",
            definition: r##"uint8 TYPE_EMPTY = 0
uint8 TYPE_BOX = 1
uint8 TYPE_CONVEX_HULL = 2
uint8 TYPE_SPHERE = 3
uint8 type
geometry_msgs/Vector3[] points
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"##,
        };
    }

    /// `simulation_interfaces/msg/DeleteEntityRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct DeleteEntityRequest {
        /// `string entity`
        pub r#entity: String,
    }

    /// `simulation_interfaces/msg/DeleteEntityResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct DeleteEntityResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    /// `simulation_interfaces/msg/EntityCategory`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct EntityCategory {
        /// `uint8 category`
        pub r#category: u8,
    }

    impl EntityCategory {
        /// `uint8 CATEGORY_OBJECT`
        pub const CATEGORY_OBJECT: u8 = 0;
        /// `uint8 CATEGORY_ROBOT`
        pub const CATEGORY_ROBOT: u8 = 1;
        /// `uint8 CATEGORY_HUMAN`
        pub const CATEGORY_HUMAN: u8 = 2;
        /// `uint8 CATEGORY_DYNAMIC_OBJECT`
        pub const CATEGORY_DYNAMIC_OBJECT: u8 = 4;
        /// `uint8 CATEGORY_STATIC_OBJECT`
        pub const CATEGORY_STATIC_OBJECT: u8 = 5;
    }

    impl RosMessage for EntityCategory {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/EntityCategory",
            dds_name: "simulation_interfaces::msg::dds_::EntityCategory_",
            type_hash: "RIHS01_43bdf7933fddf75f6970f7a8fe7078524355d821d390b3954bb46ac36c03dfe1",
            definition: r##"uint8 CATEGORY_OBJECT = 0
uint8 CATEGORY_ROBOT = 1
uint8 CATEGORY_HUMAN = 2
uint8 CATEGORY_DYNAMIC_OBJECT = 4
uint8 CATEGORY_STATIC_OBJECT = 5
uint8 category
"##,
        };
    }

    /// `simulation_interfaces/msg/EntityFilters`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct EntityFilters {
        /// `string filter`
        pub r#filter: String,
        /// `simulation_interfaces/EntityCategory[] categories`
        pub r#categories: Vec<EntityCategory>,
        /// `simulation_interfaces/TagsFilter tags`
        pub r#tags: TagsFilter,
        /// `simulation_interfaces/Bounds bounds`
        pub r#bounds: Bounds,
    }

    impl RosMessage for EntityFilters {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/EntityFilters",
            dds_name: "simulation_interfaces::msg::dds_::EntityFilters_",
            type_hash: "RIHS01_8e7b12e8ea062f14c55de4877221fe1b7cd9749665a7ad8a4ab855fc4b148303",
            definition: r##"string filter
EntityCategory[] categories
TagsFilter tags
Bounds bounds
================================================================================
MSG: simulation_interfaces/EntityCategory
uint8 CATEGORY_OBJECT = 0
uint8 CATEGORY_ROBOT = 1
uint8 CATEGORY_HUMAN = 2
uint8 CATEGORY_DYNAMIC_OBJECT = 4
uint8 CATEGORY_STATIC_OBJECT = 5
uint8 category
================================================================================
MSG: simulation_interfaces/TagsFilter
string[] tags
uint8 FILTER_MODE_ANY = 0
uint8 FILTER_MODE_ALL = 1
uint8 filter_mode
================================================================================
MSG: simulation_interfaces/Bounds
uint8 TYPE_EMPTY = 0
uint8 TYPE_BOX = 1
uint8 TYPE_CONVEX_HULL = 2
uint8 TYPE_SPHERE = 3
uint8 type
geometry_msgs/Vector3[] points
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"##,
        };
    }

    /// `simulation_interfaces/msg/EntityInfo`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct EntityInfo {
        /// `simulation_interfaces/EntityCategory category`
        pub r#category: EntityCategory,
        /// `string description`
        pub r#description: String,
        /// `string[] tags`
        pub r#tags: Vec<String>,
    }

    impl RosMessage for EntityInfo {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/EntityInfo",
            dds_name: "simulation_interfaces::msg::dds_::EntityInfo_",
            type_hash: "RIHS01_3b9a2e7fa00f9a59d325b6e47904044c421561a385682027c7fc06c359806319",
            definition: r##"EntityCategory category
string description
string[] tags
================================================================================
MSG: simulation_interfaces/EntityCategory
uint8 CATEGORY_OBJECT = 0
uint8 CATEGORY_ROBOT = 1
uint8 CATEGORY_HUMAN = 2
uint8 CATEGORY_DYNAMIC_OBJECT = 4
uint8 CATEGORY_STATIC_OBJECT = 5
uint8 category
"##,
        };
    }

    /// `simulation_interfaces/msg/EntityState`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct EntityState {
        /// `std_msgs/Header header`
        pub r#header: super::std_msgs::Header,
        /// `geometry_msgs/Pose pose`
        pub r#pose: super::geometry_msgs::Pose,
        /// `geometry_msgs/Twist twist`
        pub r#twist: super::geometry_msgs::Twist,
        /// `geometry_msgs/Accel acceleration`
        pub r#acceleration: super::geometry_msgs::Accel,
    }

    impl RosMessage for EntityState {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/EntityState",
            dds_name: "simulation_interfaces::msg::dds_::EntityState_",
            type_hash: "RIHS01_2e0464a85eb80a939025075d6c20761eca6a4cb9d6baf2c0ba373467c8b598d0",
            definition: r##"std_msgs/Header header
geometry_msgs/Pose pose
geometry_msgs/Twist twist
geometry_msgs/Accel acceleration
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
================================================================================
MSG: geometry_msgs/Accel
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
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

    /// `simulation_interfaces/msg/GetAvailableWorldsRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetAvailableWorldsRequest {
        /// `string[] additional_sources`
        pub r#additional_sources: Vec<String>,
        /// `simulation_interfaces/TagsFilter filter`
        pub r#filter: TagsFilter,
        /// `bool offline_only`
        pub r#offline_only: bool,
        /// `bool continue_on_error`
        pub r#continue_on_error: bool,
    }

    /// `simulation_interfaces/msg/GetAvailableWorldsResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetAvailableWorldsResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/WorldResource[] worlds`
        pub r#worlds: Vec<WorldResource>,
    }

    impl GetAvailableWorldsResponse {
        /// `uint8 DEFAULT_SOURCES_FAILED`
        pub const DEFAULT_SOURCES_FAILED: u8 = 101;
    }

    /// `simulation_interfaces/msg/GetCurrentWorldRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetCurrentWorldRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `simulation_interfaces/msg/GetCurrentWorldResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetCurrentWorldResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/WorldResource world`
        pub r#world: WorldResource,
    }

    impl GetCurrentWorldResponse {
        /// `uint8 NO_WORLD_LOADED`
        pub const NO_WORLD_LOADED: u8 = 101;
    }

    /// `simulation_interfaces/msg/GetEntitiesRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntitiesRequest {
        /// `simulation_interfaces/EntityFilters filters`
        pub r#filters: EntityFilters,
    }

    /// `simulation_interfaces/msg/GetEntitiesResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntitiesResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `string[] entities`
        pub r#entities: Vec<String>,
    }

    /// `simulation_interfaces/msg/GetEntitiesStatesRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntitiesStatesRequest {
        /// `simulation_interfaces/EntityFilters filters`
        pub r#filters: EntityFilters,
    }

    /// `simulation_interfaces/msg/GetEntitiesStatesResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntitiesStatesResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `string[] entities`
        pub r#entities: Vec<String>,
        /// `simulation_interfaces/EntityState[] states`
        pub r#states: Vec<EntityState>,
    }

    /// `simulation_interfaces/msg/GetEntityBoundsRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntityBoundsRequest {
        /// `string entity`
        pub r#entity: String,
    }

    /// `simulation_interfaces/msg/GetEntityBoundsResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntityBoundsResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/Bounds bounds`
        pub r#bounds: Bounds,
    }

    /// `simulation_interfaces/msg/GetEntityInfoRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntityInfoRequest {
        /// `string entity`
        pub r#entity: String,
    }

    /// `simulation_interfaces/msg/GetEntityInfoResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntityInfoResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/EntityInfo info`
        pub r#info: EntityInfo,
    }

    /// `simulation_interfaces/msg/GetEntityStateRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntityStateRequest {
        /// `string entity`
        pub r#entity: String,
    }

    /// `simulation_interfaces/msg/GetEntityStateResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetEntityStateResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/EntityState state`
        pub r#state: EntityState,
    }

    /// `simulation_interfaces/msg/GetNamedPoseBoundsRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetNamedPoseBoundsRequest {
        /// `string name`
        pub r#name: String,
    }

    /// `simulation_interfaces/msg/GetNamedPoseBoundsResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetNamedPoseBoundsResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/Bounds bounds`
        pub r#bounds: Bounds,
    }

    /// `simulation_interfaces/msg/GetNamedPosesRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetNamedPosesRequest {
        /// `simulation_interfaces/TagsFilter tags`
        pub r#tags: TagsFilter,
    }

    /// `simulation_interfaces/msg/GetNamedPosesResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetNamedPosesResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/NamedPose[] poses`
        pub r#poses: Vec<NamedPose>,
    }

    /// `simulation_interfaces/msg/GetSimulationStateRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetSimulationStateRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `simulation_interfaces/msg/GetSimulationStateResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetSimulationStateResponse {
        /// `simulation_interfaces/SimulationState state`
        pub r#state: SimulationState,
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    /// `simulation_interfaces/msg/GetSimulatorFeaturesRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetSimulatorFeaturesRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `simulation_interfaces/msg/GetSimulatorFeaturesResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetSimulatorFeaturesResponse {
        /// `simulation_interfaces/SimulatorFeatures features`
        pub r#features: SimulatorFeatures,
    }

    /// `simulation_interfaces/msg/GetSpawnablesRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetSpawnablesRequest {
        /// `string[] sources`
        pub r#sources: Vec<String>,
    }

    /// `simulation_interfaces/msg/GetSpawnablesResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct GetSpawnablesResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/Spawnable[] spawnables`
        pub r#spawnables: Vec<Spawnable>,
    }

    /// `simulation_interfaces/msg/LoadWorldRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct LoadWorldRequest {
        /// `simulation_interfaces/Resource world_resource`
        pub r#world_resource: Resource,
        /// `bool fail_on_unsupported_element`
        pub r#fail_on_unsupported_element: bool,
        /// `bool ignore_missing_or_unsupported_assets`
        pub r#ignore_missing_or_unsupported_assets: bool,
    }

    /// `simulation_interfaces/msg/LoadWorldResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct LoadWorldResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/WorldResource world`
        pub r#world: WorldResource,
    }

    impl LoadWorldResponse {
        /// `uint8 UNSUPPORTED_FORMAT`
        pub const UNSUPPORTED_FORMAT: u8 = 101;
        /// `uint8 NO_RESOURCE`
        pub const NO_RESOURCE: u8 = 102;
        /// `uint8 RESOURCE_PARSE_ERROR`
        pub const RESOURCE_PARSE_ERROR: u8 = 103;
        /// `uint8 MISSING_ASSETS`
        pub const MISSING_ASSETS: u8 = 104;
        /// `uint8 UNSUPPORTED_ASSETS`
        pub const UNSUPPORTED_ASSETS: u8 = 105;
        /// `uint8 UNSUPPORTED_ELEMENTS`
        pub const UNSUPPORTED_ELEMENTS: u8 = 106;
    }

    /// `simulation_interfaces/msg/NamedPose`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct NamedPose {
        /// `string name`
        pub r#name: String,
        /// `string description`
        pub r#description: String,
        /// `string[] tags`
        pub r#tags: Vec<String>,
        /// `geometry_msgs/Pose pose`
        pub r#pose: super::geometry_msgs::Pose,
    }

    impl RosMessage for NamedPose {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/NamedPose",
            dds_name: "simulation_interfaces::msg::dds_::NamedPose_",
            type_hash: "RIHS01_b32da2a039b1840f605ec025b7991a18efacac662fac272818d1ae6e2b12bc27",
            definition: r##"string name
string description
string[] tags
geometry_msgs/Pose pose
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
"##,
        };
    }

    /// `simulation_interfaces/msg/ResetSimulationRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ResetSimulationRequest {
        /// `uint8 scope`
        pub r#scope: u8,
    }

    impl ResetSimulationRequest {
        /// `uint8 SCOPE_DEFAULT`
        pub const SCOPE_DEFAULT: u8 = 0;
        /// `uint8 SCOPE_TIME`
        pub const SCOPE_TIME: u8 = 1;
        /// `uint8 SCOPE_STATE`
        pub const SCOPE_STATE: u8 = 2;
        /// `uint8 SCOPE_SPAWNED`
        pub const SCOPE_SPAWNED: u8 = 4;
        /// `uint8 SCOPE_ALL`
        pub const SCOPE_ALL: u8 = 255;
    }

    /// `simulation_interfaces/msg/ResetSimulationResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct ResetSimulationResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    /// `simulation_interfaces/msg/Resource`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Resource {
        /// `string uri`
        pub r#uri: String,
        /// `string resource_string`
        pub r#resource_string: String,
    }

    impl RosMessage for Resource {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/Resource",
            dds_name: "simulation_interfaces::msg::dds_::Resource_",
            type_hash: "RIHS01_2bb1939cf80f8d2f284afba53cbec60b5ff33759bd39b714128ea8867a34c51a",
            definition: r##"string uri
string resource_string
"##,
        };
    }

    /// `simulation_interfaces/msg/Result`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Result {
        /// `uint8 result`
        pub r#result: u8,
        /// `string error_message`
        pub r#error_message: String,
    }

    impl Result {
        /// `uint8 RESULT_FEATURE_UNSUPPORTED`
        pub const RESULT_FEATURE_UNSUPPORTED: u8 = 0;
        /// `uint8 RESULT_OK`
        pub const RESULT_OK: u8 = 1;
        /// `uint8 RESULT_NOT_FOUND`
        pub const RESULT_NOT_FOUND: u8 = 2;
        /// `uint8 RESULT_INCORRECT_STATE`
        pub const RESULT_INCORRECT_STATE: u8 = 3;
        /// `uint8 RESULT_OPERATION_FAILED`
        pub const RESULT_OPERATION_FAILED: u8 = 4;
    }

    impl RosMessage for Result {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/Result",
            dds_name: "simulation_interfaces::msg::dds_::Result_",
            type_hash: "RIHS01_cf43a306adff3337a0a47143d8f5689933bc70a30478f13b077dc1fe3bc5ad17",
            definition: r##"uint8 RESULT_FEATURE_UNSUPPORTED = 0
uint8 RESULT_OK = 1
uint8 RESULT_NOT_FOUND = 2
uint8 RESULT_INCORRECT_STATE = 3
uint8 RESULT_OPERATION_FAILED = 4
uint8 result
string error_message
"##,
        };
    }

    /// `simulation_interfaces/msg/SetEntityInfoRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetEntityInfoRequest {
        /// `string entity`
        pub r#entity: String,
        /// `simulation_interfaces/EntityInfo info`
        pub r#info: EntityInfo,
    }

    /// `simulation_interfaces/msg/SetEntityInfoResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetEntityInfoResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    /// `simulation_interfaces/msg/SetEntityStateRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetEntityStateRequest {
        /// `string entity`
        pub r#entity: String,
        /// `simulation_interfaces/EntityState state`
        pub r#state: EntityState,
        /// `bool set_pose`
        pub r#set_pose: bool,
        /// `bool set_twist`
        pub r#set_twist: bool,
        /// `bool set_acceleration`
        pub r#set_acceleration: bool,
    }

    /// `simulation_interfaces/msg/SetEntityStateResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetEntityStateResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    impl SetEntityStateResponse {
        /// `uint8 INVALID_POSE`
        pub const INVALID_POSE: u8 = 101;
    }

    /// `simulation_interfaces/msg/SetSimulationStateRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetSimulationStateRequest {
        /// `simulation_interfaces/SimulationState state`
        pub r#state: SimulationState,
    }

    /// `simulation_interfaces/msg/SetSimulationStateResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetSimulationStateResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    impl SetSimulationStateResponse {
        /// `uint8 ALREADY_IN_TARGET_STATE`
        pub const ALREADY_IN_TARGET_STATE: u8 = 101;
        /// `uint8 STATE_TRANSITION_ERROR`
        pub const STATE_TRANSITION_ERROR: u8 = 102;
        /// `uint8 INCORRECT_TRANSITION`
        pub const INCORRECT_TRANSITION: u8 = 103;
    }

    /// `simulation_interfaces/msg/SimulateStepsFeedback`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SimulateStepsFeedback {
        /// `uint64 completed_steps`
        pub r#completed_steps: u64,
        /// `uint64 remaining_steps`
        pub r#remaining_steps: u64,
    }

    /// `simulation_interfaces/msg/SimulateStepsGoal`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SimulateStepsGoal {
        /// `uint64 steps`
        pub r#steps: u64,
    }

    /// `simulation_interfaces/msg/SimulateStepsResult`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SimulateStepsResult {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    /// `simulation_interfaces/msg/SimulationState`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SimulationState {
        /// `uint8 state`
        pub r#state: u8,
    }

    impl SimulationState {
        /// `uint8 STATE_STOPPED`
        pub const STATE_STOPPED: u8 = 0;
        /// `uint8 STATE_PLAYING`
        pub const STATE_PLAYING: u8 = 1;
        /// `uint8 STATE_PAUSED`
        pub const STATE_PAUSED: u8 = 2;
        /// `uint8 STATE_QUITTING`
        pub const STATE_QUITTING: u8 = 3;
        /// `uint8 STATE_NO_WORLD`
        pub const STATE_NO_WORLD: u8 = 4;
        /// `uint8 STATE_LOADING_WORLD`
        pub const STATE_LOADING_WORLD: u8 = 5;
    }

    impl RosMessage for SimulationState {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/SimulationState",
            dds_name: "simulation_interfaces::msg::dds_::SimulationState_",
            type_hash: "RIHS01_bb9f87ccdd98fba113052a512d9801e84ce732d0a2b3c2b0cb281828de36e415",
            definition: r##"uint8 STATE_STOPPED = 0
uint8 STATE_PLAYING = 1
uint8 STATE_PAUSED = 2
uint8 STATE_QUITTING = 3
uint8 STATE_NO_WORLD = 4
uint8 STATE_LOADING_WORLD = 5
uint8 state
"##,
        };
    }

    /// `simulation_interfaces/msg/SimulatorFeatures`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SimulatorFeatures {
        /// `uint16[] features`
        pub r#features: Vec<u16>,
        /// `string[] spawn_formats`
        pub r#spawn_formats: Vec<String>,
        /// `string custom_info`
        pub r#custom_info: String,
    }

    impl SimulatorFeatures {
        /// `uint8 SPAWNING`
        pub const SPAWNING: u8 = 0;
        /// `uint8 DELETING`
        pub const DELETING: u8 = 1;
        /// `uint8 NAMED_POSES`
        pub const NAMED_POSES: u8 = 2;
        /// `uint8 POSE_BOUNDS`
        pub const POSE_BOUNDS: u8 = 3;
        /// `uint8 ENTITY_TAGS`
        pub const ENTITY_TAGS: u8 = 4;
        /// `uint8 ENTITY_BOUNDS`
        pub const ENTITY_BOUNDS: u8 = 5;
        /// `uint8 ENTITY_BOUNDS_BOX`
        pub const ENTITY_BOUNDS_BOX: u8 = 6;
        /// `uint8 ENTITY_BOUNDS_CONVEX`
        pub const ENTITY_BOUNDS_CONVEX: u8 = 7;
        /// `uint8 ENTITY_CATEGORIES`
        pub const ENTITY_CATEGORIES: u8 = 8;
        /// `uint8 SPAWNING_RESOURCE_STRING`
        pub const SPAWNING_RESOURCE_STRING: u8 = 9;
        /// `uint8 ENTITY_STATE_GETTING`
        pub const ENTITY_STATE_GETTING: u8 = 10;
        /// `uint8 ENTITY_STATE_SETTING`
        pub const ENTITY_STATE_SETTING: u8 = 11;
        /// `uint8 ENTITY_INFO_GETTING`
        pub const ENTITY_INFO_GETTING: u8 = 12;
        /// `uint8 ENTITY_INFO_SETTING`
        pub const ENTITY_INFO_SETTING: u8 = 13;
        /// `uint8 SPAWNABLES`
        pub const SPAWNABLES: u8 = 14;
        /// `uint8 SIMULATION_RESET`
        pub const SIMULATION_RESET: u8 = 20;
        /// `uint8 SIMULATION_RESET_TIME`
        pub const SIMULATION_RESET_TIME: u8 = 21;
        /// `uint8 SIMULATION_RESET_STATE`
        pub const SIMULATION_RESET_STATE: u8 = 22;
        /// `uint8 SIMULATION_RESET_SPAWNED`
        pub const SIMULATION_RESET_SPAWNED: u8 = 23;
        /// `uint8 SIMULATION_STATE_GETTING`
        pub const SIMULATION_STATE_GETTING: u8 = 24;
        /// `uint8 SIMULATION_STATE_SETTING`
        pub const SIMULATION_STATE_SETTING: u8 = 25;
        /// `uint8 SIMULATION_STATE_PAUSE`
        pub const SIMULATION_STATE_PAUSE: u8 = 26;
        /// `uint8 STEP_SIMULATION_SINGLE`
        pub const STEP_SIMULATION_SINGLE: u8 = 31;
        /// `uint8 STEP_SIMULATION_MULTIPLE`
        pub const STEP_SIMULATION_MULTIPLE: u8 = 32;
        /// `uint8 STEP_SIMULATION_ACTION`
        pub const STEP_SIMULATION_ACTION: u8 = 33;
        /// `uint8 WORLD_LOADING`
        pub const WORLD_LOADING: u8 = 40;
        /// `uint8 WORLD_RESOURCE_STRING`
        pub const WORLD_RESOURCE_STRING: u8 = 41;
        /// `uint8 WORLD_TAGS`
        pub const WORLD_TAGS: u8 = 42;
        /// `uint8 WORLD_UNLOADING`
        pub const WORLD_UNLOADING: u8 = 43;
        /// `uint8 WORLD_INFO_GETTING`
        pub const WORLD_INFO_GETTING: u8 = 44;
        /// `uint8 AVAILABLE_WORLDS`
        pub const AVAILABLE_WORLDS: u8 = 45;
        /// `uint8 SPAWNING_ENTITIES`
        pub const SPAWNING_ENTITIES: u8 = 50;
    }

    impl RosMessage for SimulatorFeatures {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/SimulatorFeatures",
            dds_name: "simulation_interfaces::msg::dds_::SimulatorFeatures_",
            type_hash: "RIHS01_8b101c8529bc0ea3dcf056078254768f39832b9ef0adaf93bd5cea96c0de3305",
            definition: r##"uint8 SPAWNING = 0
uint8 DELETING = 1
uint8 NAMED_POSES = 2
uint8 POSE_BOUNDS = 3
uint8 ENTITY_TAGS = 4
uint8 ENTITY_BOUNDS = 5
uint8 ENTITY_BOUNDS_BOX = 6
uint8 ENTITY_BOUNDS_CONVEX = 7
uint8 ENTITY_CATEGORIES = 8
uint8 SPAWNING_RESOURCE_STRING = 9
uint8 ENTITY_STATE_GETTING = 10
uint8 ENTITY_STATE_SETTING = 11
uint8 ENTITY_INFO_GETTING = 12
uint8 ENTITY_INFO_SETTING = 13
uint8 SPAWNABLES = 14
uint8 SIMULATION_RESET = 20
uint8 SIMULATION_RESET_TIME = 21
uint8 SIMULATION_RESET_STATE = 22
uint8 SIMULATION_RESET_SPAWNED = 23
uint8 SIMULATION_STATE_GETTING = 24
uint8 SIMULATION_STATE_SETTING = 25
uint8 SIMULATION_STATE_PAUSE = 26
uint8 STEP_SIMULATION_SINGLE = 31
uint8 STEP_SIMULATION_MULTIPLE = 32
uint8 STEP_SIMULATION_ACTION = 33
uint8 WORLD_LOADING = 40
uint8 WORLD_RESOURCE_STRING = 41
uint8 WORLD_TAGS = 42
uint8 WORLD_UNLOADING = 43
uint8 WORLD_INFO_GETTING = 44
uint8 AVAILABLE_WORLDS = 45
uint8 SPAWNING_ENTITIES = 50
uint16[] features
string[] spawn_formats
string custom_info
"##,
        };
    }

    /// `simulation_interfaces/msg/SpawnEntitiesRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SpawnEntitiesRequest {
        /// `simulation_interfaces/SpawnEntity[] spawn_requests`
        pub r#spawn_requests: Vec<SpawnEntity>,
    }

    /// `simulation_interfaces/msg/SpawnEntitiesResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SpawnEntitiesResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `simulation_interfaces/SpawnResult[] results`
        pub r#results: Vec<SpawnResult>,
    }

    impl SpawnEntitiesResponse {
        /// `uint8 ENTITIES_SPAWN_FAILED`
        pub const ENTITIES_SPAWN_FAILED: u8 = 150;
    }

    /// `simulation_interfaces/msg/SpawnEntity`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SpawnEntity {
        /// `string name`
        pub r#name: String,
        /// `bool allow_renaming`
        pub r#allow_renaming: bool,
        /// `simulation_interfaces/Resource entity_resource`
        pub r#entity_resource: Resource,
        /// `string entity_namespace`
        pub r#entity_namespace: String,
        /// `geometry_msgs/PoseStamped initial_pose`
        pub r#initial_pose: super::geometry_msgs::PoseStamped,
    }

    impl RosMessage for SpawnEntity {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/SpawnEntity",
            dds_name: "simulation_interfaces::msg::dds_::SpawnEntity_",
            type_hash: "RIHS01_94a349a865ccf673c18c080520299c88c3d8d5f4842ecf1482d6c997ac4b69f9",
            definition: r##"string name
bool allow_renaming
Resource entity_resource
string entity_namespace
geometry_msgs/PoseStamped initial_pose
================================================================================
MSG: simulation_interfaces/Resource
string uri
string resource_string
================================================================================
MSG: geometry_msgs/PoseStamped
std_msgs/Header header
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

    /// `simulation_interfaces/msg/SpawnEntityRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SpawnEntityRequest {
        /// `string name`
        pub r#name: String,
        /// `bool allow_renaming`
        pub r#allow_renaming: bool,
        /// `simulation_interfaces/Resource entity_resource`
        pub r#entity_resource: Resource,
        /// `string entity_namespace`
        pub r#entity_namespace: String,
        /// `geometry_msgs/PoseStamped initial_pose`
        pub r#initial_pose: super::geometry_msgs::PoseStamped,
    }

    /// `simulation_interfaces/msg/SpawnEntityResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SpawnEntityResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `string entity_name`
        pub r#entity_name: String,
    }

    impl SpawnEntityResponse {
        /// `uint8 NAME_NOT_UNIQUE`
        pub const NAME_NOT_UNIQUE: u8 = 101;
        /// `uint8 NAME_INVALID`
        pub const NAME_INVALID: u8 = 102;
        /// `uint8 UNSUPPORTED_FORMAT`
        pub const UNSUPPORTED_FORMAT: u8 = 103;
        /// `uint8 NO_RESOURCE`
        pub const NO_RESOURCE: u8 = 104;
        /// `uint8 NAMESPACE_INVALID`
        pub const NAMESPACE_INVALID: u8 = 105;
        /// `uint8 RESOURCE_PARSE_ERROR`
        pub const RESOURCE_PARSE_ERROR: u8 = 106;
        /// `uint8 MISSING_ASSETS`
        pub const MISSING_ASSETS: u8 = 107;
        /// `uint8 UNSUPPORTED_ASSETS`
        pub const UNSUPPORTED_ASSETS: u8 = 108;
        /// `uint8 INVALID_POSE`
        pub const INVALID_POSE: u8 = 109;
    }

    /// `simulation_interfaces/msg/SpawnResult`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SpawnResult {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
        /// `string entity_name`
        pub r#entity_name: String,
    }

    impl SpawnResult {
        /// `uint8 NAME_NOT_UNIQUE`
        pub const NAME_NOT_UNIQUE: u8 = 101;
        /// `uint8 NAME_INVALID`
        pub const NAME_INVALID: u8 = 102;
        /// `uint8 UNSUPPORTED_FORMAT`
        pub const UNSUPPORTED_FORMAT: u8 = 103;
        /// `uint8 NO_RESOURCE`
        pub const NO_RESOURCE: u8 = 104;
        /// `uint8 NAMESPACE_INVALID`
        pub const NAMESPACE_INVALID: u8 = 105;
        /// `uint8 RESOURCE_PARSE_ERROR`
        pub const RESOURCE_PARSE_ERROR: u8 = 106;
        /// `uint8 MISSING_ASSETS`
        pub const MISSING_ASSETS: u8 = 107;
        /// `uint8 UNSUPPORTED_ASSETS`
        pub const UNSUPPORTED_ASSETS: u8 = 108;
        /// `uint8 INVALID_POSE`
        pub const INVALID_POSE: u8 = 109;
    }

    impl RosMessage for SpawnResult {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/SpawnResult",
            dds_name: "simulation_interfaces::msg::dds_::SpawnResult_",
            type_hash: "RIHS01_dbc277304b6c24bfb2a631cea8f52e2b005d583ec0a6c86b11613f5ce6486da1",
            definition: r##"uint8 NAME_NOT_UNIQUE = 101
uint8 NAME_INVALID = 102
uint8 UNSUPPORTED_FORMAT = 103
uint8 NO_RESOURCE = 104
uint8 NAMESPACE_INVALID = 105
uint8 RESOURCE_PARSE_ERROR = 106
uint8 MISSING_ASSETS = 107
uint8 UNSUPPORTED_ASSETS = 108
uint8 INVALID_POSE = 109
Result result
string entity_name
================================================================================
MSG: simulation_interfaces/Result
uint8 RESULT_FEATURE_UNSUPPORTED = 0
uint8 RESULT_OK = 1
uint8 RESULT_NOT_FOUND = 2
uint8 RESULT_INCORRECT_STATE = 3
uint8 RESULT_OPERATION_FAILED = 4
uint8 result
string error_message
"##,
        };
    }

    /// `simulation_interfaces/msg/Spawnable`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Spawnable {
        /// `simulation_interfaces/Resource entity_resource`
        pub r#entity_resource: Resource,
        /// `string description`
        pub r#description: String,
        /// `simulation_interfaces/Bounds spawn_bounds`
        pub r#spawn_bounds: Bounds,
    }

    impl RosMessage for Spawnable {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/Spawnable",
            dds_name: "simulation_interfaces::msg::dds_::Spawnable_",
            type_hash: "RIHS01_8675aa686f0df1ed7874a6ec210fdce1ac1c07f4e49fc26ec7fb6fe729f6772e",
            definition: r##"Resource entity_resource
string description
Bounds spawn_bounds
================================================================================
MSG: simulation_interfaces/Resource
string uri
string resource_string
================================================================================
MSG: simulation_interfaces/Bounds
uint8 TYPE_EMPTY = 0
uint8 TYPE_BOX = 1
uint8 TYPE_CONVEX_HULL = 2
uint8 TYPE_SPHERE = 3
uint8 type
geometry_msgs/Vector3[] points
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"##,
        };
    }

    /// `simulation_interfaces/msg/StepSimulationRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct StepSimulationRequest {
        /// `uint64 steps`
        pub r#steps: u64,
    }

    /// `simulation_interfaces/msg/StepSimulationResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct StepSimulationResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    /// `simulation_interfaces/msg/TagsFilter`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct TagsFilter {
        /// `string[] tags`
        pub r#tags: Vec<String>,
        /// `uint8 filter_mode`
        pub r#filter_mode: u8,
    }

    impl TagsFilter {
        /// `uint8 FILTER_MODE_ANY`
        pub const FILTER_MODE_ANY: u8 = 0;
        /// `uint8 FILTER_MODE_ALL`
        pub const FILTER_MODE_ALL: u8 = 1;
    }

    impl RosMessage for TagsFilter {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/TagsFilter",
            dds_name: "simulation_interfaces::msg::dds_::TagsFilter_",
            type_hash: "RIHS01_5c3efc51e8ed04c266c09cb4691ec95b964cd410558e01d8c83646b038826b45",
            definition: r##"string[] tags
uint8 FILTER_MODE_ANY = 0
uint8 FILTER_MODE_ALL = 1
uint8 filter_mode
"##,
        };
    }

    /// `simulation_interfaces/msg/UnloadWorldRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct UnloadWorldRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `simulation_interfaces/msg/UnloadWorldResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct UnloadWorldResponse {
        /// `simulation_interfaces/Result result`
        pub r#result: Result,
    }

    impl UnloadWorldResponse {
        /// `uint8 NO_WORLD_LOADED`
        pub const NO_WORLD_LOADED: u8 = 101;
    }

    /// `simulation_interfaces/msg/WorldResource`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct WorldResource {
        /// `string name`
        pub r#name: String,
        /// `simulation_interfaces/Resource world_resource`
        pub r#world_resource: Resource,
        /// `string description`
        pub r#description: String,
        /// `string[] tags`
        pub r#tags: Vec<String>,
    }

    impl RosMessage for WorldResource {
        const TYPE: MessageType = MessageType {
            name: "simulation_interfaces/msg/WorldResource",
            dds_name: "simulation_interfaces::msg::dds_::WorldResource_",
            type_hash: "RIHS01_e3b65ecf904b9b115673e4a343c6aa3d28c19e185a71228faa64b783afcf2403",
            definition: r##"string name
Resource world_resource
string description
string[] tags
================================================================================
MSG: simulation_interfaces/Resource
string uri
string resource_string
"##,
        };
    }

    /// Services of `simulation_interfaces`.
    pub mod srv {
        use crate::wire::messages::{RosService, ServiceType};

        /// `simulation_interfaces/srv/DeleteEntity`.
        #[derive(Clone, Copy, Debug)]
        pub struct DeleteEntity;

        impl RosService for DeleteEntity {
            type Request = super::DeleteEntityRequest;
            type Response = super::DeleteEntityResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/DeleteEntity",
                request_dds_name: "simulation_interfaces::srv::dds_::DeleteEntity_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::DeleteEntity_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetAvailableWorlds`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetAvailableWorlds;

        impl RosService for GetAvailableWorlds {
            type Request = super::GetAvailableWorldsRequest;
            type Response = super::GetAvailableWorldsResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetAvailableWorlds",
                request_dds_name: "simulation_interfaces::srv::dds_::GetAvailableWorlds_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetAvailableWorlds_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetCurrentWorld`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetCurrentWorld;

        impl RosService for GetCurrentWorld {
            type Request = super::GetCurrentWorldRequest;
            type Response = super::GetCurrentWorldResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetCurrentWorld",
                request_dds_name: "simulation_interfaces::srv::dds_::GetCurrentWorld_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetCurrentWorld_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetEntities`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetEntities;

        impl RosService for GetEntities {
            type Request = super::GetEntitiesRequest;
            type Response = super::GetEntitiesResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetEntities",
                request_dds_name: "simulation_interfaces::srv::dds_::GetEntities_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetEntities_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetEntitiesStates`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetEntitiesStates;

        impl RosService for GetEntitiesStates {
            type Request = super::GetEntitiesStatesRequest;
            type Response = super::GetEntitiesStatesResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetEntitiesStates",
                request_dds_name: "simulation_interfaces::srv::dds_::GetEntitiesStates_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetEntitiesStates_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetEntityBounds`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetEntityBounds;

        impl RosService for GetEntityBounds {
            type Request = super::GetEntityBoundsRequest;
            type Response = super::GetEntityBoundsResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetEntityBounds",
                request_dds_name: "simulation_interfaces::srv::dds_::GetEntityBounds_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetEntityBounds_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetEntityInfo`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetEntityInfo;

        impl RosService for GetEntityInfo {
            type Request = super::GetEntityInfoRequest;
            type Response = super::GetEntityInfoResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetEntityInfo",
                request_dds_name: "simulation_interfaces::srv::dds_::GetEntityInfo_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetEntityInfo_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetEntityState`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetEntityState;

        impl RosService for GetEntityState {
            type Request = super::GetEntityStateRequest;
            type Response = super::GetEntityStateResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetEntityState",
                request_dds_name: "simulation_interfaces::srv::dds_::GetEntityState_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetEntityState_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetNamedPoseBounds`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetNamedPoseBounds;

        impl RosService for GetNamedPoseBounds {
            type Request = super::GetNamedPoseBoundsRequest;
            type Response = super::GetNamedPoseBoundsResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetNamedPoseBounds",
                request_dds_name: "simulation_interfaces::srv::dds_::GetNamedPoseBounds_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetNamedPoseBounds_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetNamedPoses`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetNamedPoses;

        impl RosService for GetNamedPoses {
            type Request = super::GetNamedPosesRequest;
            type Response = super::GetNamedPosesResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetNamedPoses",
                request_dds_name: "simulation_interfaces::srv::dds_::GetNamedPoses_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetNamedPoses_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetSimulationState`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetSimulationState;

        impl RosService for GetSimulationState {
            type Request = super::GetSimulationStateRequest;
            type Response = super::GetSimulationStateResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetSimulationState",
                request_dds_name: "simulation_interfaces::srv::dds_::GetSimulationState_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetSimulationState_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetSimulatorFeatures`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetSimulatorFeatures;

        impl RosService for GetSimulatorFeatures {
            type Request = super::GetSimulatorFeaturesRequest;
            type Response = super::GetSimulatorFeaturesResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetSimulatorFeatures",
                request_dds_name: "simulation_interfaces::srv::dds_::GetSimulatorFeatures_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetSimulatorFeatures_Response_",
            };
        }

        /// `simulation_interfaces/srv/GetSpawnables`.
        #[derive(Clone, Copy, Debug)]
        pub struct GetSpawnables;

        impl RosService for GetSpawnables {
            type Request = super::GetSpawnablesRequest;
            type Response = super::GetSpawnablesResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/GetSpawnables",
                request_dds_name: "simulation_interfaces::srv::dds_::GetSpawnables_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::GetSpawnables_Response_",
            };
        }

        /// `simulation_interfaces/srv/LoadWorld`.
        #[derive(Clone, Copy, Debug)]
        pub struct LoadWorld;

        impl RosService for LoadWorld {
            type Request = super::LoadWorldRequest;
            type Response = super::LoadWorldResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/LoadWorld",
                request_dds_name: "simulation_interfaces::srv::dds_::LoadWorld_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::LoadWorld_Response_",
            };
        }

        /// `simulation_interfaces/srv/ResetSimulation`.
        #[derive(Clone, Copy, Debug)]
        pub struct ResetSimulation;

        impl RosService for ResetSimulation {
            type Request = super::ResetSimulationRequest;
            type Response = super::ResetSimulationResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/ResetSimulation",
                request_dds_name: "simulation_interfaces::srv::dds_::ResetSimulation_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::ResetSimulation_Response_",
            };
        }

        /// `simulation_interfaces/srv/SetEntityInfo`.
        #[derive(Clone, Copy, Debug)]
        pub struct SetEntityInfo;

        impl RosService for SetEntityInfo {
            type Request = super::SetEntityInfoRequest;
            type Response = super::SetEntityInfoResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/SetEntityInfo",
                request_dds_name: "simulation_interfaces::srv::dds_::SetEntityInfo_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::SetEntityInfo_Response_",
            };
        }

        /// `simulation_interfaces/srv/SetEntityState`.
        #[derive(Clone, Copy, Debug)]
        pub struct SetEntityState;

        impl RosService for SetEntityState {
            type Request = super::SetEntityStateRequest;
            type Response = super::SetEntityStateResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/SetEntityState",
                request_dds_name: "simulation_interfaces::srv::dds_::SetEntityState_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::SetEntityState_Response_",
            };
        }

        /// `simulation_interfaces/srv/SetSimulationState`.
        #[derive(Clone, Copy, Debug)]
        pub struct SetSimulationState;

        impl RosService for SetSimulationState {
            type Request = super::SetSimulationStateRequest;
            type Response = super::SetSimulationStateResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/SetSimulationState",
                request_dds_name: "simulation_interfaces::srv::dds_::SetSimulationState_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::SetSimulationState_Response_",
            };
        }

        /// `simulation_interfaces/srv/SpawnEntities`.
        #[derive(Clone, Copy, Debug)]
        pub struct SpawnEntities;

        impl RosService for SpawnEntities {
            type Request = super::SpawnEntitiesRequest;
            type Response = super::SpawnEntitiesResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/SpawnEntities",
                request_dds_name: "simulation_interfaces::srv::dds_::SpawnEntities_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::SpawnEntities_Response_",
            };
        }

        /// `simulation_interfaces/srv/SpawnEntity`.
        #[derive(Clone, Copy, Debug)]
        pub struct SpawnEntity;

        impl RosService for SpawnEntity {
            type Request = super::SpawnEntityRequest;
            type Response = super::SpawnEntityResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/SpawnEntity",
                request_dds_name: "simulation_interfaces::srv::dds_::SpawnEntity_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::SpawnEntity_Response_",
            };
        }

        /// `simulation_interfaces/srv/StepSimulation`.
        #[derive(Clone, Copy, Debug)]
        pub struct StepSimulation;

        impl RosService for StepSimulation {
            type Request = super::StepSimulationRequest;
            type Response = super::StepSimulationResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/StepSimulation",
                request_dds_name: "simulation_interfaces::srv::dds_::StepSimulation_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::StepSimulation_Response_",
            };
        }

        /// `simulation_interfaces/srv/UnloadWorld`.
        #[derive(Clone, Copy, Debug)]
        pub struct UnloadWorld;

        impl RosService for UnloadWorld {
            type Request = super::UnloadWorldRequest;
            type Response = super::UnloadWorldResponse;
            const TYPE: ServiceType = ServiceType {
                name: "simulation_interfaces/srv/UnloadWorld",
                request_dds_name: "simulation_interfaces::srv::dds_::UnloadWorld_Request_",
                response_dds_name: "simulation_interfaces::srv::dds_::UnloadWorld_Response_",
            };
        }
    }

    /// Actions of `simulation_interfaces`.
    pub mod action {
        use crate::wire::messages::{ActionType, RosAction, ServiceType};

        /// `simulation_interfaces/action/SimulateSteps`.
        #[derive(Clone, Copy, Debug)]
        pub struct SimulateSteps;

        impl RosAction for SimulateSteps {
            type Goal = super::SimulateStepsGoal;
            type Result = super::SimulateStepsResult;
            type Feedback = super::SimulateStepsFeedback;
            const TYPE: ActionType = ActionType {
                name: "simulation_interfaces/action/SimulateSteps",
                send_goal: ServiceType {
                    name: "simulation_interfaces/action/SimulateSteps_SendGoal",
                    request_dds_name: "simulation_interfaces::action::dds_::SimulateSteps_SendGoal_Request_",
                    response_dds_name: "simulation_interfaces::action::dds_::SimulateSteps_SendGoal_Response_",
                },
                get_result: ServiceType {
                    name: "simulation_interfaces/action/SimulateSteps_GetResult",
                    request_dds_name: "simulation_interfaces::action::dds_::SimulateSteps_GetResult_Request_",
                    response_dds_name: "simulation_interfaces::action::dds_::SimulateSteps_GetResult_Response_",
                },
                feedback_dds_name: "simulation_interfaces::action::dds_::SimulateSteps_FeedbackMessage_",
            };
        }
    }
}

/// Messages of `std_msgs`.
pub mod std_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `std_msgs/msg/Bool`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Bool {
        /// `bool data`
        pub r#data: bool,
    }

    impl RosMessage for Bool {
        const TYPE: MessageType = MessageType {
            name: "std_msgs/msg/Bool",
            dds_name: "std_msgs::msg::dds_::Bool_",
            type_hash: "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9",
            definition: r##"bool data
"##,
        };
    }

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

/// Messages of `std_srvs`.
pub mod std_srvs {

    /// `std_srvs/msg/SetBoolRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetBoolRequest {
        /// `bool data`
        pub r#data: bool,
    }

    /// `std_srvs/msg/SetBoolResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct SetBoolResponse {
        /// `bool success`
        pub r#success: bool,
        /// `string message`
        pub r#message: String,
    }

    /// `std_srvs/msg/TriggerRequest`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct TriggerRequest {
        /// `uint8 structure_needs_at_least_one_member`
        pub r#structure_needs_at_least_one_member: u8,
    }

    /// `std_srvs/msg/TriggerResponse`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct TriggerResponse {
        /// `bool success`
        pub r#success: bool,
        /// `string message`
        pub r#message: String,
    }

    /// Services of `std_srvs`.
    pub mod srv {
        use crate::wire::messages::{RosService, ServiceType};

        /// `std_srvs/srv/SetBool`.
        #[derive(Clone, Copy, Debug)]
        pub struct SetBool;

        impl RosService for SetBool {
            type Request = super::SetBoolRequest;
            type Response = super::SetBoolResponse;
            const TYPE: ServiceType = ServiceType {
                name: "std_srvs/srv/SetBool",
                request_dds_name: "std_srvs::srv::dds_::SetBool_Request_",
                response_dds_name: "std_srvs::srv::dds_::SetBool_Response_",
            };
        }

        /// `std_srvs/srv/Trigger`.
        #[derive(Clone, Copy, Debug)]
        pub struct Trigger;

        impl RosService for Trigger {
            type Request = super::TriggerRequest;
            type Response = super::TriggerResponse;
            const TYPE: ServiceType = ServiceType {
                name: "std_srvs/srv/Trigger",
                request_dds_name: "std_srvs::srv::dds_::Trigger_Request_",
                response_dds_name: "std_srvs::srv::dds_::Trigger_Response_",
            };
        }
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

/// Messages of `unique_identifier_msgs`.
pub mod unique_identifier_msgs {
    use crate::wire::messages::{MessageType, RosMessage};

    /// `unique_identifier_msgs/msg/UUID`.
    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct UUID {
        /// `uint8[16] uuid`
        pub r#uuid: [u8; 16],
    }

    impl RosMessage for UUID {
        const TYPE: MessageType = MessageType {
            name: "unique_identifier_msgs/msg/UUID",
            dds_name: "unique_identifier_msgs::msg::dds_::UUID_",
            type_hash: "RIHS01_1b8e8aca958cbea28fe6ef60bf6c19b683c97a9ef60bb34752067d0f2f7ab437",
            definition: r##"uint8[16] uuid
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
