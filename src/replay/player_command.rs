//! What someone may want of a recording that plays, and what they are told.

use std::sync::mpsc::Sender;

/// What someone wants while it plays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlayerCommand {
    /// Stand still.
    Pause,
    /// Go on.
    Resume,
    /// One of the two above.
    Toggle,
    /// Play one message and stand still again.
    Next,
    /// Play so many messages at once and stand still again; all that are left for zero. Only while it
    /// stands still.
    Burst(u64),
    /// Go to this place, from the first message on (ns).
    Seek(u64),
    /// Go to this time of the recording (ns).
    SeekTo(u64),
    /// Play so many times as fast as recorded.
    Rate(f64),
    /// Nothing but to know how it stands.
    Look,
    /// End.
    Quit,
}

/// A cue, and who wants to know what became of it.
#[derive(Debug)]
pub struct Asked {
    /// The cue.
    pub command: PlayerCommand,
    /// Where the answer goes once it has been followed.
    pub reply: Option<Sender<Answer>>,
}

/// What became of a cue.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// True if it could be followed.
    pub is_done: bool,
    /// True if it stands still now.
    pub is_paused: bool,
    /// How many times as fast as recorded it plays.
    pub rate: f64,
    /// Messages that were played for it.
    pub n_played: u64,
}

impl From<PlayerCommand> for Asked {
    fn from(command: PlayerCommand) -> Self {
        Self { command, reply: None }
    }
}

impl PlayerCommand {
    /// A cue as a line of text, such as `seek 1.5s`.
    ///
    /// # Errors
    /// If it is none; the text says which there are.
    pub fn parse(line: &str) -> Result<Self, String> {
        const KNOWN: &str = "pause, resume, toggle, next, seek TIME, rate FACTOR, quit";
        let (word, rest) = line.trim().split_once(' ').unwrap_or((line.trim(), ""));
        let unknown = || format!("`{}`: no cue; there are: {KNOWN}", line.trim());
        match (word, rest.trim()) {
            ("pause", "") => Ok(Self::Pause),
            ("resume", "") => Ok(Self::Resume),
            ("toggle" | "", "") => Ok(Self::Toggle),
            ("next", "") => Ok(Self::Next),
            ("quit", "") => Ok(Self::Quit),
            ("seek", time) => {
                let time = crate::scene::quantity::TIME.parse(time).map_err(|it| it.to_string())?;
                if time < 0.0 {
                    return Err(format!("seek {time} s: the recording begins at 0 s"));
                }
                #[expect(clippy::cast_possible_truncation, reason = "it saturates")]
                #[expect(clippy::cast_sign_loss, reason = "not negative, see above")]
                Ok(Self::Seek((time * 1e9) as u64))
            }
            ("rate", factor) => match factor.parse() {
                Ok(factor) if 0.0 < factor && f64::is_finite(factor) => Ok(Self::Rate(factor)),
                _ => Err(format!("rate {factor}: write a number above zero, such as 2")),
            },
            _ => Err(unknown()),
        }
    }
}
