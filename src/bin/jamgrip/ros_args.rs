//! Arguments of ROS 2 tools: `--ros-args … [--]`.
//!
//! Parameters are keys of the scene. Parameter files may hold them nested or with dots, under the
//! name of the node or under `/**`. `use_sim_time: false`, which launch systems set on every node,
//! is ignored.

use jamgrip::scene::{Ros, ros_parameters};

/// The parsed arguments.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct RosArgs {
    /// Name of the node, without namespace.
    pub(crate) node: Option<String>,
    /// Namespace of the node.
    pub(crate) namespace: Option<String>,
    /// Remapped names: from and to.
    pub(crate) remaps: Vec<(String, String)>,
    /// Parameters, as `key=value`.
    pub(crate) parameters: Vec<String>,
    /// Parameter files.
    pub(crate) parameter_files: Vec<String>,
    /// Log level, such as `debug`.
    pub(crate) log_level: Option<String>,
}

/// Why the arguments are invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum RosArgsError {
    /// An option without its value.
    #[error("--ros-args: {option} needs a value")]
    Incomplete {
        /// The option.
        option: String,
    },
    /// The value does not have the form of the option.
    #[error("--ros-args {option} {given}: write {form}")]
    Malformed {
        /// The option.
        option: String,
        /// The value.
        given: String,
        /// The form.
        form: &'static str,
    },
    /// The option is unknown.
    #[error("--ros-args: unknown option {option}: use -r, -p, --params-file or --log-level")]
    Unknown {
        /// The option.
        option: String,
    },
    /// A parameter file is unusable.
    #[error("--ros-args --params-file {file}: {reason}")]
    File {
        /// The file.
        file: String,
        /// What is wrong.
        reason: String,
    },
}

const LEVELS: [&str; 5] = ["debug", "info", "warn", "error", "fatal"];

/// Splits a command line into the arguments of the program and those of ROS 2.
///
/// # Errors
/// If the ROS 2 arguments are invalid.
pub(crate) fn split(
    line: impl Iterator<Item = String>,
) -> Result<(Vec<String>, RosArgs), RosArgsError> {
    let (mut rest, mut found) = (Vec::new(), RosArgs::default());
    let mut line = line;
    while let Some(word) = line.next() {
        if word != "--ros-args" {
            rest.push(word);
            continue;
        }
        while let Some(option) = line.next() {
            if option == "--" {
                break;
            }
            found.take(option, &mut line)?;
        }
    }
    Ok((rest, found))
}

impl RosArgs {
    fn take(
        &mut self,
        option: String,
        line: &mut impl Iterator<Item = String>,
    ) -> Result<(), RosArgsError> {
        // These logging options have no value and no effect here.
        const SWITCHES: [&str; 3] = ["stdout-logs", "rosout-logs", "external-lib-logs"];
        let is_switch = |it: &str| SWITCHES.iter().any(|name| it.ends_with(name));
        if is_switch(option.trim_start_matches("--enable-").trim_start_matches("--disable-")) {
            return Ok(());
        }
        let known = ["-r", "--remap", "-p", "--param", "--params-file", "--log-level"];
        if !known.contains(&option.as_str()) {
            return Err(RosArgsError::Unknown { option });
        }
        let incomplete = || RosArgsError::Incomplete { option: option.clone() };
        let given = line.next().ok_or_else(incomplete)?;
        let malformed =
            |form| RosArgsError::Malformed { option: option.clone(), given: given.clone(), form };
        match option.as_str() {
            "-r" | "--remap" => {
                let (from, to) = given.split_once(":=").ok_or_else(|| malformed("from:=to"))?;
                // A rule may be prefixed with a node name; there is one node.
                let from = from.rsplit_once(':').map_or(from, |(_, name)| name);
                match from {
                    "__node" | "__name" => self.node = Some(to.to_owned()),
                    "__ns" => self.namespace = Some(to.to_owned()),
                    _ => self.remaps.push((from.to_owned(), to.to_owned())),
                }
            }
            "-p" | "--param" => {
                let (key, value) = given.split_once(":=").ok_or_else(|| malformed("key:=value"))?;
                let key = key.rsplit_once(':').map_or(key, |(_, name)| name);
                self.add(key, value);
            }
            "--params-file" => self.parameter_files.push(given),
            _ => {
                let level = given.rsplit_once(":=").map_or(given.as_str(), |(_, level)| level);
                let level = level.to_lowercase();
                if !LEVELS.contains(&level.as_str()) {
                    return Err(malformed("debug, info, warn, error or fatal"));
                }
                self.log_level = Some(level);
            }
        }
        Ok(())
    }

    fn add(&mut self, key: &str, value: &str) {
        if (key, value) != ("use_sim_time", "false") {
            self.parameters.push(format!("{key}={value}"));
        }
    }

    /// All parameters as overrides of a scene: files first, then the command line.
    ///
    /// # Errors
    /// If a file is unusable.
    pub(crate) fn overrides(&self) -> Result<Vec<String>, RosArgsError> {
        let full = self.full_name("/jamgrip");
        let mut all = Self::default();
        for file in &self.parameter_files {
            let error = |reason: String| RosArgsError::File { file: file.clone(), reason };
            let text = std::fs::read_to_string(file).map_err(|it| error(it.to_string()))?;
            let found = ros_parameters::of_node(&text, file, &full).map_err(error)?;
            found.iter().for_each(|(key, value)| all.add(key, value));
        }
        all.parameters.extend(self.parameters.iter().cloned());
        Ok(all.parameters)
    }

    /// The full name of the node, which is `default` if not renamed.
    pub(crate) fn full_name(&self, default: &str) -> String {
        let (namespace, name) = default.rsplit_once('/').unwrap_or(("", default));
        let namespace = self.namespace.as_deref().unwrap_or(namespace).trim_matches('/');
        let name = self.node.as_deref().unwrap_or(name);
        if namespace.is_empty() { format!("/{name}") } else { format!("/{namespace}/{name}") }
    }

    /// Applies the names to the ROS 2 settings of a scene.
    pub(crate) fn rename(&self, ros: &mut Ros) {
        ros.node = self.full_name(&ros.node);
        ros.remaps.extend(self.remaps.iter().cloned());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(line: &str) -> Result<(Vec<String>, RosArgs), RosArgsError> {
        split(line.split_whitespace().map(str::to_owned))
    }

    /// Oracle: the rules of ROS 2 for command lines.
    #[test]
    fn ros_arguments_are_split_off() {
        let line = "jamgrip run s.yaml --ros-args -r __ns:=/left -r __node:=grip -r ~/wrench:=/ft \
                    -p seed:=7 -p use_sim_time:=false --log-level rcl:=DEBUG -- --json";
        let (rest, args) = of(line).unwrap();
        assert_eq!(rest, ["jamgrip", "run", "s.yaml", "--json"]);
        assert_eq!(args.full_name("/jamgrip"), "/left/grip");
        assert_eq!(args.remaps, [("~/wrench".to_owned(), "/ft".to_owned())]);
        assert_eq!(args.overrides().unwrap(), ["seed=7"]);
        assert_eq!(args.log_level.as_deref(), Some("debug"));
        let (rest, args) = of("jamgrip check s.yaml").unwrap();
        assert_eq!((rest.len(), args), (3, RosArgs::default()));
    }

    /// Oracle: the rule that every error names the location, the value and the remedy.
    #[test]
    fn invalid_arguments_are_rejected() {
        for line in ["-r", "-r a=b", "-p seed=7", "--log-level loud", "--what x", "-p"] {
            let error = of(&format!("jamgrip --ros-args {line}")).unwrap_err().to_string();
            assert!(error.contains(line.split(' ').next().unwrap()), "{line}: {error}");
        }
    }

    /// Oracle: the keys and values written; the command line comes after the files.
    #[test]
    fn parameter_files_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("p.yaml");
        let text = "/**:\n  ros__parameters:\n    seed: 3\n    chamber: { lag: 20 ms }\n\
                    jamgrip:\n  ros__parameters:\n    chamber.lag: 30 ms\n    use_sim_time: false\n\
                    /other:\n  ros__parameters: { seed: 9 }\n";
        std::fs::write(&file, text).unwrap();
        let line = format!("jamgrip --ros-args --params-file {} -p seed:=4", file.display());
        let (_, args) = of(&line).unwrap();
        let expected = ["seed=3", "chamber.lag=20 ms", "chamber.lag=30 ms", "seed=4"];
        assert_eq!(args.overrides().unwrap(), expected);
        std::fs::write(&file, "jamgrip: 3\n").unwrap();
        assert!(args.overrides().unwrap_err().to_string().contains("ros__parameters"));
    }
}
