//! The whole program in a process of its own, and clients of its services.

use std::{
    path::Path,
    process::{Child, Command, Stdio},
    time::Duration,
};

use jamgrip::{
    io::server::ServiceSpec,
    ros::{
        node::RosNode,
        service::{RosClient, ServiceMapping},
    },
    wire::{
        cdr::Cdr,
        messages::{RosService, ServiceType},
    },
};
use serde::{Serialize, de::DeserializeOwned};

use crate::{coarse, private_network::reach};

/// The program with the coarse gripper, which waits for someone to begin.
pub(crate) struct Running(Child);

impl Running {
    /// Starts it; `changes` are keys of the scene.
    pub(crate) fn start(folder: &Path, changes: &[&str]) -> Self {
        Self::start_with(folder, changes, &[])
    }

    /// The same with more on the command line.
    pub(crate) fn start_with(folder: &Path, changes: &[&str], more: &[&str]) -> Self {
        let scene = folder.join("coarse.yaml");
        std::fs::write(&scene, coarse::TEXT).unwrap();
        let cache = ["--cache", concat!(env!("CARGO_TARGET_TMPDIR"), "/starts")];
        let child = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
            .arg("run")
            .arg(&scene)
            .args(["--set", "controller=topics", "--no-stream", "--threads", "1"])
            .args(if more.contains(&"--bag") { None } else { Some("--no-bag") })
            .args(changes.iter().flat_map(|it| ["--set", it]))
            .args(if more.contains(&"--cache") { &[][..] } else { &cache[..] })
            .args(more)
            .env("ROS_DOMAIN_ID", reach().domain_id.to_string())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        Self(child)
    }
}

impl Running {
    /// Asks it to end, and waits until it has.
    pub(crate) fn end(mut self) {
        let kill = Command::new("kill").args(["-INT", &self.0.id().to_string()]).status();
        assert!(kill.unwrap().success());
        self.0.wait().unwrap();
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may be gone already.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// A client of one service of the program.
pub(crate) struct Client(RosClient);

impl Client {
    /// Waits until it is served.
    pub(crate) fn of<S: RosService>(node: &RosNode, name: &str) -> Self {
        Self::typed(node, name, S::TYPE)
    }

    /// The same for a service known by its type's description.
    pub(crate) fn typed(node: &RosNode, name: &str, service_type: ServiceType) -> Self {
        Self::at(node, &format!("/jamgrip/{name}"), service_type)
    }

    /// The same by its full name.
    pub(crate) fn at(node: &RosNode, name: &str, service_type: ServiceType) -> Self {
        let offer = ServiceSpec { name: name.to_owned(), service_type };
        let mut client = RosClient::open(node, &offer, ServiceMapping::Enhanced).unwrap();
        wait_until(name, || client.is_matched());
        Self(client)
    }

    /// Asks and waits for the answer.
    pub(crate) fn ask<Q: Serialize, A: DeserializeOwned>(&mut self, question: &Q) -> A {
        self.say(question);
        self.hear()
    }

    /// Asks.
    pub(crate) fn say<Q: Serialize>(&mut self, question: &Q) {
        self.0.send(&Cdr::of(question));
    }

    /// Waits for the answer.
    pub(crate) fn hear<A: DeserializeOwned>(&mut self) -> A {
        let mut answer = None;
        wait_until("an answer", || {
            answer = self.0.take_response();
            answer.is_some()
        });
        answer.unwrap().read().unwrap()
    }
}

/// Waits until `is_so`, about a minute.
pub(crate) fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    for _ in 0..60_000 {
        if is_so() {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("waited a minute for {what}");
}
