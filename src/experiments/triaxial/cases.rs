//! The cases: specimens that are sheared, and comparisons of run times.

use super::scene::TriaxialScene;

/// Suffix of the name of the case that checks what the accelerations change.
pub(super) const CHECK: &str = "_check";
/// Suffix of the name of the specimen with spheres that is filled less densely.
pub(super) const LOOSE: &str = "_loose";

/// The membrane model: what grains touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Triangles, the wall model.
    Triangles,
    /// Spheres around the vertices, the particle model.
    Spheres,
}

impl Kind {
    /// Name in cases and phases.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Spheres => "spheres",
        }
    }
}

/// Selects a specimen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    /// Index of the size: 0 or 1 for the source's case 1 or 2.
    pub(super) size: usize,
    /// The membrane model.
    pub(super) kind: Kind,
    /// Index of the initial state: 0 or 1 for A or B.
    pub(super) initial: usize,
}

/// A case.
#[derive(Clone, Copy)]
pub(super) enum Case {
    /// A specimen that is sheared.
    Sheared { choice: Choice, variant: Variant },
    /// Both membrane models side by side, with the specimen of this size.
    Timed { size: usize },
}

/// What differs from the scene.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Variant {
    /// Nothing.
    Plain,
    /// Half the speed, and a substep that is safe without further arguments.
    Check,
    /// So few grains that the room inside the spheres is as dense as that of the other model.
    Loose,
}

/// All cases with their names.
pub(super) fn cases(scene: &TriaxialScene) -> Vec<(String, Case)> {
    let mut cases = Vec::new();
    let runs = &scene.runs;
    let n_sizes = if runs.case2 { 2 } else { 1 };
    for size in 0..n_sizes {
        for kind in [Kind::Triangles, Kind::Spheres] {
            for initial in 0..2 {
                let choice = Choice { size, kind, initial };
                cases.push((name(choice), Case::Sheared { choice, variant: Variant::Plain }));
            }
        }
    }
    if runs.check_strain > 0.0 {
        let choice = Choice { size: 0, kind: Kind::Triangles, initial: 0 };
        let check = Case::Sheared { choice, variant: Variant::Check };
        cases.push((name(choice) + CHECK, check));
    }
    if runs.loose_strain > 0.0 {
        let choice = Choice { size: 0, kind: Kind::Spheres, initial: 0 };
        let loose = Case::Sheared { choice, variant: Variant::Loose };
        cases.push((name(choice) + LOOSE, loose));
    }
    if runs.timing > 0.0 {
        for size in 0..n_sizes {
            cases.push((timing_name(size), Case::Timed { size }));
        }
    }
    cases
}

/// Name of a specimen, `case1_triangles_A`.
pub(super) fn name(choice: Choice) -> String {
    let initial = ["A", "B"][choice.initial];
    format!("case{}_{}_{initial}", choice.size + 1, choice.kind.name())
}

/// Name of the comparison of run times.
pub(super) fn timing_name(size: usize) -> String {
    format!("case{}_timing", size + 1)
}
