//! The list of cases.

use super::{
    packing::{Boxed, Phase},
    prepare::{ExperimentMoment, Moment},
    repetitions::Work,
    sanity::Limits,
};

/// One case.
#[derive(Debug)]
pub struct Case {
    /// Name on the command line.
    pub name: &'static str,
    /// One-line description.
    pub about: &'static str,
    /// Work of a repetition.
    pub(super) work: Work,
    /// Limits of its state.
    pub(super) limits: Limits,
    /// How its start state is prepared.
    pub(super) kind: Kind,
}

/// How the start state of a case is prepared.
#[derive(Debug)]
pub(super) enum Kind {
    /// A box of grains.
    Grains(Boxed),
    /// The beam under vacuum.
    Beam,
    /// An experiment at some moment.
    Experiment(ExperimentMoment),
    /// A complete pick-and-lift session.
    Lift,
    /// The loop in real time.
    #[cfg(all(feature = "ros", feature = "shm"))]
    Latency,
}

/// Grains at rest in a closed box under pressure, or sliding down in an opened, tilted one.
const fn grains(
    name: &'static str,
    about: &'static str,
    phase: Phase,
    (n_grains, n_tiles): (usize, [usize; 3]),
    (n_warm, n_steps): (u64, u64),
) -> Case {
    let limits = match phase {
        Phase::Rest => Limits::PACKED_AT_REST,
        Phase::Flow => Limits::FLOWING,
    };
    let work = Work { n_warm, n_steps };
    Case { name, about, work, limits, kind: Kind::Grains(Boxed { n_grains, n_tiles, phase }) }
}

const ONE: [usize; 3] = [1, 1, 1];

const fn gripper(
    name: &'static str,
    about: &'static str,
    case: &'static str,
    moment: Moment,
    limits: Limits,
) -> Case {
    let spot = ExperimentMoment { experiment: "gripper", case, overrides: GRIPPER, moment };
    let work = Work { n_warm: 200, n_steps: 1000 };
    Case { name, about, work, limits, kind: Kind::Experiment(spot) }
}

/// The gripper of Götz (2024) with three of its moduli, and the first filling of each. Insertion is
/// fast: the final positions of the grains do not matter here.
const GRIPPER: &[&str] = &[
    "grains.youngs_modulus=100 MPa",
    "sweep.moduli=[5 MPa, 100 MPa, 10 GPa]",
    "sweep.fillings=1",
    "accelerations.insert_speed_factor=20",
    "protocol.relax_time=10 ms",
];
const SOFT: &str = "modulus_5MPa_filling_0";
const FIRM: &str = "modulus_100MPa_filling_0";
const HARD: &str = "modulus_10GPa_filling_0";

const fn triaxial(name: &'static str, about: &'static str, case: &'static str) -> Case {
    let spot = ExperimentMoment {
        experiment: "triaxial",
        case,
        overrides: &["runs.case2=true", "time.rayleigh_share=0.4"],
        moment: Moment::Shearing,
    };
    let work = Work { n_warm: 100, n_steps: 500 };
    Case { name, about, work, limits: Limits::CONFINED, kind: Kind::Experiment(spot) }
}

/// All cases.
pub static CASES: &[Case] = &[
    grains("grains_3k_rest", "3 000 grains in a closed box", Phase::Rest, (3000, ONE), (200, 1000)),
    grains(
        "grains_3k_flow",
        "3 000 grains in an opened, tilted box",
        Phase::Flow,
        (3000, ONE),
        (200, 1000),
    ),
    grains(
        "grains_30k_rest",
        "30 000 grains in a closed box",
        Phase::Rest,
        (30_000, ONE),
        (30, 200),
    ),
    grains(
        "grains_30k_flow",
        "30 000 grains in an opened, tilted box",
        Phase::Flow,
        (30_000, ONE),
        (50, 400),
    ),
    grains("grains_300k_rest", "8 x 37 500 grains", Phase::Rest, (37_500, [2, 2, 2]), (5, 30)),
    grains(
        "grains_300k_flow",
        "8 x 37 500 grains, opened and tilted",
        Phase::Flow,
        (37_500, [2, 2, 2]),
        (20, 100),
    ),
    grains("grains_1m_rest", "27 x 37 500 grains", Phase::Rest, (37_500, [3, 3, 3]), (3, 10)),
    gripper(
        "gripper_5mpa_free",
        "4200 grains of 5 MPa, gripper vented",
        SOFT,
        Moment::Free,
        Limits::VENTED,
    ),
    gripper(
        "gripper_5mpa_jamming",
        "the same, half evacuated around a sphere",
        SOFT,
        Moment::Jamming,
        Limits::GRIPPING_SOFT,
    ),
    gripper(
        "gripper_5mpa_holding",
        "the same, at full vacuum",
        SOFT,
        Moment::Holding,
        Limits::GRIPPING_SOFT,
    ),
    gripper(
        "gripper_100mpa_free",
        "4200 grains of 100 MPa, gripper vented",
        FIRM,
        Moment::Free,
        Limits::VENTED,
    ),
    gripper(
        "gripper_100mpa_jamming",
        "the same, half evacuated around a sphere",
        FIRM,
        Moment::Jamming,
        Limits::GRIPPING,
    ),
    gripper(
        "gripper_100mpa_holding",
        "the same, at full vacuum",
        FIRM,
        Moment::Holding,
        Limits::GRIPPING,
    ),
    gripper(
        "gripper_10gpa_free",
        "4200 grains of 10 GPa, gripper vented",
        HARD,
        Moment::Free,
        Limits::VENTED,
    ),
    gripper(
        "gripper_10gpa_jamming",
        "the same, half evacuated around a sphere",
        HARD,
        Moment::Jamming,
        Limits::GRIPPING,
    ),
    gripper(
        "gripper_10gpa_holding",
        "the same, at full vacuum",
        HARD,
        Moment::Holding,
        Limits::GRIPPING,
    ),
    triaxial("triaxial_case1", "1716 grains, 1131 vertices, shearing", "case1_triangles_A"),
    triaxial("triaxial_case2", "4645 grains, 2214 vertices, shearing", "case2_triangles_A"),
    Case {
        name: "beam",
        about: "18 500 grains in a closed bar of 1792 vertices, under vacuum",
        work: Work { n_warm: 20, n_steps: 100 },
        limits: Limits::CLOSED,
        kind: Kind::Beam,
    },
    Case {
        name: "pick_and_lift",
        about: "the default scene from the first tick to the last, without ROS 2 and recordings",
        work: Work { n_warm: 0, n_steps: 0 },
        limits: Limits::LIFTED,
        kind: Kind::Lift,
    },
    #[cfg(all(feature = "ros", feature = "shm"))]
    Case {
        name: "latency",
        about: "commands and samples through ROS 2 and shared memory at 1 kHz beside a busy solver",
        work: Work { n_warm: 0, n_steps: 0 },
        limits: Limits::VENTED,
        kind: Kind::Latency,
    },
];
