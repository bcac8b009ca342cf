//! The complete program in a separate process, and clients of its services.

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

use crate::{coarse, private_network::discovery_range};

/// The program with the coarse gripper, waiting for a first command.
pub(crate) struct Program(Child);

impl Program {
    /// Starts it; `changes` are overrides of the scene.
    pub(crate) fn start(folder: &Path, changes: &[&str]) -> Self {
        Self::start_with(folder, changes, &[])
    }

    /// Starts it with more command-line arguments.
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
            .env("ROS_DOMAIN_ID", discovery_range().domain_id.to_string())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        Self(child)
    }
}

impl Program {
    /// Sends SIGINT and waits until the process has ended.
    pub(crate) fn end(mut self) {
        let kill = Command::new("kill").args(["-INT", &self.0.id().to_string()]).status();
        assert!(kill.unwrap().success());
        self.0.wait().unwrap();
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // It may have ended already.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// A client of one service of the program.
pub(crate) struct Client(RosClient);

impl Client {
    /// Opens a client and waits until it is matched.
    pub(crate) fn of<S: RosService>(node: &RosNode, name: &str) -> Self {
        Self::typed(node, name, S::TYPE)
    }

    /// Opens a client of a service with this type.
    pub(crate) fn typed(node: &RosNode, name: &str, service_type: ServiceType) -> Self {
        Self::at(node, &format!("/jamgrip/{name}"), service_type)
    }

    /// Opens a client of a service with this full name.
    pub(crate) fn at(node: &RosNode, name: &str, service_type: ServiceType) -> Self {
        let spec = ServiceSpec { name: name.to_owned(), service_type };
        let mut client = RosClient::open(node, &spec, ServiceMapping::Enhanced).unwrap();
        wait_until(name, || client.is_matched());
        Self(client)
    }

    /// Sends a request and waits for the response.
    pub(crate) fn call<Q: Serialize, A: DeserializeOwned>(&mut self, request: &Q) -> A {
        self.send(request);
        self.receive()
    }

    /// Sends a request.
    pub(crate) fn send<Q: Serialize>(&mut self, request: &Q) {
        self.0.send(&Cdr::of(request));
    }

    /// Waits for the response.
    pub(crate) fn receive<A: DeserializeOwned>(&mut self) -> A {
        let mut response = None;
        wait_until("a response", || {
            response = self.0.take_response();
            response.is_some()
        });
        response.unwrap().read().unwrap()
    }
}

/// Waits until `condition`, for about a minute.
pub(crate) fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    for _ in 0..60_000 {
        if condition() {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("waited a minute for {what}");
}
