//! What the records of the triaxial tests show.

use super::setup::Setup;
use crate::experiments::{findings::Findings, record::Record};

/// All rows, curves and plots.
pub(super) fn findings(_setup: &Setup, _records: &[Record]) -> Findings {
    Findings::default()
}
