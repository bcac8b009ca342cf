//! Commands from ROS 2 messages: values are preserved, and arbitrary bytes are handled safely.

use jamgrip::{
    command::{Command, PoseCommand},
    wire::{
        from_ros::{CommandCodec, CommandDecodeError},
        messages::{RosMessage, jamgrip_msgs::ObjectCommand, std_msgs::Float64},
        topics::{CommonTopic, common},
    },
};
use proptest::prelude::*;

use crate::synthetic::{self, OBJECT};

fn codec() -> CommandCodec {
    synthetic::encoder().commands().clone()
}

/// Stamps that ROS can represent (ns).
fn stamps() -> impl Strategy<Value = i64> + Clone {
    i64::from(i32::MIN) * 1_000_000_000..=i64::from(i32::MAX) * 1_000_000_000
}

/// Commands with arbitrary numbers, including NaN and infinities, and stamps that ROS can represent.
fn any_command() -> impl Strategy<Value = Command> {
    let pose = ("[a-z/_]{0,20}", stamps(), any::<[u64; 3]>(), any::<[u64; 4]>());
    let pose = pose.prop_map(|(frame_id, stamp_ns, position, orientation)| PoseCommand {
        frame_id,
        stamp_ns,
        position: position.map(f64::from_bits),
        orientation: orientation.map(f64::from_bits),
    });
    let object = prop_oneof![Just(OBJECT.to_owned()), "[a-z]{0,12}"];
    prop_oneof![
        any::<u64>().prop_map(|bits| Command::Vacuum { gauge_pa: f64::from_bits(bits) }),
        pose.clone().prop_map(Command::FlangePose),
        (object.clone(), pose).prop_map(|(object, pose)| Command::ObjectPose { object, pose }),
        object.prop_map(|object| Command::ObjectRelease { object }),
        (
            stamps(),
            prop::collection::vec("[a-z_]{0,8}", 0..5),
            prop::collection::vec(any::<u64>(), 0..5)
        )
            .prop_map(|(stamp_ns, names, bits)| Command::Joints {
                stamp_ns,
                names,
                positions: bits.into_iter().map(f64::from_bits).collect(),
            }),
    ]
}

proptest! {
    #[test]
    fn commands_are_preserved_by_encoding_and_decoding(command in any_command()) {
        let codec = codec();
        let message = codec.encode(&command, 0);
        prop_assert!(synthetic::encoder().topics()[message.topic].is_input);
        let back = codec.decode(message.topic, &message.cdr).unwrap();
        // Oracle: the command itself. Debug text is equal for NaN too, and distinguishes -0 from 0.
        prop_assert_eq!(format!("{back:?}"), format!("{command:?}"));
    }

    #[test]
    fn arbitrary_bytes_do_not_panic(topic in 0_usize..28, bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        // Oracle: no panic and no unbounded memory: a command or an error.
        if let Err(reason) = codec().decode(topic, &bytes) {
            prop_assert!(reason.to_string().contains('/'), "names the topic: {}", reason);
        }
    }

    #[test]
    fn truncated_messages_are_rejected(command in any_command(), share in 0.0..1.0_f64) {
        let codec = codec();
        let message = codec.encode(&command, 0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length")]
        let length = (message.cdr.len() as f64 * share) as usize;
        let outcome = codec.decode(message.topic, &message.cdr[..length]);
        let is_malformed = matches!(outcome, Err(CommandDecodeError::Malformed { .. }));
        prop_assert!(is_malformed, "{:?}", outcome);
    }
}

#[test]
fn errors_name_a_remedy() {
    let codec = codec();
    let vacuum = common(CommonTopic::VacuumCommand);
    let text = codec.decode(vacuum, &[1, 2, 3]).unwrap_err().to_string();
    assert!(
        text.starts_with(
            "message on /jamgrip/vacuum_cmd: its 3 bytes are not a std_msgs/msg/Float64"
        ),
        "{text}"
    );
    let strange = ObjectCommand { mode: 9, ..ObjectCommand::default() };
    let text = codec.decode(common(CommonTopic::ObjectCommand), &strange.to_cdr()).unwrap_err();
    assert_eq!(
        text.to_string(),
        "message on /jamgrip/object_cmd: mode is 9, not MODE_DRIVE (0) or MODE_RELEASE (1)"
    );
    let text =
        codec.decode(common(CommonTopic::Clock), &Float64 { data: 1.0 }.to_cdr()).unwrap_err();
    assert_eq!(text.to_string(), "message on /clock: this topic carries no commands");
}
