//! Discontinuous changes of a session: reset, teleport, insert, remove, load.

use super::{Compiled, Session, no_forces};
use crate::{
    base::{Tick, real::Wrench},
    command::change::{Change, Scope, SettledScene, TunableParameter},
    cosim::{change_error::ChangeError, compile::retune},
    physics::boundary::body::BodyMotion,
    scene::Object,
};

impl Session {
    /// Applies a discontinuous change between two ticks.
    ///
    /// # Errors
    /// If the change is rejected; the session is then unchanged.
    pub fn change(&mut self, change: &Change) -> Result<(), ChangeError> {
        match change {
            Change::Reset(scope) => self.reset(*scope)?,
            Change::PlaceObject { object, pose, twist } => {
                let i = self.find(object)?;
                let motion = BodyMotion { pose: *pose, twist: *twist };
                self.coupled.place_object(&self.scene, i, &motion)?;
                self.processor.release(i);
            }
            Change::PlaceFlange { pose } => {
                self.coupled.place_flange(&self.scene, pose)?;
                self.processor.place_flange(*pose, self.time_ns());
            }
            Change::ZeroForceSensor => {
                self.sensor_zero = self.sensed();
                self.records.clear();
                return Ok(());
            }
            Change::SetParameter { parameter, value } => {
                self.set_parameter(*parameter, *value);
                self.records.clear();
                return Ok(());
            }
            Change::LoadScene(settled) => return self.load(settled),
            Change::Insert(object) => self.insert(object)?,
            Change::Remove { object } => {
                let i = self.find(object)?;
                self.remove(i);
            }
        }
        self.means = no_forces(self.scene.objects.len());
        self.normal_forces.fill(0.0);
        self.records.clear();
        self.digest = self.take_digest();
        Ok(())
    }

    pub(super) fn set_parameter(&mut self, parameter: TunableParameter, value: f64) {
        parameter.set(&mut self.scene, value);
        if parameter == TunableParameter::ObjectFriction {
            self.start.objects.iter_mut().for_each(|it| it.friction = value);
        }
        retune(&self.scene, &mut self.coupled.system.model);
        self.parameters.retain(|(other, _)| *other != parameter);
        self.parameters.push((parameter, value));
    }

    /// Replaces the scene; the ticks of the run and the counts of commands continue.
    fn load(&mut self, settled: &SettledScene) -> Result<(), ChangeError> {
        let SettledScene { scene, start, keeps_time } = settled;
        let [now, then] = [&self.scene, scene].map(|it| it.time.tick_ns);
        if now != then {
            let why = format!("its ticks are {then} ns long, those of this run {now} ns");
            return Err(ChangeError::Unusable(why));
        }
        let compiled = Compiled::new(scene, &self.pool)
            .map_err(|error| ChangeError::Unusable(error.to_string()))?;
        let mut next = Self::from_start_state(compiled, start)
            .map_err(|error| ChangeError::Unusable(error.to_string()))?;
        next.run_tick = self.run_tick;
        next.is_loaded = true;
        next.processor.count_on(self.processor.counts());
        if *keeps_time {
            next.tick = self.tick;
            next.processor.place_flange(scene.flange.pose, next.time_ns());
        }
        next.digest = next.take_digest();
        *self = next;
        Ok(())
    }

    fn reset(&mut self, scope: Scope) -> Result<(), ChangeError> {
        let is_own = |object: &Object| self.start.objects.iter().any(|it| it.name == object.name);
        if scope.state {
            let start = self.start.state.as_ref().ok_or(ChangeError::StartUnknown)?;
            let added = self.scene.objects.iter().filter(|it| !scope.spawned && !is_own(it));
            self.scene.objects = self.start.objects.iter().chain(added).cloned().collect();
            self.coupled.reset_to(&self.scene, start);
            self.processor.restart(&self.scene);
            self.sensor_zero = Wrench::zero();
        } else if scope.spawned {
            let objects = self.scene.objects.iter().enumerate();
            let added: Vec<usize> = objects.filter(|(_, it)| !is_own(it)).map(|(i, _)| i).collect();
            added.into_iter().rev().for_each(|i| self.remove(i));
        }
        if scope.time {
            self.tick = Tick(0);
            self.processor.restart_time();
        } else if scope.state {
            self.processor.place_flange(self.scene.flange.pose, self.time_ns());
        }
        Ok(())
    }

    fn insert(&mut self, object: &Object) -> Result<(), ChangeError> {
        let mut names = self.scene.objects.iter().chain(&self.start.objects);
        if names.any(|it| it.name == object.name) {
            return Err(ChangeError::NameTaken { object: object.name.clone() });
        }
        self.coupled.insert(&self.scene, object)?;
        self.scene.objects.push(object.clone());
        self.processor.insert(object);
        Ok(())
    }

    fn remove(&mut self, i: usize) {
        self.coupled.remove(i);
        self.scene.objects.remove(i);
        self.processor.remove(i);
    }

    fn find(&self, object: &str) -> Result<usize, ChangeError> {
        let objects = &self.scene.objects;
        objects.iter().position(|it| it.name == object).ok_or_else(|| {
            let known: Vec<&str> = objects.iter().map(|it| it.name.as_str()).collect();
            ChangeError::UnknownObject { object: object.to_owned(), known: known.join(", ") }
        })
    }
}
