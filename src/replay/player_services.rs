//! The services that control a player: those of rosbag2's own player.
//!
//! Each request becomes a command for the player. The response is sent after the player has acted,
//! so a client that has received it knows that the messages are published.

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, Sender},
    },
    thread::JoinHandle,
    time::Duration,
};

use super::player_command::{CommandRequest, PlayerCommand, PlayerStatus};
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

/// Longest delay until a request or a reply of the player is noticed.
const POLL_PERIOD: Duration = Duration::from_millis(5);
/// Largest number of requests taken at a time.
const N_REQUESTS_MAX: usize = 16;

/// Names relative to the node, and types.
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

/// The services of a node.
pub fn services(node: &str) -> Vec<ServiceSpec> {
    let spec = |(name, service_type): (&str, _)| {
        let name = format!("/{node}/{name}");
        ServiceSpec { name, service_type }
    };
    SERVICES.into_iter().map(spec).collect()
}

/// The services of a player, open until dropped.
pub struct PlayerServices {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl PlayerServices {
    /// Opens the services of a player under the node's name; commands are sent to `commands`.
    ///
    /// # Errors
    /// If a service cannot be opened.
    pub fn open(
        node: &RosNode,
        name: &str,
        commands: Sender<CommandRequest>,
    ) -> Result<Self, RosError> {
        // Responses do not wait for packets here: the player replies when it has acted.
        let published = Arc::new(PublishedUpTo::default());
        let server = RosServiceServer::open(node, &services(name), &[], &published)?;
        let stop = Arc::new(AtomicBool::new(false));
        let mut bridge = RequestBridge { server, commands, pending: Vec::new() };
        let stopped = Arc::clone(&stop);
        let builder = std::thread::Builder::new().name("player-services".to_owned());
        let thread = builder.spawn(move || {
            while !stopped.load(Ordering::SeqCst) {
                bridge.forward();
            }
            bridge.respond();
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

/// Passes requests to the player, and its replies back.
struct RequestBridge {
    server: RosServiceServer,
    commands: Sender<CommandRequest>,
    pending: Vec<(RequestId, Receiver<PlayerStatus>)>,
}

impl RequestBridge {
    fn forward(&mut self) {
        self.server.wait(POLL_PERIOD);
        for ServiceRequest { id, body } in self.server.take(N_REQUESTS_MAX) {
            let (name, _) = SERVICES[id.service % SERVICES.len()];
            match command(name, &body) {
                Ok(Some(command)) => {
                    let (reply, status) = mpsc::channel();
                    // A player that has ended does not reply.
                    drop(self.commands.send(CommandRequest { command, reply: Some(reply) }));
                    self.pending.push((id, status));
                }
                Ok(None) => self.server.send(Outgoing::Response(id, rejection(name)), 0),
                Err(error) => self.server.report_malformed(format!("{name}: {error}")),
            }
        }
        self.respond();
    }

    /// Sends responses for the replies that have arrived.
    fn respond(&mut self) {
        let Self { server, pending, .. } = self;
        pending.retain(|(id, status)| match status.try_recv() {
            Ok(status) => {
                let (name, _) = SERVICES[id.service % SERVICES.len()];
                server.send(Outgoing::Response(id.clone(), response(name, &status)), 0);
                false
            }
            Err(error) => error == mpsc::TryRecvError::Empty,
        });
    }
}

/// The command of a request; `None` if its arguments are out of range.
fn command(name: &str, body: &Cdr) -> Result<Option<PlayerCommand>, String> {
    let text = |error: &dyn std::fmt::Display| error.to_string();
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
        _ => Some(PlayerCommand::Status),
    })
}

/// The response of a service to the status of the player.
fn response(name: &str, status: &PlayerStatus) -> Cdr {
    let success = status.is_done;
    match name {
        "pause" => Cdr::of(&PauseResponse::default()),
        "resume" => Cdr::of(&ResumeResponse::default()),
        "toggle_paused" => Cdr::of(&TogglePausedResponse::default()),
        "is_paused" => Cdr::of(&IsPausedResponse { paused: status.is_paused }),
        "set_rate" => Cdr::of(&SetRateResponse { success }),
        "get_rate" => Cdr::of(&GetRateResponse { rate: status.rate }),
        "seek" => Cdr::of(&SeekResponse { success }),
        "play_next" => Cdr::of(&PlayNextResponse { success }),
        "burst" => Cdr::of(&BurstResponse { actually_burst: status.n_played }),
        _ => Cdr::of(&StopResponse::default()),
    }
}

/// The response to an invalid request.
fn rejection(name: &str) -> Cdr {
    response(name, &PlayerStatus::default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::messages::builtin_interfaces::Time;

    /// Oracle: the service definitions in rosbag2_interfaces.
    #[test]
    fn requests_become_commands_and_invalid_ones_are_rejected() {
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
        let rejected: SetRateResponse = rejection("set_rate").read().unwrap();
        assert!(!rejected.success);
    }
}
