//! Zero-copy streams: what a reader on this host receives, and that no reader can delay the writer.

use std::{
    io::{BufRead, BufReader},
    process::{Command, Stdio},
    sync::mpsc,
    time::{Duration, Instant},
};

use jamgrip::shm::{
    rows::StateRow,
    stream::{PREFIX_VARIABLE, Services, Stream},
};

use crate::by_tick::{N_GRAINS, N_VERTICES, Synthetic, example, number};

/// A name that no other test on this host uses.
fn prefix(what: &str) -> String {
    format!("jamgrip_test_{}_{what}", std::process::id())
}

#[expect(clippy::disallowed_methods, reason = "a timeout of the test")]
fn now() -> Instant {
    Instant::now()
}

/// Oracle: the formula of the synthetic system, read from shared memory, bit for bit.
#[test]
fn a_reader_receives_every_tick() {
    let prefix = prefix("every_tick");
    let mut stream = Stream::open(&prefix, N_GRAINS, N_VERTICES).unwrap();
    let services = Services::join(&prefix).unwrap();
    let states = services.state().unwrap().subscriber_builder().create().unwrap();
    let grains = services.grains().unwrap().subscriber_builder().create().unwrap();
    let membrane = services.membrane().unwrap().subscriber_builder().create().unwrap();
    let tick = services.tick().unwrap().listener_builder().create().unwrap();

    let mut system = Synthetic::new("object");
    for now in 1..=100 {
        system.advance_to(now);
        stream.write(&system.view());

        let mut n_woken = 0;
        tick.timed_wait(|_| n_woken += 1, Duration::from_secs(5)).unwrap();
        assert_eq!(n_woken, 1, "one wake-up per tick");

        let row = states.receive().unwrap().expect("the state of this tick");
        assert_eq!(*row, StateRow::of(&system.view()));
        assert_eq!(row.digest, now.wrapping_mul(0x9e37_79b9_7f4a_7c15));

        let list = grains.receive().unwrap().expect("the grains of this tick");
        assert_eq!((list.user_header().tick, list.user_header().count), (now, N_GRAINS as u64));
        assert_eq!(list.payload().len(), N_GRAINS);
        for (i, grain) in list.payload().iter().enumerate() {
            assert!(is(grain.position[0], number(now)) && is(grain.position[1], number(i as u64)));
            assert!(is(grain.normal_force, number(now + i as u64)));
        }

        let list = membrane.receive().unwrap().expect("the membrane of this tick");
        assert_eq!(list.payload().len(), N_VERTICES);
        assert!(is(list.payload()[N_VERTICES - 1].position[1], number(N_VERTICES as u64 - 1)));
    }
    assert_eq!((stream.counters().n_written, stream.counters().n_failed), (100, 0));
}

/// Oracle: a reader that never reads loses the oldest ticks; the newest stay.
#[test]
fn a_sleeping_reader_loses_old_ticks_and_delays_nothing() {
    let prefix = prefix("sleeper");
    let mut stream = Stream::open(&prefix, N_GRAINS, N_VERTICES).unwrap();
    let services = Services::join(&prefix).unwrap();
    let states = services.state().unwrap().subscriber_builder().create().unwrap();
    let grains = services.grains().unwrap().subscriber_builder().create().unwrap();
    let _never_listens = services.tick().unwrap().listener_builder().create().unwrap();

    let mut system = Synthetic::new("object");
    for now in 1..=5000 {
        system.advance_to(now);
        stream.write(&system.view());
    }
    assert_eq!((stream.counters().n_written, stream.counters().n_failed), (5000, 0));

    let mut received = Vec::new();
    while let Some(row) = states.receive().unwrap() {
        received.push(row.tick);
    }
    assert_eq!(received.last(), Some(&5000), "the newest tick is available");
    assert!(
        received.len() <= 4 && received.windows(2).all(|it| it[0] + 1 == it[1]),
        "{received:?}"
    );
    let list = grains.receive().unwrap().expect("grains of a recent tick");
    assert!(is(list.payload()[0].position[0], number(list.user_header().tick)));
}

/// Oracle: a second process reads and is killed while it reads; the writer continues without an
/// error.
#[test]
fn another_process_reads_and_may_be_killed() {
    let prefix = prefix("two_processes");
    let mut stream = Stream::open(&prefix, N_GRAINS, N_VERTICES).unwrap();
    let mut system = Synthetic::new("object");
    let spawn = |n_states: &str| {
        Command::new(example("stream_subscriber"))
            .arg(n_states)
            .env(PREFIX_VARIABLE, &prefix)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap()
    };
    let mut tick = 0;
    let mut write_for = |stream: &mut Stream, duration: Duration| {
        let start = now();
        while now() - start < duration {
            tick += 1;
            system.advance_to(tick);
            stream.write(&system.view());
            std::thread::sleep(Duration::from_millis(1));
        }
    };

    let mut victim = spawn("1000000");
    let lines = BufReader::new(victim.stdout.take().unwrap()).lines();
    let (send, received) = mpsc::channel();
    let listener = std::thread::spawn(move || {
        lines.map_while(Result::ok).try_for_each(|line| send.send(line))
    });
    let start = now();
    // It prints once a second what it has read; before its first state it prints `tick 0`.
    while !received.try_iter().any(|line| line.starts_with("tick ") && !line.starts_with("tick 0 "))
    {
        assert!(
            now() - start < Duration::from_secs(60),
            "the first reader received nothing in 60 s"
        );
        write_for(&mut stream, Duration::from_millis(50));
    }
    assert_eq!(victim.try_wait().unwrap(), None, "it is still reading");
    victim.kill().unwrap();
    victim.wait().unwrap();
    drop(received);
    // The thread ends with the victim's output, or when nothing receives its lines.
    let _ended = listener.join().unwrap();
    write_for(&mut stream, Duration::from_millis(500));

    let mut reader = spawn("200");
    let start = now();
    while reader.try_wait().unwrap().is_none() {
        assert!(
            now() - start < Duration::from_secs(60),
            "the reader did not receive 200 states in 60 s"
        );
        write_for(&mut stream, Duration::from_millis(50));
    }
    let output = reader.wait_with_output().unwrap();
    let output_text = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success() && output_text.contains("3000 grains down to 498.0 mm"),
        "{output_text}"
    );
    let error = stream.take_error();
    assert_eq!(stream.counters().n_failed, 0, "{error:?}");
}

/// Oracle: a second writer under one name is rejected, and the error names the remedy.
#[test]
fn a_second_writer_is_rejected_with_a_remedy() {
    let prefix = prefix("second");
    let _first = Stream::open(&prefix, 1, 1).unwrap();
    let error = Stream::open(&prefix, 1, 1).err().expect("one writer per name").to_string();
    assert!(error.contains(&prefix) && error.contains(PREFIX_VARIABLE), "{error}");
}

/// Equal bit for bit: the streams copy, they do not compute.
fn is(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits()
}
