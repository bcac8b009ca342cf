//! Parameters, as ROS 2 tools list, describe, read and set them.
//!
//! Those of the materials and the pump and the rates of topics may be changed while the simulation
//! runs; they act from the next tick on and survive resets. The others are told only. What was changed
//! is told on `/parameter_events`.

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

/// What a parameter is.
enum Kind {
    /// A number of the world that may be changed.
    TunableParameter(TunableParameter),
    /// A rate of topics, which may be changed (Hz).
    Rate(fn(&mut Outputs) -> &mut f64),
    /// Something that is told.
    SimResult(fn(&Scene) -> ParameterValue),
}

/// Slowest rate of a topic (Hz).
const RATE_MIN: f64 = 1e-3;

/// A change that has been checked.
#[derive(Clone, Copy)]
enum Setting {
    TunableParameter(TunableParameter),
    Rate(fn(&mut Outputs) -> &mut f64),
}

/// Name, what it is, description with unit.
type Row = (&'static str, Kind, &'static str);

const PARAMETERS: [Row; 16] = [
    (
        "chamber.lag",
        Kind::TunableParameter(TunableParameter::ChamberLag),
        "time constant of pump and line [s]",
    ),
    (
        "chamber.rate_max",
        Kind::TunableParameter(TunableParameter::ChamberRateMax),
        "largest rate of the pressure [Pa/s]",
    ),
    (
        "grains.dissipation_time",
        Kind::TunableParameter(TunableParameter::GrainDissipationTime),
        "dissipation time of contacts between grains, from which their restitution follows [s]",
    ),
    (
        "grains.friction",
        Kind::TunableParameter(TunableParameter::GrainFriction),
        "friction between grains [-]",
    ),
    (
        "membrane.friction",
        Kind::TunableParameter(TunableParameter::MembraneFriction),
        "friction of grains on the membrane [-]",
    ),
    (
        "object.friction",
        Kind::TunableParameter(TunableParameter::ObjectFriction),
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
    ("scene", Kind::SimResult(|it| text(&it.name)), "name of the scene"),
    ("seed", Kind::SimResult(|it| whole(it.seed)), "seed of all random numbers"),
    ("time.tick", Kind::SimResult(|it| double(tick_s(it))), "length of a tick [s]"),
    ("use_sim_time", Kind::SimResult(|_| flag(false)), "the simulator itself runs on wall time"),
];

fn tick_s(scene: &Scene) -> f64 {
    std::time::Duration::from_nanos(scene.time.tick_ns).as_secs_f64()
}

fn double(value: f64) -> ParameterValue {
    let r#type = ParameterType::PARAMETER_DOUBLE;
    ParameterValue { r#type, double_value: value, ..Default::default() }
}

fn whole(value: u64) -> ParameterValue {
    let integer_value = i64::try_from(value).unwrap_or(i64::MAX);
    let r#type = ParameterType::PARAMETER_INTEGER;
    ParameterValue { r#type, integer_value, ..Default::default() }
}

fn text(value: &str) -> ParameterValue {
    let r#type = ParameterType::PARAMETER_STRING;
    ParameterValue { r#type, string_value: value.to_owned(), ..Default::default() }
}

fn flag(value: bool) -> ParameterValue {
    let r#type = ParameterType::PARAMETER_BOOL;
    ParameterValue { r#type, bool_value: value, ..Default::default() }
}

fn find(name: &str) -> Option<&'static Row> {
    PARAMETERS.iter().find(|it| it.0 == name)
}

impl Simulator {
    fn value(&self, row: &Row) -> ParameterValue {
        match &row.1 {
            Kind::TunableParameter(parameter) => double(parameter.get(&self.scene)),
            Kind::Rate(rate) => double(*rate(&mut self.scene.outputs.clone())),
            Kind::SimResult(tell) => tell(&self.scene),
        }
    }

    /// Smallest and largest value of a parameter that may be changed.
    fn range(&self, kind: &Kind) -> Option<[f64; 2]> {
        match kind {
            Kind::TunableParameter(parameter) => Some(parameter.range()),
            Kind::Rate(_) => Some([RATE_MIN, 1.0 / tick_s(&self.scene)]),
            Kind::SimResult(_) => None,
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
                read_only: matches!(row.1, Kind::SimResult(_)),
                floating_point_range: range.into_iter().collect(),
                ..Default::default()
            }
        };
        DescribeParametersResponse { descriptors: request.names.iter().map(describe).collect() }
    }

    /// Names below any of the prefixes, at most `depth` levels deep; 0 is any depth.
    pub(super) fn list_parameters(
        &self,
        request: &ListParametersRequest,
    ) -> ListParametersResponse {
        let depth = usize::try_from(request.depth).unwrap_or(usize::MAX);
        let is_near = |rest: &str| depth == 0 || rest.split('.').count() <= depth;
        let is_meant = |name: &str| {
            let below = |prefix: &String| {
                let rest = name.strip_prefix(prefix.as_str())?;
                if rest.is_empty() { Some(rest) } else { rest.strip_prefix('.') }
            };
            match request.prefixes.as_slice() {
                [] => is_near(name),
                prefixes => prefixes.iter().filter_map(below).any(is_near),
            }
        };
        let names = PARAMETERS.iter().map(|it| it.0).filter(|name| is_meant(name));
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
        for asked in &request.parameters {
            let set = self.check(asked).and_then(|it| self.set(it, asked, world));
            if set.is_ok() {
                changed.push(asked.clone());
            }
            results.push(result_of(set));
        }
        self.tell_parameters(changed, world);
        SetParametersResponse { results }
    }

    pub(super) fn set_parameters_atomically(
        &mut self,
        request: &SetParametersAtomicallyRequest,
        world: &mut World<'_>,
    ) -> SetParametersAtomicallyResponse {
        let asked = &request.parameters;
        let checked: Result<Vec<Setting>, String> = asked.iter().map(|it| self.check(it)).collect();
        // What has been checked can fail only if the world does not change at all.
        let set = checked.and_then(|all| {
            all.into_iter().zip(asked).try_for_each(|(it, asked)| self.set(it, asked, world))
        });
        if set.is_ok() {
            self.tell_parameters(asked.clone(), world);
        }
        SetParametersAtomicallyResponse { result: result_of(set) }
    }

    fn check(&self, asked: &Parameter) -> Result<Setting, String> {
        let name = &asked.name;
        let row = find(name).ok_or_else(|| format!("there is no parameter `{name}`"))?;
        let setting = match row.1 {
            Kind::TunableParameter(parameter) => Setting::TunableParameter(parameter),
            Kind::Rate(rate) => Setting::Rate(rate),
            Kind::SimResult(_) => {
                return Err(format!(
                    "`{name}` is read-only: change it in the scene, and start anew"
                ));
            }
        };
        let value = match asked.value.r#type {
            ParameterType::PARAMETER_DOUBLE => asked.value.double_value,
            kind => return Err(format!("`{name}` is a double (3), not of type {kind}")),
        };
        match self.range(&row.1) {
            Some([min, max]) if !(min..=max).contains(&value) => {
                Err(format!("`{name}` is {value}: {} lies from {min} to {max}", row.2))
            }
            _ => Ok(setting),
        }
    }

    /// Sets what has been checked.
    fn set(
        &mut self,
        setting: Setting,
        asked: &Parameter,
        world: &mut World<'_>,
    ) -> Result<(), String> {
        let value = asked.value.double_value;
        match setting {
            Setting::TunableParameter(parameter) => {
                let change = Change::SetParameter { parameter, value };
                self.change(&change, world).map_err(|refusal| refusal.to_string())?;
                parameter.set(Arc::make_mut(&mut self.scene), value);
            }
            Setting::Rate(rate) => {
                *rate(&mut Arc::make_mut(&mut self.scene).outputs) = value;
            }
        }
        Ok(())
    }

    /// Tells on `/parameter_events` what has been changed.
    fn tell_parameters(&mut self, changed_parameters: Vec<Parameter>, world: &World<'_>) {
        if changed_parameters.is_empty() {
            return;
        }
        let event = ParameterEvent {
            stamp: stamp(world.seen.time_ns),
            node: self.scene.outputs.ros.node.clone(),
            changed_parameters,
            ..ParameterEvent::default()
        };
        if let Some(channel) = parameter_events(self.goals.n_channels) {
            self.out.push(Outgoing::Message(channel, Cdr::of(&event)));
        }
    }
}

fn result_of(set: Result<(), String>) -> SetParametersResult {
    match set {
        Ok(()) => SetParametersResult { successful: true, reason: String::new() },
        Err(reason) => SetParametersResult { successful: false, reason },
    }
}
