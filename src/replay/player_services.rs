//! Services by which others pause, wind and step a player, as those of rosbag2's own player.
//!
//! Each question becomes a cue; it is answered when the player has followed it, so that who has an
//! answer knows that the messages are out.

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, Sender},
    },
    thread::JoinHandle,
    time::Duration,
};

use super::player_command::{Answer, Asked, PlayerCommand};
use crate::{
    io::{
        published::PublishedUpTo,
        server::{Outgoing, RequestId, ServiceRequest, ServiceServer, ServiceSpec},
    },
    ros::{
        node::{RosError, RosNode},
        service::RosServiceServer,
    },
    wire::{
        cdr::Cdr,
        messages::{
            RosService, ServiceType,
            rosbag2_interfaces::{
                BurstRequest, BurstResponse, GetRateResponse, IsPausedResponse, PauseResponse,
                PlayNextResponse, ResumeResponse, SeekRequest, SeekResponse, SetRateRequest,
                SetRateResponse, StopResponse, TogglePausedResponse,
                srv::{
                    Burst, GetRate, IsPaused, Pause, PlayNext, Resume, Seek, SetRate, Stop,
                    TogglePaused,
                },
            },
        },
    },
};

/// Longest time until a question is seen, or an answer of the player.
const POLL_PERIOD: Duration = Duration::from_millis(5);
/// Questions that are taken at a time.
const AT_ONCE: usize = 16;

/// Name below the node, type.
pub const SERVICES: [(&str, ServiceType); 10] = [
    ("pause", Pause::TYPE),
    ("resume", Resume::TYPE),
    ("toggle_paused", TogglePaused::TYPE),
    ("is_paused", IsPaused::TYPE),
    ("set_rate", SetRate::TYPE),
    ("get_rate", GetRate::TYPE),
    ("seek", Seek::TYPE),
    ("play_next", PlayNext::TYPE),
    ("burst", Burst::TYPE),
    ("stop", Stop::TYPE),
];

/// The services below a node.
pub fn offers(node: &str) -> Vec<ServiceSpec> {
    let offer = |(name, service_type): (&str, _)| {
        let name = format!("/{node}/{name}");
        ServiceSpec { name, service_type }
    };
    SERVICES.into_iter().map(offer).collect()
}

/// Serves until it is dropped.
pub struct PlayerServices {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl PlayerServices {
    /// Opens the services of a player below the node's name; cues go to `teller`.
    ///
    /// # Errors
    /// When one cannot be opened.
    pub fn open(node: &RosNode, name: &str, teller: Sender<Asked>) -> Result<Self, RosError> {
        // Answers follow no packets here: the player itself says when it is time.
        let bench =
            RosServiceServer::open(node, &offers(name), &[], &Arc::new(PublishedUpTo::default()))?;
        let stop = Arc::new(AtomicBool::new(false));
        let mut bridge = RequestBridge { bench, teller, open: Vec::new() };
        let stopped = Arc::clone(&stop);
        let builder = std::thread::Builder::new().name("prompter".to_owned());
        let thread = builder.spawn(move || {
            while !stopped.load(Ordering::SeqCst) {
                bridge.serve();
            }
            bridge.collect();
        });
        let thread = thread.map_err(|reason| RosError::Thread { reason })?;
        Ok(Self { stop, thread: Some(thread) })
    }
}

impl Drop for PlayerServices {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has nothing left to stop.
            drop(thread.join());
        }
    }
}

/// Questions on their way to the player and back.
struct RequestBridge {
    bench: RosServiceServer,
    teller: Sender<Asked>,
    open: Vec<(RequestId, Receiver<Answer>)>,
}

impl RequestBridge {
    fn serve(&mut self) {
        self.bench.wait(POLL_PERIOD);
        for ServiceRequest { asker, body } in self.bench.take(AT_ONCE) {
            let (name, _) = SERVICES[asker.offer % SERVICES.len()];
            match command(name, &body) {
                Ok(Some(command)) => {
                    let (reply, answer) = mpsc::channel();
                    // A player that has ended answers nobody.
                    drop(self.teller.send(Asked { command, reply: Some(reply) }));
                    self.open.push((asker, answer));
                }
                Ok(None) => self.bench.send(Outgoing::Response(asker, refusal(name)), 0),
                Err(fault) => self.bench.report_malformed(format!("{name}: {fault}")),
            }
        }
        self.collect();
    }

    /// Sends what the player has answered.
    fn collect(&mut self) {
        let Self { bench, open, .. } = self;
        open.retain(|(asker, answer)| match answer.try_recv() {
            Ok(answer) => {
                let (name, _) = SERVICES[asker.offer % SERVICES.len()];
                bench.send(Outgoing::Response(asker.clone(), response(name, &answer)), 0);
                false
            }
            Err(error) => error == mpsc::TryRecvError::Empty,
        });
    }
}

/// What a question asks of the player; `None` if it asks for what cannot be.
fn command(name: &str, body: &Cdr) -> Result<Option<PlayerCommand>, String> {
    let text = |fault: &dyn std::fmt::Display| fault.to_string();
    Ok(match name {
        "pause" => Some(PlayerCommand::Pause),
        "resume" => Some(PlayerCommand::Resume),
        "toggle_paused" => Some(PlayerCommand::Toggle),
        "set_rate" => {
            let SetRateRequest { rate } = body.read().map_err(|it| text(&it))?;
            (0.0 < rate && rate.is_finite()).then_some(PlayerCommand::Rate(rate))
        }
        "seek" => {
            let SeekRequest { time } = body.read().map_err(|it| text(&it))?;
            let sec = u64::try_from(time.sec).ok();
            sec.map(|sec| PlayerCommand::SeekTo(sec * 1_000_000_000 + u64::from(time.nanosec)))
        }
        "play_next" => Some(PlayerCommand::Burst(1)),
        "burst" => {
            let BurstRequest { num_messages } = body.read().map_err(|it| text(&it))?;
            Some(PlayerCommand::Burst(num_messages))
        }
        "stop" => Some(PlayerCommand::Quit),
        _ => Some(PlayerCommand::Look),
    })
}

/// The player's answer in the words of a service.
fn response(name: &str, answer: &Answer) -> Cdr {
    let success = answer.is_done;
    match name {
        "pause" => Cdr::of(&PauseResponse::default()),
        "resume" => Cdr::of(&ResumeResponse::default()),
        "toggle_paused" => Cdr::of(&TogglePausedResponse::default()),
        "is_paused" => Cdr::of(&IsPausedResponse { paused: answer.is_paused }),
        "set_rate" => Cdr::of(&SetRateResponse { success }),
        "get_rate" => Cdr::of(&GetRateResponse { rate: answer.rate }),
        "seek" => Cdr::of(&SeekResponse { success }),
        "play_next" => Cdr::of(&PlayNextResponse { success }),
        "burst" => Cdr::of(&BurstResponse { actually_burst: answer.n_played }),
        _ => Cdr::of(&StopResponse::default()),
    }
}

/// The answer to what cannot be.
fn refusal(name: &str) -> Cdr {
    response(name, &Answer::default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::messages::builtin_interfaces::Time;

    /// Oracle: the meaning of the services in rosbag2_interfaces.
    #[test]
    fn questions_become_cues_and_nonsense_is_refused() {
        let rate = |rate| command("set_rate", &Cdr::of(&SetRateRequest { rate }));
        assert_eq!(rate(2.5), Ok(Some(PlayerCommand::Rate(2.5))));
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(rate(wrong), Ok(None));
        }
        let seek =
            |sec, nanosec| command("seek", &Cdr::of(&SeekRequest { time: Time { sec, nanosec } }));
        assert_eq!(seek(2, 5), Ok(Some(PlayerCommand::SeekTo(2_000_000_005))));
        assert_eq!(seek(-1, 0), Ok(None));
        let nothing = Cdr { bytes: Vec::new(), is_big_endian: false };
        assert!(command("burst", &nothing).is_err(), "a burst without a number");
        assert_eq!(command("play_next", &nothing), Ok(Some(PlayerCommand::Burst(1))));
        let refused: SetRateResponse = refusal("set_rate").read().unwrap();
        assert!(!refused.success);
    }
}
