//! How far ROS 2 discovery goes: this host only, unless someone asks for more.
//!
//! The rules, first match wins. They differ from a stock ROS 2 node in one point: where nothing
//! is said, the node stays on this host instead of announcing itself to the whole network.
//!
//! | what is said                                            | reach                            |
//! |---------------------------------------------------------|----------------------------------|
//! | `ROS_AUTOMATIC_DISCOVERY_RANGE=OFF`                     | none: the run leaves ROS 2 out   |
//! | `ROS_LOCALHOST_ONLY=1`                                  | this host                        |
//! | `ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`               | this host                        |
//! | `ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET`                  | the local network                |
//! | scene `outputs.ros.lan: true`                           | the local network                |
//! | nothing, or `ROS_AUTOMATIC_DISCOVERY_RANGE=SYSTEM_DEFAULT` | this host                     |
//!
//! The domain is the scene's, else `ROS_DOMAIN_ID`, else 0.

use crate::scene::Ros;

/// The largest domain whose UDP ports exist.
const DOMAIN_MAX: u16 = 232;

/// Who may be found, and under which domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DiscoveryRange {
    /// Domain of the graph; only equal domains see each other.
    pub domain_id: u16,
    /// How far discovery goes.
    pub extent: DiscoveryExtent,
}

/// How far discovery goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiscoveryExtent {
    /// Nowhere: ROS 2 is left out.
    Off,
    /// Processes on this host.
    Host,
    /// The local network, by multicast on every interface.
    Lan,
}

/// The environment says something that is not understood.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DiscoveryRangeError {
    /// A domain that is no number, or too large.
    #[error("ROS 2 domain `{given}` ({place}) is no whole number from 0 to {DOMAIN_MAX}: use one")]
    Domain {
        /// Where it was said.
        place: &'static str,
        /// What was said.
        given: String,
    },
    /// A range that ROS 2 does not know.
    #[error(
        "ROS_AUTOMATIC_DISCOVERY_RANGE is `{given}`: use OFF, LOCALHOST, SUBNET or SYSTEM_DEFAULT"
    )]
    Range {
        /// What was said.
        given: String,
    },
}

impl DiscoveryRange {
    /// What scene and environment ask for; `variable` looks up the environment.
    ///
    /// # Errors
    /// When a domain or a range is not understood.
    pub fn choose(
        scene: &Ros,
        variable: impl Fn(&str) -> Option<String>,
    ) -> Result<Self, DiscoveryRangeError> {
        let variable = |name: &str| variable(name).filter(|it| !it.is_empty());
        let domain_id = match (scene.domain_id, variable("ROS_DOMAIN_ID")) {
            (Some(id), _) => domain("scene `outputs.ros.domain_id`", &id.to_string())?,
            (None, Some(text)) => domain("ROS_DOMAIN_ID", &text)?,
            (None, None) => 0,
        };
        let is_localhost_only = variable("ROS_LOCALHOST_ONLY").as_deref() == Some("1");
        let extent = match variable("ROS_AUTOMATIC_DISCOVERY_RANGE").as_deref() {
            Some("OFF") => DiscoveryExtent::Off,
            _ if is_localhost_only => DiscoveryExtent::Host,
            Some("LOCALHOST") => DiscoveryExtent::Host,
            Some("SUBNET") => DiscoveryExtent::Lan,
            None | Some("SYSTEM_DEFAULT") => {
                if scene.lan {
                    DiscoveryExtent::Lan
                } else {
                    DiscoveryExtent::Host
                }
            }
            Some(given) => return Err(DiscoveryRangeError::Range { given: given.to_owned() }),
        };
        Ok(Self { domain_id, extent })
    }
}

fn domain(place: &'static str, given: &str) -> Result<u16, DiscoveryRangeError> {
    given
        .trim()
        .parse()
        .ok()
        .filter(|id| *id <= DOMAIN_MAX)
        .ok_or_else(|| DiscoveryRangeError::Domain { place, given: given.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn choose(
        lan: bool,
        domain_id: Option<u16>,
        said: &[(&str, &str)],
    ) -> Result<DiscoveryRange, String> {
        let scene = Ros { enabled: true, domain_id, lan, ..Ros::OFF };
        let variable = |name: &str| {
            said.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned())
        };
        DiscoveryRange::choose(&scene, variable).map_err(|it| it.to_string())
    }

    /// Oracle: the table at the head of this file.
    #[test]
    fn the_table_is_the_law() {
        const RANGE: &str = "ROS_AUTOMATIC_DISCOVERY_RANGE";
        const ONLY: &str = "ROS_LOCALHOST_ONLY";
        for (lan, said, extent) in [
            (false, vec![], DiscoveryExtent::Host),
            (true, vec![], DiscoveryExtent::Lan),
            (true, vec![(RANGE, "OFF")], DiscoveryExtent::Off),
            (true, vec![(RANGE, "OFF"), (ONLY, "1")], DiscoveryExtent::Off),
            (true, vec![(ONLY, "1")], DiscoveryExtent::Host),
            (false, vec![(ONLY, "1"), (RANGE, "SUBNET")], DiscoveryExtent::Host),
            (false, vec![(ONLY, "0"), (RANGE, "SUBNET")], DiscoveryExtent::Lan),
            (true, vec![(RANGE, "LOCALHOST")], DiscoveryExtent::Host),
            (false, vec![(RANGE, "SUBNET")], DiscoveryExtent::Lan),
            (false, vec![(RANGE, "SYSTEM_DEFAULT")], DiscoveryExtent::Host),
            (true, vec![(RANGE, "")], DiscoveryExtent::Lan),
        ] {
            assert_eq!(choose(lan, None, &said).unwrap().extent, extent, "lan {lan}, {said:?}");
        }
    }

    /// Oracle: the stated order, scene before environment before 0.
    #[test]
    fn the_scene_chooses_the_domain_before_the_environment() {
        let said = [("ROS_DOMAIN_ID", " 7")];
        assert_eq!(choose(false, Some(3), &said).unwrap().domain_id, 3);
        assert_eq!(choose(false, None, &said).unwrap().domain_id, 7);
        assert_eq!(choose(false, None, &[]).unwrap().domain_id, 0);
    }

    /// Oracle: house rule, an error names place, value, limit and remedy.
    #[test]
    fn what_is_not_understood_is_refused() {
        for given in ["233", "-1", "eight"] {
            let error = choose(false, None, &[("ROS_DOMAIN_ID", given)]).unwrap_err();
            assert!(error.contains(given) && error.contains("232"), "{error}");
        }
        let error =
            choose(false, None, &[("ROS_AUTOMATIC_DISCOVERY_RANGE", "subnet")]).unwrap_err();
        assert!(error.contains("`subnet`") && error.contains("SUBNET"), "{error}");
    }
}
