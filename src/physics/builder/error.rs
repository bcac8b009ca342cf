//! Why parts do not make a system.

use crate::{
    base::Real,
    physics::{boundary::motion::BadMotion, membrane::mesh::MeshFault},
};

/// Why parts do not make a system: where, what value, which limit, and what to do.
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
    /// Lists of one length that have several.
    #[error("{place}: {found} values for {expected}; give one for each")]
    Count {
        /// What they are.
        place: &'static str,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// Neither a substep nor what it follows from.
    #[error(
        "substep: none is given; call `substep`, or name the grains' material and call \
         `substep_of_critical`"
    )]
    NoSubstep,
    /// A grain larger than the radius that was announced.
    #[error(
        "grain {grain}: radius {radius:e} m exceeds the largest of {limit:e} m; announce the \
         largest radius with `radii_up_to`"
    )]
    Radius {
        /// The grain.
        grain: usize,
        /// Its radius (m).
        radius: Real,
        /// The largest radius (m).
        limit: Real,
    },
    /// A periodic box in which a grain could meet two images of another.
    #[error(
        "period: edge {axis} is {edge:e} m; it must be at least {limit:e} m, twice the reach of the \
         largest grain"
    )]
    Period {
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// Length of the edge (m).
        edge: Real,
        /// The least length (m).
        limit: Real,
    },
    /// A periodic box with something else in it than grains.
    #[error(
        "period: {n_walls} walls and {n_membranes} membranes; a periodic box holds grains alone"
    )]
    NotAlone {
        /// Number of walls, and of bodies that grains touch.
        n_walls: usize,
        /// Number of membranes.
        n_membranes: usize,
    },
    /// A wall that touches no grain and holds no vertex.
    #[error(
        "wall {wall}: no grain can touch a frame and it holds no vertex of a membrane; leave it out \
         or let it hold something"
    )]
    IdleWall {
        /// The wall.
        wall: usize,
    },
    /// A hollow wall in which the grains do not fit.
    #[error(
        "wall {wall}: radius {radius:e} m leaves no place for a grain of {limit:e} m; take a wider \
         wall or smaller grains"
    )]
    NarrowWall {
        /// The wall.
        wall: usize,
        /// Its radius (m).
        radius: Real,
        /// Radius of the largest grain (m).
        limit: Real,
    },
    /// A normal that is no direction.
    #[error("wall {wall}: its normal has length {length}; it must be 1")]
    Normal {
        /// The wall.
        wall: usize,
        /// Length of its normal.
        length: Real,
    },
    /// A motion that cannot be carried out.
    #[error("wall {wall}: {error}")]
    Motion {
        /// The wall.
        wall: usize,
        /// The parameter.
        error: BadMotion,
    },
    /// A mesh that is no surface.
    #[error("membrane {membrane}: {error}")]
    Mesh {
        /// The membrane.
        membrane: usize,
        /// What is wrong.
        error: MeshFault,
    },
    /// A rim that no wall holds.
    #[error(
        "membrane {membrane}: vertex {vertex} of its rim is held by no wall; call `hold`, or \
         `free_rims` if it shall hang free"
    )]
    FreeRim {
        /// The membrane.
        membrane: usize,
        /// A vertex of the rim.
        vertex: usize,
    },
    /// Vertices that a membrane does not have.
    #[error("membrane {membrane}: {what} {index} is to be held, but it has only {limit}")]
    NoSuchVertices {
        /// The membrane.
        membrane: usize,
        /// `vertex` or `rim`.
        what: &'static str,
        /// The index given.
        index: usize,
        /// How many there are.
        limit: usize,
    },
    /// A holder that does not exist.
    #[error(
        "membrane {membrane}: wall {wall} shall hold it, but there are only {n_walls}; add the wall \
         first"
    )]
    NoSuchWall {
        /// The membrane.
        membrane: usize,
        /// The wall.
        wall: usize,
        /// How many walls there are.
        n_walls: usize,
    },
    /// Membranes that cannot share a system.
    #[error(
        "membrane {membrane}: {what} differs from that of the first membrane; it is the same for all \
         membranes of a system"
    )]
    MembranesDiffer {
        /// The membrane.
        membrane: usize,
        /// What differs.
        what: &'static str,
    },
}
