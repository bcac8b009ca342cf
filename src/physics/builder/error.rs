//! Errors of the system builder.

use crate::{
    base::Real,
    physics::{boundary::motion::MotionError, membrane::mesh::MeshError},
};

/// Why parts do not form a system: place, value, limit and remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// A number that is not finite.
    #[error("{place}: {value} is not finite; give a finite number")]
    NotFinite {
        /// What it is.
        place: String,
        /// Its value.
        value: Real,
    },
    /// A number that must be positive.
    #[error("{place}: {value:e} is not positive; give a value above 0")]
    NotPositive {
        /// What it is, with its unit.
        place: String,
        /// Its value.
        value: Real,
    },
    /// Lists that must have the same length.
    #[error("{place}: {found} values instead of {expected}; give one for each")]
    Count {
        /// The list.
        place: &'static str,
        /// Its length.
        found: usize,
        /// The required length.
        expected: usize,
    },
    /// Neither a substep nor the material that determines it.
    #[error(
        "substep: not set; call `substep`, or use `of_material` and call `substep_of_critical`"
    )]
    NoSubstep,
    /// A grain larger than the largest radius that was set.
    #[error(
        "grain {grain}: radius {radius:e} m exceeds the limit of {limit:e} m; set the largest \
         radius with `radii_up_to`"
    )]
    Radius {
        /// The grain.
        grain: usize,
        /// Its radius (m).
        radius: Real,
        /// The largest radius (m).
        limit: Real,
    },
    /// A periodic box in which a grain could touch two images of another.
    #[error(
        "period: edge {axis} is {edge:e} m; it must be at least {limit:e} m, twice the reach of the \
         largest grain"
    )]
    Period {
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// Length of the edge (m).
        edge: Real,
        /// The smallest valid length (m).
        limit: Real,
    },
    /// A periodic box that does not contain only grains.
    #[error(
        "period: {n_walls} walls and {n_membranes} membranes; a periodic box may contain only grains"
    )]
    NotAlone {
        /// Number of walls, and of bodies that grains touch.
        n_walls: usize,
        /// Number of membranes.
        n_membranes: usize,
    },
    /// A frame that does not hold any vertex.
    #[error(
        "wall {wall}: a frame that holds no vertex of a membrane has no effect; remove it or let it hold \
         something"
    )]
    IdleWall {
        /// The wall.
        wall: usize,
    },
    /// A hollow wall that is too narrow for the grains.
    #[error(
        "wall {wall}: radius {radius:e} m is too small for grains of {limit:e} m; use a wider wall or \
         smaller grains"
    )]
    NarrowWall {
        /// The wall.
        wall: usize,
        /// Its radius (m).
        radius: Real,
        /// Radius of the largest grain (m).
        limit: Real,
    },
    /// A normal that is not a unit vector.
    #[error("wall {wall}: its normal has length {length}; it must be 1")]
    Normal {
        /// The wall.
        wall: usize,
        /// Length of its normal.
        length: Real,
    },
    /// An invalid motion.
    #[error("wall {wall}: {error}")]
    Motion {
        /// The wall.
        wall: usize,
        /// The invalid parameter.
        error: MotionError,
    },
    /// An invalid mesh.
    #[error("membrane {membrane}: {error}")]
    Mesh {
        /// The membrane.
        membrane: usize,
        /// What is wrong.
        error: MeshError,
    },
    /// A rim that no wall holds.
    #[error(
        "membrane {membrane}: vertex {vertex} of its rim is not held by a wall; call `hold`, or \
         `free_rims` if it is free"
    )]
    FreeRim {
        /// The membrane.
        membrane: usize,
        /// A vertex of the rim.
        vertex: usize,
    },
    /// Vertices or rims that a membrane does not have.
    #[error("membrane {membrane}: {what} {index} cannot be held, because there are only {limit}")]
    NoSuchVertices {
        /// The membrane.
        membrane: usize,
        /// `vertex` or `rim`.
        what: &'static str,
        /// The invalid index.
        index: usize,
        /// How many there are.
        limit: usize,
    },
    /// A holder that does not exist.
    #[error(
        "membrane {membrane}: wall {wall} cannot hold it, because there are only {n_walls} walls; add the \
         wall first"
    )]
    NoSuchWall {
        /// The membrane.
        membrane: usize,
        /// The wall.
        wall: usize,
        /// Number of walls.
        n_walls: usize,
    },
    /// Membranes that cannot share a system.
    #[error(
        "membrane {membrane}: {what} differs from the first membrane; it must be the same for all \
         membranes of a system"
    )]
    MembranesDiffer {
        /// The membrane.
        membrane: usize,
        /// What differs.
        what: &'static str,
    },
}
