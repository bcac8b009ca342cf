//! A client of services, which also reads the clock.

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

/// Clients of all services, and the clock.
pub(crate) struct Client {
    node: Arc<RosNode>,
    options: Options,
    clients: BTreeMap<String, RosClient>,
    clock: Subscription<Clock>,
    /// Simulation times received since they were last taken (ns), without repetitions.
    times_ns: Vec<i64>,
    /// The last simulation time received (ns).
    last_ns: Option<i64>,
}

#[expect(clippy::disallowed_methods, reason = "timeouts of responses")]
fn now() -> Instant {
    Instant::now()
}

/// Time between two polls.
const POLL_PERIOD: Duration = Duration::from_millis(1);

impl Client {
    /// Creates a client and subscribes to the clock.
    pub(crate) fn new(node: Arc<RosNode>, options: &Options) -> Result<Self, String> {
        let topic = Topic::input::<Clock>("/clock", Qos::reliable(1000));
        let clock = node.subscription::<Clock>(&topic).map_err(|it| it.to_string())?;
        let (clients, options) = (BTreeMap::new(), options.clone());
        Ok(Self { node, options, clients, clock, times_ns: Vec::new(), last_ns: None })
    }

    /// The version of the standard that the simulator uses.
    pub(crate) fn version(&self) -> u8 {
        self.options.version
    }

    /// Calls a service of the simulator by its short name.
    pub(crate) fn call<S: RosService>(
        &mut self,
        name: &str,
        request: &S::Request,
    ) -> Result<S::Response, String> {
        self.call_raw(name, S::TYPE, &Cdr::of(request))?
            .read()
            .map_err(|it| format!("{name}: its response cannot be decoded: {it}"))
    }

    /// Calls a service with an encoded request.
    pub(crate) fn call_raw(
        &mut self,
        name: &str,
        service_type: ServiceType,
        request: &Cdr,
    ) -> Result<Cdr, String> {
        self.send_raw(name, service_type, request)?;
        self.wait(name)
    }

    /// Sends a request without waiting for the response.
    pub(crate) fn send_raw(
        &mut self,
        name: &str,
        service_type: ServiceType,
        request: &Cdr,
    ) -> Result<(), String> {
        let full = format!("{}/{name}", self.options.prefix);
        if !self.clients.contains_key(name) {
            let spec = ServiceSpec { name: full.clone(), service_type };
            let client = RosClient::open(&self.node, &spec, self.options.mapping);
            let mut client = client.map_err(|it| it.to_string())?;
            let deadline = now() + self.options.timeout;
            while !client.is_matched() {
                if deadline < now() {
                    return Err(format!("no server for {full}"));
                }
                std::thread::sleep(POLL_PERIOD);
            }
            self.clients.insert(name.to_owned(), client);
        }
        let client = self.clients.get_mut(name).ok_or("no client")?;
        client.send(request);
        Ok(())
    }

    /// The response to the last request, if it has arrived.
    pub(crate) fn poll(&mut self, name: &str) -> Option<Cdr> {
        self.clients.get_mut(name)?.take_response()
    }

    /// Waits for the response to the last request.
    pub(crate) fn wait(&mut self, name: &str) -> Result<Cdr, String> {
        let deadline = now() + self.options.timeout;
        loop {
            if let Some(response) = self.poll(name) {
                return Ok(response);
            }
            if deadline < now() {
                return Err(format!("{name}: no response within {:?}", self.options.timeout));
            }
            self.read_clock();
            std::thread::sleep(POLL_PERIOD);
        }
    }

    /// Reads the waiting clock messages.
    pub(crate) fn read_clock(&mut self) {
        while let Ok(Some((message, _))) = self.clock.take() {
            let stamp = message.clock;
            let time_ns = i64::from(stamp.sec) * 1_000_000_000 + i64::from(stamp.nanosec);
            if self.last_ns != Some(time_ns) {
                self.times_ns.push(time_ns);
                self.last_ns = Some(time_ns);
            }
        }
    }

    /// New simulation times since the last call (ns).
    pub(crate) fn take_times(&mut self) -> Vec<i64> {
        self.read_clock();
        std::mem::take(&mut self.times_ns)
    }

    /// The last simulation time received (ns); waits for one.
    pub(crate) fn time_ns(&mut self) -> Result<i64, String> {
        let deadline = now() + self.options.timeout;
        loop {
            self.read_clock();
            if let Some(time_ns) = self.last_ns {
                return Ok(time_ns);
            }
            if deadline < now() {
                return Err("no message on /clock".to_owned());
            }
            std::thread::sleep(POLL_PERIOD);
        }
    }

    /// Lets wall-clock time pass while reading the clock.
    pub(crate) fn idle(&mut self, time: Duration) {
        let deadline = now() + time;
        while now() < deadline {
            self.read_clock();
            std::thread::sleep(POLL_PERIOD);
        }
    }

    /// Waits until the condition is true.
    pub(crate) fn until(
        &mut self,
        what: &str,
        mut condition: impl FnMut(&mut Self) -> bool,
    ) -> Result<(), String> {
        let deadline = now() + self.options.timeout;
        while !condition(self) {
            if deadline < now() {
                return Err(format!("timed out waiting for {what}"));
            }
            std::thread::sleep(POLL_PERIOD);
        }
        Ok(())
    }
}

/// Checks that a result is OK.
pub(crate) fn must_be_ok(what: &str, result: &SimResult) -> Result<(), String> {
    must_be(what, result, SimResult::RESULT_OK)
}

/// Checks that a result has this code.
pub(crate) fn must_be(what: &str, result: &SimResult, code: u8) -> Result<(), String> {
    if result.result == code {
        return Ok(());
    }
    Err(format!("{what}: result {} (`{}`), expected {code}", result.result, result.error_message))
}

/// Checks that a result is not OK.
pub(crate) fn must_fail(what: &str, result: &SimResult) -> Result<(), String> {
    if result.result == SimResult::RESULT_OK { Err(format!("{what}: result OK")) } else { Ok(()) }
}

/// Checks a condition.
pub(crate) fn ensure(condition: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if condition { Ok(()) } else { Err(what()) }
}
