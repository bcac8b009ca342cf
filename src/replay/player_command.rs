//! Commands for the player of a recording, and its replies.

use std::sync::mpsc::Sender;

/// A command for the player.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlayerCommand {
    /// Pause.
    Pause,
    /// Resume.
    Resume,
    /// Toggle between paused and playing.
    Toggle,
    /// Play one message, then pause.
    Next,
    /// Play this many messages at once, then pause again; 0 plays all remaining ones. Only while
    /// paused.
    Burst(u64),
    /// Seek to this time after the first message (ns).
    Seek(u64),
    /// Seek to this recorded time (ns).
    SeekTo(u64),
    /// Set the speed relative to the recording.
    Rate(f64),
    /// Only report the status.
    Status,
    /// Quit.
    Quit,
}

/// A command, and where to send the reply.
#[derive(Debug)]
pub struct CommandRequest {
    /// The command.
    pub command: PlayerCommand,
    /// Receives the status after the player has acted.
    pub reply: Option<Sender<PlayerStatus>>,
}

/// The status of the player after a command.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlayerStatus {
    /// True if the command succeeded.
    pub is_done: bool,
    /// True if the player is now paused.
    pub is_paused: bool,
    /// Speed relative to the recording.
    pub rate: f64,
    /// Number of messages played for the command.
    pub n_played: u64,
}

impl From<PlayerCommand> for CommandRequest {
    fn from(command: PlayerCommand) -> Self {
        Self { command, reply: None }
    }
}

impl PlayerCommand {
    /// Parses a command line such as `seek 1.5s`.
    ///
    /// # Errors
    /// If it is not a command; the message lists the valid ones.
    pub fn parse(line: &str) -> Result<Self, String> {
        const COMMANDS: &str = "pause, resume, toggle, next, seek TIME, rate FACTOR, quit";
        let (word, rest) = line.trim().split_once(' ').unwrap_or((line.trim(), ""));
        let unknown = || format!("`{}` is not a command: use {COMMANDS}", line.trim());
        match (word, rest.trim()) {
            ("pause", "") => Ok(Self::Pause),
            ("resume", "") => Ok(Self::Resume),
            ("toggle" | "", "") => Ok(Self::Toggle),
            ("next", "") => Ok(Self::Next),
            ("quit", "") => Ok(Self::Quit),
            ("seek", time) => {
                let time = crate::scene::quantity::TIME.parse(time).map_err(|it| it.to_string())?;
                if time < 0.0 {
                    return Err(format!(
                        "seek {time} s: the recording begins at 0 s, use a time from 0 s"
                    ));
                }
                #[expect(clippy::cast_possible_truncation, reason = "it saturates")]
                #[expect(clippy::cast_sign_loss, reason = "not negative, see above")]
                Ok(Self::Seek((time * 1e9) as u64))
            }
            ("rate", factor) => match factor.parse() {
                Ok(factor) if 0.0 < factor && f64::is_finite(factor) => Ok(Self::Rate(factor)),
                _ => Err(format!("rate {factor}: use a number above zero, such as 2")),
            },
            _ => Err(unknown()),
        }
    }
}
