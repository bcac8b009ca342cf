//! The chain of digests: the digest of the state after every tick, hashed together with all
//! commands and digests before it. Changing, dropping or reordering any of them breaks all later
//! links.

use xxhash_rust::xxh3::Xxh3;

use crate::wire::{
    messages::jamgrip_msgs::{StateDigest, WorldChange},
    topics::{Qos, Topic},
};

/// The topic of a node's chained digests, which is only recorded. A tick has an additional link for
/// each change made after it.
pub fn topic(node: &str) -> Topic {
    Topic::output::<StateDigest>(&topic_name(node), Qos::reliable(10))
}

/// Name of the topic of chained digests.
pub fn topic_name(node: &str) -> String {
    format!("{node}/state_digest")
}

/// The topic of changes of the world between ticks, which is only recorded.
pub fn changes_topic(node: &str) -> Topic {
    Topic::output::<WorldChange>(&changes_topic_name(node), Qos::reliable(10))
}

/// Name of the topic of changes.
pub fn changes_topic_name(node: &str) -> String {
    format!("{node}/world_change")
}

/// The chain up to a tick.
#[derive(Clone)]
pub struct Chain {
    end: u64,
    tick: Option<u64>,
    hasher: Xxh3,
}

impl Chain {
    /// A chain that starts with the text of a scene.
    pub fn new(scene_text: &str) -> Self {
        let end = xxhash_rust::xxh3::xxh3_64(scene_text.as_bytes());
        Self { end, tick: None, hasher: Xxh3::new() }
    }

    /// The last tick that was linked.
    pub fn tick(&self) -> Option<u64> {
        self.tick
    }

    /// Adds a command of the next tick, or a change before it, as it is recorded.
    pub fn command(&mut self, topic: &str, cdr: &[u8]) {
        self.hasher.update(&(topic.len() as u64).to_le_bytes());
        self.hasher.update(topic.as_bytes());
        self.hasher.update(&(cdr.len() as u64).to_le_bytes());
        self.hasher.update(cdr);
    }

    /// Links the next tick.
    pub fn link(&mut self, tick: u64, digest: u64) -> StateDigest {
        let mut hasher = std::mem::take(&mut self.hasher);
        for number in [self.end, tick, digest] {
            hasher.update(&number.to_le_bytes());
        }
        self.end = hasher.digest();
        self.tick = Some(tick);
        StateDigest { tick, digest, chain: self.end }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the definition of the chain: its end depends on everything before, and on nothing
    /// else.
    #[test]
    fn the_end_depends_on_everything_before() {
        let end = |scene: &str, commands: &[(&str, &[u8])], digests: [u64; 2]| {
            let mut chain = Chain::new(scene);
            commands.iter().for_each(|(topic, cdr)| chain.command(topic, cdr));
            chain.link(1, digests[0]);
            chain.link(2, digests[1]).chain
        };
        let commands: [(&str, &[u8]); 2] = [("a", b"x"), ("b", b"y")];
        let expected = end("scene", &commands, [5, 6]);
        assert_eq!(end("scene", &commands, [5, 6]), expected);
        let reversed: [(&str, &[u8]); 2] = [("b", b"y"), ("a", b"x")];
        let merged: [(&str, &[u8]); 1] = [("a", b"xby")];
        assert_ne!(end("other", &commands, [5, 6]), expected);
        assert_ne!(end("scene", &reversed, [5, 6]), expected);
        assert_ne!(end("scene", &merged, [5, 6]), expected);
        assert_ne!(end("scene", &commands, [4, 6]), expected);
        assert_ne!(end("scene", &commands, [5, 7]), expected);
    }
}
