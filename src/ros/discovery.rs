//! The discovery range of ROS 2: this host only, unless configured otherwise.
//!
//! The first matching row wins. The rules differ from those of a stock ROS 2 node in one point: by
//! default the node stays on this host instead of announcing itself to the whole network.
//!
//! | setting                                                    | range                              |
//! | ---------------------------------------------------------- | ---------------------------------- |
//! | `ROS_AUTOMATIC_DISCOVERY_RANGE=OFF`                        | none: the run does not use ROS 2   |
//! | `ROS_LOCALHOST_ONLY=1`                                     | this host                          |
//! | `ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`                  | this host                          |
//! | `ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET`                     | the local network                  |
//! | scene key `outputs.ros.lan: true`                          | the local network                  |
//! | unset, or `ROS_AUTOMATIC_DISCOVERY_RANGE=SYSTEM_DEFAULT`   | this host                          |
//!
//! The domain ID comes from the scene, else from `ROS_DOMAIN_ID`, else it is 0.

use crate::scene::Ros;

/// The largest domain ID; above it, the UDP ports of DDS do not exist.
const DOMAIN_MAX: u16 = 232;

/// The ROS 2 domain and how far discovery reaches in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DiscoveryRange {
    /// ID of the domain. Nodes only see nodes of the same domain.
    pub domain_id: u16,
    /// How far discovery reaches.
    pub extent: DiscoveryExtent,
}

/// How far discovery reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiscoveryExtent {
    /// No discovery: ROS 2 is not used.
    Off,
    /// Processes on this host.
    Host,
    /// The local network, by multicast on every interface.
    Lan,
}

/// A setting of the environment or the scene is invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DiscoveryRangeError {
    /// The domain ID is not a number, or too large.
    #[error(
        "ROS 2 domain ID `{given}` ({place}) is not an integer from 0 to {DOMAIN_MAX}: use one"
    )]
    Domain {
        /// Where the value was set.
        place: &'static str,
        /// The value.
        given: String,
    },
    /// The discovery range is not one of ROS 2.
    #[error(
        "ROS_AUTOMATIC_DISCOVERY_RANGE is `{given}`: use OFF, LOCALHOST, SUBNET or SYSTEM_DEFAULT"
    )]
    Range {
        /// The value.
        given: String,
    },
}

impl DiscoveryRange {
    /// Chooses the range from the scene and the environment; `variable` looks up an environment
    /// variable.
    ///
    /// # Errors
    /// If a domain ID or a discovery range is invalid.
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
        variables: &[(&str, &str)],
    ) -> Result<DiscoveryRange, String> {
        let scene = Ros { enabled: true, domain_id, lan, ..Ros::OFF };
        let variable = |name: &str| {
            variables.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned())
        };
        DiscoveryRange::choose(&scene, variable).map_err(|it| it.to_string())
    }

    /// Oracle: the table in the module docs.
    #[test]
    fn the_range_follows_the_table() {
        const RANGE: &str = "ROS_AUTOMATIC_DISCOVERY_RANGE";
        const ONLY: &str = "ROS_LOCALHOST_ONLY";
        for (lan, variables, extent) in [
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
            assert_eq!(
                choose(lan, None, &variables).unwrap().extent,
                extent,
                "lan {lan}, {variables:?}"
            );
        }
    }

    /// Oracle: the documented order of precedence: scene, environment, 0.
    #[test]
    fn the_scene_takes_precedence_over_the_environment() {
        let variables = [("ROS_DOMAIN_ID", " 7")];
        assert_eq!(choose(false, Some(3), &variables).unwrap().domain_id, 3);
        assert_eq!(choose(false, None, &variables).unwrap().domain_id, 7);
        assert_eq!(choose(false, None, &[]).unwrap().domain_id, 0);
    }

    /// Oracle: the rule that an error names place, value, limit and remedy.
    #[test]
    fn invalid_settings_are_rejected() {
        for given in ["233", "-1", "eight"] {
            let error = choose(false, None, &[("ROS_DOMAIN_ID", given)]).unwrap_err();
            assert!(error.contains(given) && error.contains("232"), "{error}");
        }
        let error =
            choose(false, None, &[("ROS_AUTOMATIC_DISCOVERY_RANGE", "subnet")]).unwrap_err();
        assert!(error.contains("`subnet`") && error.contains("SUBNET"), "{error}");
    }
}
