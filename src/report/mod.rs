//! Pages and plots, whatever they show.

pub mod axis; // ticks of a plot
pub mod format; // numbers and durations as text
pub mod page; // the frame of an HTML page
pub mod plot; // plots as SVG
