//! Tests the rules with texts that violate them and texts that do not.

use crate::violations::violations;

fn order() -> Vec<String> {
    ["base", "scene", "physics", "cosim", "command", "node"].map(str::to_owned).to_vec()
}

/// Checks that a violation is found in the text, and that its description contains `expected`.
fn is_found(file: &str, text: &str, expected: &str) {
    let found = violations(file, text, &order());
    assert!(!found.is_empty(), "nothing found in {file}:\n{text}");
    assert!(found.iter().all(|it| it.contains(expected)), "{expected} is not all of {found:#?}");
}

fn is_clean(file: &str, text: &str) {
    assert_eq!(violations(file, text, &order()), Vec::<String>::new(), "{text}");
}

#[test]
fn imports_from_below_are_found() {
    for text in [
        "use crate::{\n    node::launch::RunError,\n    base::Vec3,\n};",
        "use crate::node;",
        "use crate::{base::{Vec3, digest}, node::{self, launch}};",
        "pub(crate) use crate::node::launch as start;",
        "fn f() {\n    use crate::node::launch;\n}",
        "fn f() -> crate::node::Launch { todo!() }",
        "fn f() { let x = <crate::node::A as B>::c(); }",
        "fn f() { assert_eq!(crate::node::x(), 1); }",
        "use super::node::launch;",
        "fn f() { super::node::launch(); }",
        "mod tests {\n    use super::super::node::launch;\n}",
        "mod tests {\n    fn f() { super::super::node::launch(); }\n}",
        "use crate as all;\nfn f() { all::node::launch(); }",
        "use super as up;\nuse up::node::launch;",
        "#[cfg(test)]\nmod tests {\n    use crate::node::launch;\n}",
        "macro_rules! m { () => { $crate::node::launch() } }",
        "use crate::r#node::x;",
    ] {
        is_found("src/base.rs", text, "`base` may not use `node`");
    }
    let deep = "use super::super::super::node::launch;";
    is_found("src/physics/contact/law.rs", deep, "`physics` may not use `node`");
    is_found("src/cosim/mod.rs", "use super::command::Change;", "`cosim` may not use `command`");
    is_found("src/cosim/change.rs", "use super::super::command::X;", "may not use `command`");
    is_found("src/base/tick.rs", "use crate::*;", "hides what is used");
    is_found("src/base/tick.rs", "use super::super::*;", "hides what is used");
    // The line is that of the name, not that of the list.
    let text = "//! About.\n\nuse crate::{\n    base::Vec3,\n    node::launch,\n};";
    is_found("src/physics/health.rs", text, "src/physics/health.rs:5: `crate::node::launch`");
}

#[test]
fn imports_from_above_are_clean() {
    for text in [
        "use crate::{base::Vec3, scene::Scene};",
        "use super::model::Model;\nuse self::inner::X;\nuse super::*;",
        "// use crate::node::launch;\n/// See [`crate::node::launch`].\nfn f() {}",
        "fn f() -> &'static str { \"crate::node::launch\" }",
        "use crate::physics::node::X;\nfn f() { self.node::<u8>(); node.launch(); }",
        "mod node;\nuse node::X;\nfn f() -> impl Sized + use<> { node::launch() }",
        "pub(in crate::physics) fn f() {}\npub(crate) fn g() {}",
        "fn f() { std::time::Duration::ZERO; std::array::from_fn(|i| i); }",
    ] {
        is_clean("src/physics/health.rs", text);
    }
    is_clean("src/node/mod.rs", "use crate::{command, cosim, physics};");
    // The program is not part of the order.
    is_clean("src/bin/jamgrip/bag.rs", "use jamgrip::node;\nuse crate::args;");
}

#[test]
fn a_core_that_touches_the_outside_is_found() {
    for (text, expected) in [
        ("use std::{\n    fs,\n    path::Path,\n};", "`std::fs`"),
        ("use std::{fmt, net::TcpStream};", "`std::net::TcpStream`"),
        ("use std::{time::{Duration, Instant}};", "`std::time::Instant`"),
        ("use std::time::Instant as Moment;", "`std::time::Instant`"),
        ("use core::time::Instant;", "`std::time::Instant`"),
        ("use std::time;\nfn f() { time::Instant::now(); }", "`std::time::Instant::now`"),
        ("use std::time::{self as clock};\nfn f() { clock::Instant::now(); }", "Instant::now`"),
        ("use std::time::*;", "`std::time::*`"),
        ("use std as s;\nfn f() { s::env::var(\"HOME\"); }", "`std::env::var`"),
        ("extern crate std as s;\nfn f() { s::env::var(\"HOME\"); }", "`std::env::var`"),
        ("fn f() { ::std::fs::read(\"x\"); }", "`std::fs::read`"),
        ("fn f() { std::thread::sleep(std::time::Duration::ZERO); }", "`std::thread::sleep`"),
        ("use std::thread::sleep as wait;", "`std::thread::sleep`"),
        ("use std::thread as t;", "`std::thread`"),
        ("fn f() { log::warn!(\"x\"); }", "`log::warn`"),
        ("use log::warn as other;", "`log::warn`"),
        ("use log as l;\nfn f() { l::warn!(\"x\"); }", "`log"),
        ("fn f() { println!(\"{:?}\", std::env::args()); }", "`std::env::args`"),
    ] {
        is_found("src/physics/health.rs", text, expected);
    }
    is_found("src/controller/mod.rs", "use crate::session::Session;", "in another process");
    is_clean("src/base/parallel.rs", "fn f() { std::thread::yield_now(); }");
    is_clean("src/node/mod.rs", "use std::{fs, thread, time::Instant};");
}

#[test]
fn foreign_crates_outside_their_files_are_found() {
    for text in [
        "use rapier3d_f64::prelude::*;",
        "use rapier3d_f64::parry::shape::Ball;",
        "fn f() -> rapier3d_f64::prelude::RigidBodySet { todo!() }",
        "use rapier3d_f64 as physics_engine;",
        "use ::rapier3d_f64::prelude::RigidBodySet;",
        "extern crate rapier3d_f64;",
    ] {
        is_found("src/physics/health.rs", text, "belongs in");
    }
    is_found("src/physics/boundary/polyhedron.rs", "use rapier3d_f64::dynamics;", "belongs in");
    is_clean("src/physics/boundary/polyhedron.rs", "use rapier3d_f64::parry::shape::TriMesh;");
    is_found("src/cosim/compile/mod.rs", "fn f(pool: &rayon::ThreadPool) {}", "`rayon` belongs in");
    is_found("src/cosim/compile/mod.rs", "fn f() { rayon::join(a, b); }", "`rayon` belongs in");
}

#[test]
fn unsafe_and_hidden_code_is_found() {
    is_found("src/physics/health.rs", "fn f() { unsafe { g() } }", "unsafe code");
    is_clean("src/physics/health.rs", "#[expect(unsafe_code)]\nfn f() {}");
    is_found("src/physics/health.rs", "include!(\"other.rs\");", "not checked");
    is_found("src/physics/health.rs", "#[path = \"x.rs\"]\nmod other;", "not checked");
    is_clean("src/physics/health.rs", "const TEXT: &str = include_str!(\"x.txt\");");
    is_found("src/physics/health.rs", "fn f( {", "no Rust");
}
