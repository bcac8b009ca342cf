//! What ROS 2 tools put on a command line: `--ros-args … [--]`.
//!
//! Parameters are keys of the scene; files of parameters may hold them nested or with dots, under the
//! node's name or under `/**`. What a launch system says of every node and the simulator has no
//! use for, `use_sim_time: false`, is passed over.

use jamgrip::scene::{Ros, ros_parameters};

/// What was said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct RosArgs {
    /// The node's name, without namespace.
    pub(crate) node: Option<String>,
    /// The node's namespace.
    pub(crate) namespace: Option<String>,
    /// Names to be replaced, and by what.
    pub(crate) remaps: Vec<(String, String)>,
    /// Parameters, as `key=value`.
    pub(crate) parameters: Vec<String>,
    /// Files of parameters.
    pub(crate) parameter_files: Vec<String>,
    /// Level of the log, such as `debug`.
    pub(crate) log_level: Option<String>,
}

/// Why it makes no sense.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum RosArgsError {
    /// An option without its value.
    #[error("--ros-args: {option} needs a value")]
    Incomplete {
        /// The option.
        option: String,
    },
    /// No rule of the form that the option has.
    #[error("--ros-args {option} {given}: write {form}")]
    Malformed {
        /// The option.
        option: String,
        /// What was given.
        given: String,
        /// How it is written.
        form: &'static str,
    },
    /// An option that there is not.
    #[error("--ros-args: {option} is not known: use -r, -p, --params-file or --log-level")]
    Unknown {
        /// What was given.
        option: String,
    },
    /// A file of parameters that cannot be used.
    #[error("--ros-args --params-file {file}: {reason}")]
    File {
        /// The file.
        file: String,
        /// What is wrong.
        reason: String,
    },
}

const LEVELS: [&str; 5] = ["debug", "info", "warn", "error", "fatal"];

/// Takes what belongs to ROS out of a command line; the rest is for the program.
///
/// # Errors
/// If it makes no sense.
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
        // Some options of logging have no value, and nothing here to switch.
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
                // A rule may name the node that it is for; there is one here.
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

    /// All parameters as changes of a scene: files first, then what stands on the line.
    ///
    /// # Errors
    /// If a file cannot be used.
    pub(crate) fn overrides(&self) -> Result<Vec<String>, RosArgsError> {
        let full = self.full_name("/jamgrip");
        let mut all = Self::default();
        for file in &self.parameter_files {
            let fault = |reason: String| RosArgsError::File { file: file.clone(), reason };
            let text = std::fs::read_to_string(file).map_err(|error| fault(error.to_string()))?;
            let found = ros_parameters::of_node(&text, file, &full).map_err(fault)?;
            found.iter().for_each(|(key, value)| all.add(key, value));
        }
        all.parameters.extend(self.parameters.iter().cloned());
        Ok(all.parameters)
    }

    /// The full name of a node that is called `default` if nothing else is said.
    pub(crate) fn full_name(&self, default: &str) -> String {
        let (namespace, name) = default.rsplit_once('/').unwrap_or(("", default));
        let namespace = self.namespace.as_deref().unwrap_or(namespace).trim_matches('/');
        let name = self.node.as_deref().unwrap_or(name);
        if namespace.is_empty() { format!("/{name}") } else { format!("/{namespace}/{name}") }
    }

    /// Names in a scene's part for ROS.
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
    fn ros_takes_its_part_of_the_line() {
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

    /// Oracle: house rule, an error names place, value and remedy.
    #[test]
    fn nonsense_is_refused() {
        for line in ["-r", "-r a=b", "-p seed=7", "--log-level loud", "--what x", "-p"] {
            let error = of(&format!("jamgrip --ros-args {line}")).unwrap_err().to_string();
            assert!(error.contains(line.split(' ').next().unwrap()), "{line}: {error}");
        }
    }

    /// Oracle: the keys and values written; the line comes after the files.
    #[test]
    fn files_of_parameters_are_read() {
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
