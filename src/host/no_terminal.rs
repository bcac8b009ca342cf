//! Stand-ins for the types of indicatif without feature `cli`: nothing is drawn.

/// A progress bar that is never drawn.
pub(super) struct ProgressBar;

impl ProgressBar {
    pub(super) fn with_draw_target(_length: Option<u64>, _target: ProgressDrawTarget) -> Self {
        Self
    }

    pub(super) fn is_hidden(&self) -> bool {
        true
    }

    pub(super) fn set_style(&self, _style: ProgressStyle) {}

    pub(super) fn set_message(&self, _message: String) {}

    pub(super) fn set_position(&self, _position: u64) {}

    pub(super) fn set_length(&self, _length: u64) {}

    pub(super) fn unset_length(&self) {}

    pub(super) fn reset_elapsed(&self) {}

    pub(super) fn suspend(&self, write: impl FnOnce()) {
        write();
    }

    pub(super) fn finish_and_clear(&self) {}
}

/// Where nothing is drawn.
pub(super) struct ProgressDrawTarget;

impl ProgressDrawTarget {
    pub(super) fn hidden() -> Self {
        Self
    }

    pub(super) fn stderr() -> Self {
        Self
    }
}

/// The style of nothing.
pub(super) struct ProgressStyle;

impl ProgressStyle {
    pub(super) fn with_template(_template: &str) -> Result<Self, std::convert::Infallible> {
        Ok(Self)
    }
}
