//! The air inside the membrane: pressure, vacuum state, and object detection.

use super::{MEMBRANE, parts};
use crate::{
    snapshot::Snapshot,
    wire::messages::{
        jamgrip_msgs::{ObjectDetectionStatus, VacuumState},
        sensor_msgs::FluidPressure,
    },
};

/// Fraction of the commanded vacuum that can hold an object.
const HOLDING_FRACTION: f64 = 1.0 / 6.0;
/// Fraction of the commanded vacuum that counts as reached.
const REACHED_FRACTION: f64 = 0.95;

/// Absolute pressure.
pub(super) fn pressure(snapshot: &Snapshot) -> FluidPressure {
    FluidPressure {
        header: parts::header(snapshot.time_ns, MEMBRANE),
        fluid_pressure: snapshot.chamber.ambient + snapshot.chamber.gauge,
        variance: 0.0,
    }
}

/// Pressure, volume, jamming.
pub(super) fn vacuum_state(snapshot: &Snapshot) -> VacuumState {
    let (air, jamming) = (&snapshot.chamber, &snapshot.jamming);
    VacuumState {
        header: parts::header(snapshot.time_ns, MEMBRANE),
        gauge: air.gauge,
        gauge_setpoint: air.gauge_setpoint,
        volume: air.volume,
        jammed_fraction: jamming.jammed_fraction,
        coordination_number: jamming.coordination_number,
        solid_fraction: jamming.solid_fraction,
        sliding_fraction: jamming.sliding_fraction,
        object_detection: object_detection(snapshot),
    }
}

/// Derived from contact and pressure, as defined in the .msg file.
pub(super) fn object_detection(snapshot: &Snapshot) -> ObjectDetectionStatus {
    let air = &snapshot.chamber;
    let status = if snapshot.jamming.n_object_contacts == 0 {
        ObjectDetectionStatus::NO_OBJECT_DETECTED
    } else if 0.0 <= air.gauge_setpoint {
        ObjectDetectionStatus::UNKNOWN
    } else if air.gauge <= REACHED_FRACTION * air.gauge_setpoint {
        ObjectDetectionStatus::OBJECT_DETECTED_AT_MAX_PRESSURE
    } else if air.gauge <= HOLDING_FRACTION * air.gauge_setpoint {
        ObjectDetectionStatus::OBJECT_DETECTED_AT_MIN_PRESSURE
    } else {
        ObjectDetectionStatus::UNKNOWN
    };
    ObjectDetectionStatus { status }
}
