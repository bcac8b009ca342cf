"""The ROS 2 messages that peers read and write, as IDL for an independent DDS implementation.

Written from the public definitions of the messages, not generated from this project: a mistake in
the project's own types shows here.
"""

from dataclasses import dataclass, field

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import array, float64, int8, int32, sequence, uint8, uint32


def ros(package: str, name: str) -> str:
    """The name that ROS 2 gives a message type on DDS."""
    return f"{package}::msg::dds_::{name}_"


@dataclass
@final
class Time(IdlStruct, typename=ros("builtin_interfaces", "Time")):
    sec: int32 = 0
    nanosec: uint32 = 0

    def seconds(self) -> float:
        return self.sec + 1e-9 * self.nanosec


@dataclass
@final
class Header(IdlStruct, typename=ros("std_msgs", "Header")):
    stamp: Time = field(default_factory=Time)
    frame_id: str = ""


@dataclass
@final
class Clock(IdlStruct, typename=ros("rosgraph_msgs", "Clock")):
    clock: Time = field(default_factory=Time)


@dataclass
@final
class Float64(IdlStruct, typename=ros("std_msgs", "Float64")):
    data: float64 = 0.0


@dataclass
@final
class Vector3(IdlStruct, typename=ros("geometry_msgs", "Vector3")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
@final
class Point(IdlStruct, typename=ros("geometry_msgs", "Point")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
@final
class Quaternion(IdlStruct, typename=ros("geometry_msgs", "Quaternion")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


@dataclass
@final
class Pose(IdlStruct, typename=ros("geometry_msgs", "Pose")):
    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


@dataclass
@final
class PoseStamped(IdlStruct, typename=ros("geometry_msgs", "PoseStamped")):
    header: Header = field(default_factory=Header)
    pose: Pose = field(default_factory=Pose)


@dataclass
@final
class Wrench(IdlStruct, typename=ros("geometry_msgs", "Wrench")):
    force: Vector3 = field(default_factory=Vector3)
    torque: Vector3 = field(default_factory=Vector3)


@dataclass
@final
class WrenchStamped(IdlStruct, typename=ros("geometry_msgs", "WrenchStamped")):
    header: Header = field(default_factory=Header)
    wrench: Wrench = field(default_factory=Wrench)


@dataclass
@final
class JointState(IdlStruct, typename=ros("sensor_msgs", "JointState")):
    header: Header = field(default_factory=Header)
    name: sequence[str] = field(default_factory=list)
    position: sequence[float64] = field(default_factory=list)
    velocity: sequence[float64] = field(default_factory=list)
    effort: sequence[float64] = field(default_factory=list)


@dataclass
@final
class PointField(IdlStruct, typename=ros("sensor_msgs", "PointField")):
    name: str = ""
    offset: uint32 = 0
    datatype: uint8 = 0
    count: uint32 = 0


@dataclass
@final
class PointCloud2(IdlStruct, typename=ros("sensor_msgs", "PointCloud2")):
    header: Header = field(default_factory=Header)
    height: uint32 = 0
    width: uint32 = 0
    fields: sequence[PointField] = field(default_factory=list)
    is_bigendian: bool = False
    point_step: uint32 = 0
    row_step: uint32 = 0
    data: sequence[uint8] = field(default_factory=list)
    is_dense: bool = True


@dataclass
@final
class ObjectDetectionStatus(IdlStruct, typename=ros("jamgrip_msgs", "ObjectDetectionStatus")):
    status: int8 = 0


@dataclass
@final
class VacuumState(IdlStruct, typename=ros("jamgrip_msgs", "VacuumState")):
    header: Header = field(default_factory=Header)
    gauge: float64 = 0.0
    gauge_setpoint: float64 = 0.0
    volume: float64 = 0.0
    jammed_fraction: float64 = 0.0
    coordination_number: float64 = 0.0
    solid_fraction: float64 = 0.0
    sliding_fraction: float64 = 0.0
    object_detection: ObjectDetectionStatus = field(default_factory=ObjectDetectionStatus)


@dataclass
@final
class Gid(IdlStruct, typename=ros("rmw_dds_common", "Gid")):
    data: array[uint8, 16]


@dataclass
@final
class NodeEntitiesInfo(IdlStruct, typename=ros("rmw_dds_common", "NodeEntitiesInfo")):
    node_namespace: str
    node_name: str
    reader_gid_seq: sequence[Gid]
    writer_gid_seq: sequence[Gid]


@dataclass
@final
class ParticipantEntitiesInfo(IdlStruct, typename=ros("rmw_dds_common", "ParticipantEntitiesInfo")):
    gid: Gid
    node_entities_info_seq: sequence[NodeEntitiesInfo]
