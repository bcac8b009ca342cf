//! HTML pages and SVG plots, independent of their contents.

pub mod axis; // the axes of a plot
pub mod format; // numbers and durations as text
pub mod page; // the frame of an HTML page
pub mod plot; // plots as SVG
