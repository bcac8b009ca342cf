//! ROS 2 parameters: listing, describing, reading and setting them.
//!
//! Parameters of the materials and the pump and the rates of topics can be changed while the
//! simulation runs; changes take effect with the next tick and survive resets. The other parameters
//! are read-only. Changes are published on `/parameter_events`.

use std::sync::Arc;

use super::{Simulator, World, entities::stamp, services::parameter_events};
use crate::{
    command::change::{Change, TunableParameter},
    io::server::Outgoing,
    scene::{Outputs, Scene},
    wire::{
        cdr::Cdr,
        messages::rcl_interfaces::{
            DescribeParametersRequest, DescribeParametersResponse, FloatingPointRange,
            GetParameterTypesRequest, GetParameterTypesResponse, GetParametersRequest,
            GetParametersResponse, ListParametersRequest, ListParametersResponse,
            ListParametersResult, Parameter, ParameterDescriptor, ParameterEvent, ParameterType,
            ParameterValue, SetParametersAtomicallyRequest, SetParametersAtomicallyResponse,
            SetParametersRequest, SetParametersResponse, SetParametersResult,
        },
    },
};

/// How a parameter is read and set.
enum Kind {
    /// A number of the model that can be changed.
    Tunable(TunableParameter),
    /// A rate of topics (Hz), which can be changed.
    Rate(fn(&mut Outputs) -> &mut f64),
    /// A read-only value.
    ReadOnly(fn(&Scene) -> ParameterValue),
}

/// Lowest rate of a topic (Hz).
const RATE_MIN: f64 = 1e-3;

/// A valid change of a parameter.
#[derive(Clone, Copy)]
enum Setting {
    Tunable(TunableParameter),
    Rate(fn(&mut Outputs) -> &mut f64),
}

/// Name, kind, and description with unit.
type Row = (&'static str, Kind, &'static str);

const PARAMETERS: [Row; 16] = [
    (
        "chamber.lag",
        Kind::Tunable(TunableParameter::ChamberLag),
        "time constant of pump and line [s]",
    ),
    (
        "chamber.rate_max",
        Kind::Tunable(TunableParameter::ChamberRateMax),
        "largest rate of the pressure [Pa/s]",
    ),
    (
        "grains.dissipation_time",
        Kind::Tunable(TunableParameter::GrainDissipationTime),
        "dissipation time of contacts between grains, which determines their restitution [s]",
    ),
    (
        "grains.friction",
        Kind::Tunable(TunableParameter::GrainFriction),
        "friction between grains [-]",
    ),
    (
        "membrane.friction",
        Kind::Tunable(TunableParameter::MembraneFriction),
        "friction of grains on the membrane [-]",
    ),
    (
        "object.friction",
        Kind::Tunable(TunableParameter::ObjectFriction),
        "friction of all objects on the membrane [-]",
    ),
    ("outputs.contacts_rate", Kind::Rate(|it| &mut it.contacts_rate), "rate of contacts [Hz]"),
    ("outputs.grains_rate", Kind::Rate(|it| &mut it.grains_rate), "rate of grains [Hz]"),
    ("outputs.membrane_rate", Kind::Rate(|it| &mut it.membrane_rate), "rate of the membrane [Hz]"),
    ("outputs.pressure_rate", Kind::Rate(|it| &mut it.pressure_rate), "rate of the pressure [Hz]"),
    ("outputs.state_rate", Kind::Rate(|it| &mut it.state_rate), "rate of poses and wrenches [Hz]"),
    (
        "outputs.statistics_rate",
        Kind::Rate(|it| &mut it.statistics_rate),
        "rate of statistics [Hz]",
    ),
    ("scene", Kind::ReadOnly(|it| text(&it.name)), "name of the scene"),
    ("seed", Kind::ReadOnly(|it| integer(it.seed)), "seed of all random numbers"),
    ("time.tick", Kind::ReadOnly(|it| double(tick_s(it))), "length of a tick [s]"),
    (
        "use_sim_time",
        Kind::ReadOnly(|_| boolean(false)),
        "false: the simulator itself is the source of time",
    ),
];

fn tick_s(scene: &Scene) -> f64 {
    std::time::Duration::from_nanos(scene.time.tick_ns).as_secs_f64()
}

fn double(value: f64) -> ParameterValue {
    let r#type = ParameterType::PARAMETER_DOUBLE;
    ParameterValue { r#type, double_value: value, ..Default::default() }
}

fn integer(value: u64) -> ParameterValue {
    let integer_value = i64::try_from(value).unwrap_or(i64::MAX);
    let r#type = ParameterType::PARAMETER_INTEGER;
    ParameterValue { r#type, integer_value, ..Default::default() }
}

fn text(value: &str) -> ParameterValue {
    let r#type = ParameterType::PARAMETER_STRING;
    ParameterValue { r#type, string_value: value.to_owned(), ..Default::default() }
}

fn boolean(value: bool) -> ParameterValue {
    let r#type = ParameterType::PARAMETER_BOOL;
    ParameterValue { r#type, bool_value: value, ..Default::default() }
}

fn find(name: &str) -> Option<&'static Row> {
    PARAMETERS.iter().find(|it| it.0 == name)
}

impl Simulator {
    fn value(&self, row: &Row) -> ParameterValue {
        match &row.1 {
            Kind::Tunable(parameter) => double(parameter.get(&self.scene)),
            Kind::Rate(rate) => double(*rate(&mut self.scene.outputs.clone())),
            Kind::ReadOnly(read) => read(&self.scene),
        }
    }

    /// Smallest and largest value of a parameter that can be changed.
    fn range(&self, kind: &Kind) -> Option<[f64; 2]> {
        match kind {
            Kind::Tunable(parameter) => Some(parameter.range()),
            Kind::Rate(_) => Some([RATE_MIN, 1.0 / tick_s(&self.scene)]),
            Kind::ReadOnly(_) => None,
        }
    }

    pub(super) fn get_parameters(&self, request: &GetParametersRequest) -> GetParametersResponse {
        let value = |name: &String| find(name).map(|row| self.value(row)).unwrap_or_default();
        GetParametersResponse { values: request.names.iter().map(value).collect() }
    }

    pub(super) fn get_parameter_types(
        &self,
        request: &GetParameterTypesRequest,
    ) -> GetParameterTypesResponse {
        let r#type = |name: &String| find(name).map_or(0, |row| self.value(row).r#type);
        GetParameterTypesResponse { types: request.names.iter().map(r#type).collect() }
    }

    pub(super) fn describe_parameters(
        &self,
        request: &DescribeParametersRequest,
    ) -> DescribeParametersResponse {
        let describe = |name: &String| {
            let Some(row) = find(name) else {
                return ParameterDescriptor { name: name.clone(), ..Default::default() };
            };
            let range = self.range(&row.1).map(|[from_value, to_value]| FloatingPointRange {
                from_value,
                to_value,
                step: 0.0,
            });
            ParameterDescriptor {
                name: name.clone(),
                r#type: self.value(row).r#type,
                description: row.2.to_owned(),
                read_only: matches!(row.1, Kind::ReadOnly(_)),
                floating_point_range: range.into_iter().collect(),
                ..Default::default()
            }
        };
        DescribeParametersResponse { descriptors: request.names.iter().map(describe).collect() }
    }

    /// Names with any of the prefixes, at most `depth` levels deep; 0 means any depth.
    pub(super) fn list_parameters(
        &self,
        request: &ListParametersRequest,
    ) -> ListParametersResponse {
        let depth = usize::try_from(request.depth).unwrap_or(usize::MAX);
        let is_within_depth = |rest: &str| depth == 0 || rest.split('.').count() <= depth;
        let is_selected = |name: &str| {
            let below = |prefix: &String| {
                let rest = name.strip_prefix(prefix.as_str())?;
                if rest.is_empty() { Some(rest) } else { rest.strip_prefix('.') }
            };
            match request.prefixes.as_slice() {
                [] => is_within_depth(name),
                prefixes => prefixes.iter().filter_map(below).any(is_within_depth),
            }
        };
        let names = PARAMETERS.iter().map(|it| it.0).filter(|name| is_selected(name));
        let names: Vec<String> = names.map(str::to_owned).collect();
        let sections = names.iter().filter_map(|it| it.rsplit_once('.').map(|(above, _)| above));
        let mut prefixes: Vec<String> = sections.map(str::to_owned).collect();
        prefixes.dedup();
        ListParametersResponse { result: ListParametersResult { names, prefixes } }
    }

    pub(super) fn set_parameters(
        &mut self,
        request: &SetParametersRequest,
        world: &mut World<'_>,
    ) -> SetParametersResponse {
        let mut results = Vec::with_capacity(request.parameters.len());
        let mut changed = Vec::new();
        for parameter in &request.parameters {
            let set = self.check(parameter).and_then(|it| self.set(it, parameter, world));
            if set.is_ok() {
                changed.push(parameter.clone());
            }
            results.push(result_of(set));
        }
        self.publish_changes(changed, world);
        SetParametersResponse { results }
    }

    pub(super) fn set_parameters_atomically(
        &mut self,
        request: &SetParametersAtomicallyRequest,
        world: &mut World<'_>,
    ) -> SetParametersAtomicallyResponse {
        let parameters = &request.parameters;
        let checked: Result<Vec<Setting>, String> =
            parameters.iter().map(|it| self.check(it)).collect();
        // After the check, setting can fail only if the world does not support changes.
        let set = checked.and_then(|all| {
            all.into_iter()
                .zip(parameters)
                .try_for_each(|(it, parameter)| self.set(it, parameter, world))
        });
        if set.is_ok() {
            self.publish_changes(parameters.clone(), world);
        }
        SetParametersAtomicallyResponse { result: result_of(set) }
    }

    fn check(&self, parameter: &Parameter) -> Result<Setting, String> {
        let name = &parameter.name;
        let row = find(name).ok_or_else(|| format!("there is no parameter `{name}`"))?;
        let setting = match row.1 {
            Kind::Tunable(parameter) => Setting::Tunable(parameter),
            Kind::Rate(rate) => Setting::Rate(rate),
            Kind::ReadOnly(_) => {
                return Err(format!("`{name}` is read-only: change it in the scene and restart"));
            }
        };
        let value = match parameter.value.r#type {
            ParameterType::PARAMETER_DOUBLE => parameter.value.double_value,
            kind => return Err(format!("`{name}` must be a double (type 3), not type {kind}")),
        };
        match self.range(&row.1) {
            Some([min, max]) if !(min..=max).contains(&value) => {
                Err(format!("`{name}` is {value}: {} must be between {min} and {max}", row.2))
            }
            _ => Ok(setting),
        }
    }

    /// Applies a valid change.
    fn set(
        &mut self,
        setting: Setting,
        parameter: &Parameter,
        world: &mut World<'_>,
    ) -> Result<(), String> {
        let value = parameter.value.double_value;
        match setting {
            Setting::Tunable(parameter) => {
                let change = Change::SetParameter { parameter, value };
                self.change(&change, world).map_err(|error| error.to_string())?;
                parameter.set(Arc::make_mut(&mut self.scene), value);
            }
            Setting::Rate(rate) => {
                *rate(&mut Arc::make_mut(&mut self.scene).outputs) = value;
            }
        }
        Ok(())
    }

    /// Publishes changed parameters on `/parameter_events`.
    fn publish_changes(&mut self, changed_parameters: Vec<Parameter>, world: &World<'_>) {
        if changed_parameters.is_empty() {
            return;
        }
        let event = ParameterEvent {
            stamp: stamp(world.snapshot.time_ns),
            node: self.scene.outputs.ros.node.clone(),
            changed_parameters,
            ..ParameterEvent::default()
        };
        if let Some(topic) = parameter_events(self.goals.n_topics) {
            self.outgoing.push(Outgoing::Message(topic, Cdr::of(&event)));
        }
    }
}

fn result_of(set: Result<(), String>) -> SetParametersResult {
    match set {
        Ok(()) => SetParametersResult { successful: true, reason: String::new() },
        Err(reason) => SetParametersResult { successful: false, reason },
    }
}
