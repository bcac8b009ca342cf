//! The checked-in message types match the message files in `msgs/`, as parsed by `roslibrust_codegen`.
//!
//! After a change of a .msg file: `JAMGRIP_UPDATE=1 cargo test --release generated_types`.

use std::{
    collections::BTreeMap,
    fmt::Write,
    fs,
    path::{Path, PathBuf},
};

use roslibrust_codegen::{ArrayType, ConstantInfo, FieldInfo, MessageFile};

const GENERATED: &str = "src/wire/messages/generated.rs";
const SEPARATOR: &str =
    "================================================================================";

/// Hashes that the library computes incorrectly, because it treats `byte` as a nested type. These values
/// are from the type store of PyPI's `rosbags`; `peers.rs` compares all hashes with it.
const HASHES_OF_TYPES_WITH_BYTE: [(&str, &str); 5] = [
    (
        "diagnostic_msgs/DiagnosticArray",
        "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e",
    ),
    (
        "diagnostic_msgs/DiagnosticStatus",
        "RIHS01_b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4",
    ),
    (
        "rcl_interfaces/Parameter",
        "RIHS01_ddfe6442cffc462317adb5c92536a7b6dd55858c5c3e1e328165a6b73c2831af",
    ),
    (
        "rcl_interfaces/ParameterEvent",
        "RIHS01_043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204",
    ),
    (
        "rcl_interfaces/ParameterValue",
        "RIHS01_115fc089a387e23c7ecd3525c9189c379109119d6ab82e8dfbde0fdf6a7f9b68",
    ),
];

type Messages = BTreeMap<String, MessageFile>;

#[test]
fn checked_in_types_match_the_message_files() {
    let expected = source(&messages());
    if std::env::var_os("JAMGRIP_UPDATE").is_some() {
        fs::write(GENERATED, &expected).unwrap();
    }
    let found = fs::read_to_string(GENERATED).unwrap();
    // Oracle: the newly generated types.
    assert!(
        found == expected,
        "{GENERATED} does not match msgs/; \
         run `JAMGRIP_UPDATE=1 cargo test --release generated_types` and review the difference"
    );
}

/// All messages of `msgs/`, by `package/Type`.
///
/// The library expects one folder with a package.xml per package, so the files are copied into such folders.
fn messages() -> Messages {
    let staging = tempfile::tempdir().unwrap();
    stage(Path::new("msgs/msg"), "jamgrip_msgs", staging.path());
    for package in packages("msgs/standard").iter().chain(&packages("msgs/interfaces")) {
        let name = package.file_name().unwrap().to_str().unwrap();
        stage(&package.join("msg"), name, staging.path());
        for (kind, extension) in [("srv", "srv"), ("action", "action")] {
            for file in files(&package.join(kind)) {
                assert_eq!(file.extension().unwrap(), extension);
                stage_parts(&file, &staging.path().join(name).join("msg"));
            }
        }
    }
    let folders = [staging.path().to_path_buf()];
    let (parsed, _, _) = roslibrust_codegen::find_and_parse_ros_messages(&folders).unwrap();
    let ours: Vec<String> = parsed.iter().map(|it| it.get_full_name()).collect();
    let (resolved, _) = roslibrust_codegen::resolve_dependency_graph(parsed, Vec::new()).unwrap();
    let all = resolved.into_iter().map(|it| (it.get_full_name(), it));
    all.filter(|(name, _)| ours.contains(name)).collect()
}

/// The folders in `folder`, sorted.
fn packages(folder: &str) -> Vec<PathBuf> {
    files(Path::new(folder)).into_iter().filter(|it| it.is_dir()).collect()
}

/// The entries of `folder`, sorted; none if it does not exist.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// Names of the parts of a service or an action.
fn parts(file: &Path) -> &'static [&'static str] {
    if file.extension().unwrap() == "srv" {
        &["Request", "Response"]
    } else {
        &["Goal", "Result", "Feedback"]
    }
}

/// Stages each part of a service or an action as a separate message. ROS 2 adds one byte to parts
/// without fields.
fn stage_parts(file: &Path, messages: &Path) {
    let text = fs::read_to_string(file).unwrap();
    let stem = file.file_stem().unwrap().to_str().unwrap();
    let mut parts_text: Vec<String> = vec![String::new()];
    for line in text.lines() {
        if line.trim() == "---" {
            parts_text.push(String::new());
        } else {
            let last = parts_text.last_mut().unwrap();
            writeln!(last, "{line}").unwrap();
        }
    }
    assert_eq!(parts_text.len(), parts(file).len(), "{}", file.display());
    for (part, mut text) in parts(file).iter().zip(parts_text) {
        if text.trim().is_empty() {
            text = "uint8 structure_needs_at_least_one_member\n".to_owned();
        }
        fs::write(messages.join(format!("{stem}{part}.msg")), text).unwrap();
    }
}

fn stage(messages: &Path, package: &str, staging: &Path) {
    let folder = staging.join(package);
    fs::create_dir_all(folder.join("msg")).unwrap();
    let xml = format!(
        "<package format=\"3\"><name>{package}</name>\
         <buildtool_depend>ament_cmake</buildtool_depend></package>"
    );
    fs::write(folder.join("package.xml"), xml).unwrap();
    for file in files(messages) {
        fs::copy(&file, folder.join("msg").join(file.file_name().unwrap())).unwrap();
    }
}

/// The generated file.
fn source(messages: &Messages) -> String {
    let mut out = String::from(
        "//! ROS 2 message types: generated from `msgs/`, never edited by hand.\n\
         //!\n\
         //! `tests/it/generated_types.rs` writes this file and tests that it is up to date.\n",
    );
    let mut packages: Vec<String> = messages.values().map(|it| it.get_package_name()).collect();
    packages.dedup();
    for package in packages {
        writeln!(out, "\n/// Messages of `{package}`.\npub mod {package} {{").unwrap();
        let folder = Path::new("msgs/interfaces").join(&package);
        let (services, actions) = (files(&folder.join("srv")), files(&folder.join("action")));
        let is_part = |name: &str| {
            services.iter().chain(&actions).any(|file| {
                let stem = file.file_stem().unwrap().to_str().unwrap();
                parts(file).iter().any(|part| name == format!("{stem}{part}"))
            })
        };
        let all: Vec<_> = messages.values().filter(|it| it.get_package_name() == package).collect();
        if all.iter().any(|it| !is_part(&it.get_short_name())) {
            out.push_str("    use crate::wire::messages::{MessageType, RosMessage};\n");
        }
        for message in all {
            out.push_str(&structure(message));
            if !is_part(&message.get_short_name()) {
                out.push_str(&description(message, messages));
            }
        }
        out.push_str(&services_module(&package, &services));
        out.push_str(&actions_module(&package, &actions));
        out.push_str("}\n");
    }
    out
}

/// Module `srv`: one empty type per service, which names its request and response.
fn services_module(package: &str, services: &[PathBuf]) -> String {
    let mut out = String::new();
    if services.is_empty() {
        return out;
    }
    writeln!(out, "\n    /// Services of `{package}`.\n    pub mod srv {{").unwrap();
    out.push_str("        use crate::wire::messages::{RosService, ServiceType};\n");
    for file in services {
        let name = file.file_stem().unwrap().to_str().unwrap();
        write!(
            out,
            "
        /// `{package}/srv/{name}`.
        #[derive(Clone, Copy, Debug)]
        pub struct {name};

        impl RosService for {name} {{
            type Request = super::{name}Request;
            type Response = super::{name}Response;
            const TYPE: ServiceType = ServiceType {{
                name: \"{package}/srv/{name}\",
                request_dds_name: \"{package}::srv::dds_::{name}_Request_\",
                response_dds_name: \"{package}::srv::dds_::{name}_Response_\",
            }};
        }}
"
        )
        .unwrap();
    }
    out.push_str("    }\n");
    out
}

/// Module `action`: one empty type per action, which names its parts.
fn actions_module(package: &str, actions: &[PathBuf]) -> String {
    let mut out = String::new();
    if actions.is_empty() {
        return out;
    }
    writeln!(out, "\n    /// Actions of `{package}`.\n    pub mod action {{").unwrap();
    out.push_str("        use crate::wire::messages::{ActionType, RosAction, ServiceType};\n");
    for file in actions {
        let name = file.file_stem().unwrap().to_str().unwrap();
        write!(
            out,
            "
        /// `{package}/action/{name}`.
        #[derive(Clone, Copy, Debug)]
        pub struct {name};

        impl RosAction for {name} {{
            type Goal = super::{name}Goal;
            type Result = super::{name}Result;
            type Feedback = super::{name}Feedback;
            const TYPE: ActionType = ActionType {{
                name: \"{package}/action/{name}\",
                send_goal: ServiceType {{
                    name: \"{package}/action/{name}_SendGoal\",
                    request_dds_name: \"{package}::action::dds_::{name}_SendGoal_Request_\",
                    response_dds_name: \"{package}::action::dds_::{name}_SendGoal_Response_\",
                }},
                get_result: ServiceType {{
                    name: \"{package}/action/{name}_GetResult\",
                    request_dds_name: \"{package}::action::dds_::{name}_GetResult_Request_\",
                    response_dds_name: \"{package}::action::dds_::{name}_GetResult_Response_\",
                }},
                feedback_dds_name: \"{package}::action::dds_::{name}_FeedbackMessage_\",
            }};
        }}
"
        )
        .unwrap();
    }
    out.push_str("    }\n");
    out
}

/// The struct of a message and its constants.
fn structure(message: &MessageFile) -> String {
    let name = message.get_short_name();
    let comments = Comments::of(&message.parsed.source);
    let mut out = String::from("\n");
    comments.head.iter().for_each(|line| doc(&mut out, 1, line));
    if comments.head.is_empty() {
        doc(&mut out, 1, &format!("`{}/msg/{name}`.", message.get_package_name()));
    }
    out.push_str(
        "    #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]\n",
    );
    writeln!(out, "    pub struct {name} {{").unwrap();
    for field in message.get_fields() {
        comments.write(&mut out, &field.field_name, &declaration(field));
        if is_bytes(field) {
            out.push_str("        #[serde(with = \"serde_bytes\")]\n");
        }
        writeln!(out, "        pub r#{}: {},", field.field_name, rust_type(field)).unwrap();
    }
    out.push_str("    }\n");
    if !message.get_constants().is_empty() {
        writeln!(out, "\n    impl {name} {{").unwrap();
        for constant in message.get_constants() {
            comments.write(&mut out, &constant.constant_name, &constant_declaration(constant));
            let ConstantInfo { constant_type, constant_name, constant_value } = constant;
            let r#type = rust_primitive(constant_type);
            writeln!(out, "        pub const {constant_name}: {type} = {constant_value};").unwrap();
        }
        out.push_str("    }\n");
    }
    out
}

/// The `impl RosMessage` of a message.
fn description(message: &MessageFile, messages: &Messages) -> String {
    let (package, name) = (message.get_package_name(), message.get_short_name());
    let full_name = message.get_full_name();
    let corrected = HASHES_OF_TYPES_WITH_BYTE.iter().find(|(name, _)| *name == full_name);
    let hash = corrected.map_or(message.ros2_hash.to_hash_string(), |(_, hash)| (*hash).to_owned());
    let definition = definition(message, messages);
    format!(
        "
    impl RosMessage for {name} {{
        const TYPE: MessageType = MessageType {{
            name: \"{package}/msg/{name}\",
            dds_name: \"{package}::msg::dds_::{name}_\",
            type_hash: \"{hash}\",
            definition: r##\"{definition}\"##,
        }};
    }}
"
    )
}

/// Text of a message and of all messages it contains, each once, in order of first use.
fn definition(message: &MessageFile, messages: &Messages) -> String {
    let mut contained: Vec<String> = Vec::new();
    let mut open = vec![message];
    while let Some(next) = open.pop() {
        for field in next.get_fields().iter().filter(|it| it.field_type.package_name.is_some()) {
            let name = field.get_full_type_name();
            if !contained.contains(&name) {
                open.push(&messages[&name]);
                contained.push(name);
            }
        }
    }
    let mut text = message.parsed.source.trim().to_owned() + "\n";
    for name in contained {
        let source = messages[&name].parsed.source.trim();
        write!(text, "{SEPARATOR}\nMSG: {name}\n{source}\n").unwrap();
    }
    text
}

fn rust_type(field: &FieldInfo) -> String {
    let of = &field.field_type;
    let one = match &of.package_name {
        Some(package) if *package == of.source_package => of.field_type.clone(),
        Some(package) => format!("super::{package}::{}", of.field_type),
        None => rust_primitive(&of.field_type).to_owned(),
    };
    match of.array_info {
        ArrayType::NotArray => one,
        ArrayType::FixedLength(length) => format!("[{one}; {length}]"),
        ArrayType::Bounded(_) | ArrayType::Unbounded => format!("Vec<{one}>"),
    }
}

fn rust_primitive(ros: &str) -> &'static str {
    match ros {
        "bool" => "bool",
        "int8" => "i8",
        "uint8" | "byte" | "char" => "u8",
        "int16" => "i16",
        "uint16" => "u16",
        "int32" => "i32",
        "uint32" => "u32",
        "int64" => "i64",
        "uint64" => "u64",
        "float32" => "f32",
        "float64" => "f64",
        "string" => "String",
        other => panic!("no Rust type for `{other}`: add it here"),
    }
}

/// True for lists of bytes, which are serialized as one block.
fn is_bytes(field: &FieldInfo) -> bool {
    rust_type(field) == "Vec<u8>"
}

fn declaration(field: &FieldInfo) -> String {
    let of = &field.field_type;
    match &of.package_name {
        Some(package) => format!("{package}/{of} {}", field.field_name),
        None => format!("{of} {}", field.field_name),
    }
}

fn constant_declaration(constant: &ConstantInfo) -> String {
    format!("{} {}", constant.constant_type, constant.constant_name)
}

fn doc(out: &mut String, depth: usize, line: &str) {
    let indent = "    ".repeat(depth);
    let text = line.replace('[', "\\[").replace(']', "\\]").replace('<', "\\<");
    writeln!(out, "{}", format!("{indent}/// {text}").trim_end()).unwrap();
}

/// The comments of a .msg file: those at the top, and those above each field or constant.
struct Comments {
    head: Vec<String>,
    of: BTreeMap<String, Vec<String>>,
}

impl Comments {
    fn of(source: &str) -> Self {
        let mut head = Vec::new();
        let mut of = BTreeMap::new();
        let mut pending: Vec<String> = Vec::new();
        for line in source.lines().map(str::trim) {
            if let Some(comment) = line.strip_prefix('#') {
                pending.push(comment.trim().to_owned());
            } else if line.is_empty() {
                if !head.is_empty() && !pending.is_empty() {
                    head.push(String::new());
                }
                head.append(&mut pending);
            } else {
                let name = line.split([' ', '=']).nth(1).unwrap_or_default().to_owned();
                of.insert(name, std::mem::take(&mut pending));
            }
        }
        Self { head, of }
    }

    /// Writes the comment of a field or constant, or its declaration if there is none.
    fn write(&self, out: &mut String, name: &str, declaration: &str) {
        match self.of.get(name).filter(|lines| !lines.is_empty()) {
            Some(lines) => lines.iter().for_each(|line| doc(out, 2, line)),
            None => writeln!(out, "        /// `{declaration}`").unwrap(),
        }
    }
}
