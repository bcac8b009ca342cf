//! Releases that changed results, from the changelog.

const CHANGELOG: &str = include_str!("../../CHANGELOG.md");

/// Changes of results since `version`, newest first; empty if the changelog lists none.
pub fn changes_since(version: &str) -> Vec<String> {
    changes(CHANGELOG, version)
}

fn changes(changelog: &str, version: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let (mut release, mut is_inside) = ("", false);
    for line in changelog.lines() {
        if let Some(name) = line.strip_prefix("## ") {
            if name.split_whitespace().next() == Some(version) {
                break;
            }
            (release, is_inside) = (name, false);
        } else if let Some(name) = line.strip_prefix("### ") {
            is_inside = name == "Changes results";
        } else if is_inside {
            match (line.strip_prefix("- "), found.last_mut()) {
                (Some(entry), _) => found.push(format!("{release}: {entry}")),
                (None, Some(last)) if !line.trim().is_empty() => {
                    last.push(' ');
                    last.push_str(line.trim());
                }
                _ => {}
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# Changelog\n\n## Unreleased\n\n### Added\n- A flag.\n\n### Changes results\n\
                        - Springs are\n  stiffer.\n\n## 0.2.0\n\n### Changes results\n- Grains roll.\n\
                        - Walls too.\n\n## 0.1.0\n\n### Changes results\n- First.\n";

    /// Oracle: the text, read by hand.
    #[test]
    fn entries_newer_than_a_version_are_returned() {
        let newer =
            ["Unreleased: Springs are stiffer.", "0.2.0: Grains roll.", "0.2.0: Walls too."];
        assert_eq!(changes(TEXT, "0.2.0"), newer[..1]);
        assert_eq!(changes(TEXT, "0.1.0"), newer);
        assert!(changes_since("0.1.0").iter().any(|it| it.contains("critical step")));
    }
}
