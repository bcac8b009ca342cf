//! Grains, membrane and chamber: pure, repeatable, without any input or output.
//!
//! `Model` is what the system is made of, `State` is what must be known to go on, `Controls` is
//! what the outside wants during a substep, `Scratch` is what can be recomputed. A fifth noun,
//! `Snapshot`, is what others may see. `substep` advances the state; it reads as a list of stages,
//! and the stages live in the files of their names.

pub mod boundary; // what grains and membrane meet besides each other
pub mod chamber; // the air inside
pub mod contact; // who touches, and how hard
pub mod controls;
pub mod critical_step; // how long a substep may be
pub mod fill; // grains into the bag
pub mod health; // can the run go on?
pub mod integrate;
pub mod law; // contact laws
pub mod membrane; // the flexible bag
pub mod model;
pub mod neighbours; // who may touch whom
pub mod packing; // grains made dense
pub mod scratch;
pub mod state;
pub mod substep;
pub mod system;
pub mod builder; // any system from its parts

pub use builder::SystemBuilder;
pub use controls::Controls;
pub use model::Model;
pub use scratch::Scratch;
pub use state::State;
pub use substep::substep;
pub use system::System;
