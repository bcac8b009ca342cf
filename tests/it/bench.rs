//! Benchmarks: their output, and that digests depend neither on threads nor on time.

use std::{path::Path, process::Command};

use serde_json::Value;

/// Results of the smallest case.
fn measured(cache: &Path, threads: &str, seconds: &str) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
        .args(["bench", "--case", "grains_3k_rest", "--json", "--threads", threads])
        .args(["--seconds", seconds, "--cache"])
        .arg(cache)
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{errors}");
    let Value::Array(cases) = serde_json::from_slice(&output.stdout).unwrap() else { panic!() };
    assert_eq!(cases.len(), 1);
    cases[0].clone()
}

/// Oracles: the definitions of the results, to rounding; the same bits for any number of threads and
/// repetitions.
#[test]
fn results_are_complete_and_digests_depend_on_neither_threads_nor_time() {
    let cache = tempfile::tempdir().unwrap();
    let one = measured(cache.path(), "1", "0.1");
    let two = measured(cache.path(), "2", "0.5");
    for key in ["digest", "digest_after_steps", "start_digest", "n_contacts", "overlap_max_m"] {
        assert_eq!(one[key], two[key], "{key}");
    }
    assert_eq!([&one["threads"], &two["threads"]], [1, 2]);
    assert_eq!(one["case"], "grains_3k_rest");
    assert_eq!([&one["n_grains"], &one["n_vertices"]], [3000, 0]);
    let number = |key: &str| one[key].as_f64().unwrap_or_else(|| panic!("{key}: {one}"));
    let speed = number("steps_per_s");
    let contacts = number("contact_steps_per_s_per_core") / speed;
    assert!((contacts / number("n_contacts") - 1.0).abs() < 0.01, "contacts of loose grains vary");
    assert!((number("real_time_factor") / (speed * number("substep_s")) - 1.0).abs() < 1e-12);
    // 5.75 partners of each grain under 50 kPa, as in the packings of other codes; 5 % of it.
    assert!((number("n_contacts") / 1500.0 / 5.75 - 1.0).abs() < 0.05, "{one}");
    let stages = one["stages"].as_array().unwrap();
    let shares: f64 = stages.iter().map(|it| it["share"].as_f64().unwrap()).sum();
    assert!((shares - 1.0).abs() < 1e-12);
    assert!(stages.iter().any(|it| it["name"] == "contact_grains"));
}

/// Oracle: the exit code of a command-line error; the message names the existing case.
#[test]
fn unknown_cases_are_rejected() {
    let output = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
        .args(["bench", "--case", "grains_3k_rset"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(text.contains("grains_3k_rset") && text.contains("grains_3k_rest"), "{text}");
}
