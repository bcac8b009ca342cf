//! Output of reference codes, parsed strictly.

use super::{error::ReferenceError, tool::Tool};
use crate::base::Real;

/// One run of a reference code.
#[derive(Clone, Debug)]
pub(super) struct Repetition {
    /// Version that it prints.
    pub(super) version: String,
    /// Time of the measured steps, measured by the code (s).
    pub(super) wall_s: Real,
    /// Contacts before and after them.
    pub(super) n_contacts: [Real; 2],
    /// Kinetic energy at the end, without spins (J).
    pub(super) kinetic_energy: Real,
}

/// Parses the output of a reference code.
pub(super) fn read(tool: Tool, output: &str) -> Result<Repetition, ReferenceError> {
    let peer = tool.name();
    let unreadable = |expected| ReferenceError::Unreadable { peer, expected, tail: tail(output) };
    let loop_of = if tool == Tool::Yade { "JAMGRIP loop " } else { "Loop time of " };
    let number = |text: &str| text.parse::<Real>().ok().filter(|it| it.is_finite());
    // The last one is the measured one.
    let time = output.lines().filter_map(|line| line.strip_prefix(loop_of)).next_back();
    let wall_s = time.and_then(|it| it.split_whitespace().next()).and_then(number);
    let wall_s = wall_s.filter(|it| 0.0 < *it).ok_or_else(|| unreadable("loop time"))?;
    let counts = output.lines().find_map(|line| line.strip_prefix("JAMGRIP contacts "));
    let words: Vec<&str> = counts.unwrap_or_default().split_whitespace().collect();
    let [before, after, "kinetic_energy", energy] = words[..] else {
        return Err(unreadable("JAMGRIP contacts N N kinetic_energy E"));
    };
    let [before, after, energy] = [before, after, energy].map(number);
    let (Some(before), Some(after), Some(kinetic_energy)) = (before, after, energy) else {
        return Err(unreadable("numbers after JAMGRIP contacts"));
    };
    let is_version = |line: &&str| {
        ["LAMMPS (", "LIGGGHTS (", "Welcome to Yade"].iter().any(|it| line.starts_with(it))
    };
    let version = output.lines().find(is_version).unwrap_or("unknown").trim().to_owned();
    Ok(Repetition { version, wall_s, n_contacts: [before, after], kinetic_energy })
}

/// The last lines.
pub(super) fn tail(text: &str) -> String {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    lines[lines.len().saturating_sub(8)..].join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: &str = "LAMMPS (22 Jul 2025 - Update 4)\nLoop time of 0.1 on 1 procs for 100 steps\n\
                        Loop time of 0.5 on 1 procs for 500 steps\n\
                        JAMGRIP contacts 8637 8647 kinetic_energy 5.9e-07\n";

    /// Oracle: the text. The second loop is the measured one.
    #[test]
    fn output_is_parsed() {
        let repetition = read(Tool::LammpsHistory, OUTPUT).unwrap();
        assert_eq!(repetition.version, "LAMMPS (22 Jul 2025 - Update 4)");
        let Repetition { wall_s, n_contacts, kinetic_energy, .. } = repetition;
        let found = format!("{wall_s} {n_contacts:?} {kinetic_energy:e}");
        assert_eq!(found, "0.5 [8637.0, 8647.0] 5.9e-7");
    }

    /// Every missing or damaged line is an error that shows the output.
    #[test]
    fn anything_else_is_rejected() {
        for (from, to) in [
            ("Loop time of", "Lost time of"),
            ("0.5 on", "zero on"),
            ("0.5 on", "-0.5 on"),
            ("JAMGRIP", "JAM"),
            ("8647 ", ""),
            ("8647", "many"),
            ("5.9e-07", "nan"),
        ] {
            let error = read(Tool::LammpsHistory, &OUTPUT.replace(from, to)).unwrap_err();
            assert!(matches!(error, ReferenceError::Unreadable { .. }), "{from} {to}: {error}");
            assert!(error.to_string().contains("LAMMPS (22 Jul"), "{error}");
        }
    }
}
