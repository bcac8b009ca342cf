//! Asks services one at a time, follows the clock and drives an action.

use std::{
    collections::BTreeMap,
    sync::Arc,
    time::{Duration, Instant},
};

use jamgrip::{
    io::server::ServiceSpec,
    ros::{
        node::{RosNode, Subscription},
        service::RosClient,
    },
    wire::{
        cdr::Cdr,
        messages::{
            RosService, ServiceType, rosgraph_msgs::Clock,
            simulation_interfaces::Result as SimResult,
        },
        topics::{Qos, Topic},
    },
};

use crate::Options;

/// A client of everything.
pub(crate) struct Client {
    node: Arc<RosNode>,
    options: Options,
    clients: BTreeMap<String, RosClient>,
    clock: Subscription<Clock>,
    /// Simulated times heard since they were last looked at (ns), repetitions left out.
    times_ns: Vec<i64>,
    /// The last simulated time heard (ns).
    last_ns: Option<i64>,
}

#[expect(clippy::disallowed_methods, reason = "how long is waited for an answer")]
fn now() -> Instant {
    Instant::now()
}

/// Waits this long between two looks.
const NAP: Duration = Duration::from_millis(1);

impl Client {
    /// A client that has heard of the simulator.
    pub(crate) fn new(node: Arc<RosNode>, options: &Options) -> Result<Self, String> {
        let topic = Topic::input::<Clock>("/clock", Qos::reliable(1000));
        let clock = node.subscription::<Clock>(&topic).map_err(|it| it.to_string())?;
        let (clients, options) = (BTreeMap::new(), options.clone());
        Ok(Self { node, options, clients, clock, times_ns: Vec::new(), last_ns: None })
    }

    /// The version of the standard that the simulator speaks.
    pub(crate) fn version(&self) -> u8 {
        self.options.version
    }

    /// Asks a service of the simulator by its short name.
    pub(crate) fn ask<S: RosService>(
        &mut self,
        name: &str,
        question: &S::Request,
    ) -> Result<S::Response, String> {
        self.ask_raw(name, S::TYPE, &Cdr::of(question))?
            .read()
            .map_err(|it| format!("{name}: its answer cannot be read: {it}"))
    }

    /// Asks with bytes.
    pub(crate) fn ask_raw(
        &mut self,
        name: &str,
        of: ServiceType,
        question: &Cdr,
    ) -> Result<Cdr, String> {
        self.send_raw(name, of, question)?;
        self.wait(name)
    }

    /// Asks and does not wait.
    pub(crate) fn send_raw(
        &mut self,
        name: &str,
        of: ServiceType,
        question: &Cdr,
    ) -> Result<(), String> {
        let full = format!("{}/{name}", self.options.prefix);
        if !self.clients.contains_key(name) {
            let offer = ServiceSpec { name: full.clone(), service_type: of };
            let client = RosClient::open(&self.node, &offer, self.options.way);
            let mut client = client.map_err(|it| it.to_string())?;
            let deadline = now() + self.options.patience;
            while !client.is_matched() {
                if deadline < now() {
                    return Err(format!("nobody serves {full}"));
                }
                std::thread::sleep(NAP);
            }
            self.clients.insert(name.to_owned(), client);
        }
        let client = self.clients.get_mut(name).ok_or("no client")?;
        client.ask(question);
        Ok(())
    }

    /// The answer to the last question, if it is there.
    pub(crate) fn poll(&mut self, name: &str) -> Option<Cdr> {
        self.clients.get_mut(name)?.answer()
    }

    /// Waits for the answer to the last question.
    pub(crate) fn wait(&mut self, name: &str) -> Result<Cdr, String> {
        let deadline = now() + self.options.patience;
        loop {
            if let Some(answer) = self.poll(name) {
                return Ok(answer);
            }
            if deadline < now() {
                return Err(format!("{name}: no answer within {:?}", self.options.patience));
            }
            self.listen();
            std::thread::sleep(NAP);
        }
    }

    /// Takes what the clock has said.
    pub(crate) fn listen(&mut self) {
        while let Ok(Some((message, _))) = self.clock.take() {
            let stamp = message.clock;
            let time_ns = i64::from(stamp.sec) * 1_000_000_000 + i64::from(stamp.nanosec);
            if self.last_ns != Some(time_ns) {
                self.times_ns.push(time_ns);
                self.last_ns = Some(time_ns);
            }
        }
    }

    /// New simulated times since the last call (ns).
    pub(crate) fn take_times(&mut self) -> Vec<i64> {
        self.listen();
        std::mem::take(&mut self.times_ns)
    }

    /// The last simulated time heard (ns); waits for one.
    pub(crate) fn time_ns(&mut self) -> Result<i64, String> {
        let deadline = now() + self.options.patience;
        loop {
            self.listen();
            if let Some(time_ns) = self.last_ns {
                return Ok(time_ns);
            }
            if deadline < now() {
                return Err("/clock says nothing".to_owned());
            }
            std::thread::sleep(NAP);
        }
    }

    /// Lets wall time pass, with open ears.
    pub(crate) fn idle(&mut self, time: Duration) {
        let deadline = now() + time;
        while now() < deadline {
            self.listen();
            std::thread::sleep(NAP);
        }
    }

    /// Waits until `is_so`.
    pub(crate) fn until(
        &mut self,
        what: &str,
        mut is_so: impl FnMut(&mut Self) -> bool,
    ) -> Result<(), String> {
        let deadline = now() + self.options.patience;
        while !is_so(self) {
            if deadline < now() {
                return Err(format!("waited in vain for {what}"));
            }
            std::thread::sleep(NAP);
        }
        Ok(())
    }
}

/// An answer that must be OK.
pub(crate) fn must_be_ok(what: &str, told: &SimResult) -> Result<(), String> {
    must_be(what, told, SimResult::RESULT_OK)
}

/// An answer that must have this code.
pub(crate) fn must_be(what: &str, told: &SimResult, code: u8) -> Result<(), String> {
    if told.result == code {
        return Ok(());
    }
    Err(format!("{what}: result {} (`{}`), not {code}", told.result, told.error_message))
}

/// An answer that must not be OK.
pub(crate) fn must_fail(what: &str, told: &SimResult) -> Result<(), String> {
    if told.result == SimResult::RESULT_OK { Err(format!("{what}: result OK")) } else { Ok(()) }
}

/// Something that must hold.
pub(crate) fn ensure(is_so: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if is_so { Ok(()) } else { Err(what()) }
}
