//! Sessions as bytes: save, resume, compare.

use serde::{Deserialize, Serialize};

use super::{Compiled, SavedStateError, Session, TunableParameter, saved_state};
use crate::{
    base::{Tick, Vec3, real::Wrench},
    scene::Object,
};

/// A saved session, between two ticks.
#[derive(Serialize, Deserialize)]
struct Saved<'a> {
    tick: u64,
    run_tick: u64,
    state: &'a [u8],
    world: &'a [u8],
    processor: &'a [u8],
    /// Force and torque.
    sensor_zero: [[f64; 3]; 2],
    parameters: Vec<(TunableParameter, f64)>,
}

impl<'a> Saved<'a> {
    fn read(bytes: &'a [u8]) -> Result<Self, SavedStateError> {
        let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
        postcard::from_bytes(saved_state::verify_digest(bytes)?).map_err(|_| corrupt)
    }
}

impl Session {
    /// Resumes a session from the bytes of `save`. With the same scene it continues with the same
    /// bits. Values of the scene that no saved number depends on may differ.
    ///
    /// # Errors
    /// If the bytes are damaged or belong to a scene with other grains, meshes or objects.
    pub fn resume(compiled: Compiled, bytes: &[u8]) -> Result<Self, SavedStateError> {
        let saved = Saved::read(bytes)?;
        let state = compiled.read_state(saved.state)?;
        let mut session = Self::assemble(compiled, state);
        session.coupled.world.restore(saved.world)?;
        session.processor.restore(saved.processor)?;
        session.tick = Tick(saved.tick);
        session.run_tick = Tick(saved.run_tick);
        let [force, torque] = saved.sensor_zero.map(Vec3::from);
        session.sensor_zero = Wrench { force, torque };
        saved
            .parameters
            .iter()
            .for_each(|(parameter, value)| session.set_parameter(*parameter, *value));
        if 0 < saved.run_tick {
            session.start.state = None;
        }
        session.digest = session.take_digest();
        Ok(session)
    }

    /// Sets the state that a reset of a resumed session restores: the bytes of `save` at the start
    /// of the run.
    ///
    /// # Errors
    /// If the bytes are damaged or belong to another scene.
    pub fn remember_start(&mut self, bytes: &[u8]) -> Result<(), SavedStateError> {
        let saved = Saved::read(bytes)?;
        let state = saved_state::read(saved.state)?;
        let now = &self.coupled.system.state;
        saved_state::check_counts(&[
            ("grains", state.grains.len(), now.grains.len()),
            ("vertices", state.membrane.positions.len(), now.membrane.positions.len()),
        ])?;
        self.start.state = Some(state);
        Ok(())
    }

    /// Everything that `resume` needs, as bytes. `None` after another scene was loaded, and while
    /// the objects differ from those of the scene, or their order does.
    pub fn save(&self) -> Option<Vec<u8>> {
        let names = |objects: &[Object]| objects.iter().map(|it| it.name.clone()).collect();
        let (present, original): (Vec<_>, Vec<_>) =
            (names(&self.scene.objects), names(&self.start.objects));
        if present != original || self.is_loaded {
            return None;
        }
        let (state, world) =
            (saved_state::write(&self.coupled.system.state), self.coupled.world.save());
        let processor = self.processor.save();
        let (tick, run_tick) = (self.tick.0, self.run_tick.0);
        let Wrench { force, torque } = self.sensor_zero;
        let sensor_zero = [force, torque].map(Into::into);
        let (state, world, processor, parameters) =
            (&state, &world, &processor, self.parameters.clone());
        let saved = Saved { tick, run_tick, state, world, processor, sensor_zero, parameters };
        Some(saved_state::with_digest(postcard::to_stdvec(&saved).expect("bytes always serialize")))
    }

    /// Compares with the bytes of `save` of another session: returns the name of the first part
    /// that differs in any bit.
    ///
    /// # Errors
    /// If the bytes are damaged.
    pub fn differs_from(&self, bytes: &[u8]) -> Result<Option<&'static str>, SavedStateError> {
        let other = Saved::read(bytes)?;
        let state = saved_state::read(other.state)?;
        let bits = |it: [[f64; 3]; 2]| it.map(|it| it.map(f64::to_bits));
        let Wrench { force, torque } = self.sensor_zero;
        let sensor_zero: [[f64; 3]; 2] = [force, torque].map(Into::into);
        let parameters = |parameters: &[(TunableParameter, f64)]| -> Vec<(TunableParameter, u64)> {
            parameters.iter().map(|(parameter, value)| (*parameter, value.to_bits())).collect()
        };
        let parts = [
            ("time", [self.tick.0, self.run_tick.0] == [other.tick, other.run_tick]),
            ("grains and membrane", saved_state::is_same(self.coupled.system.state.clone(), state)),
            ("rigid world", self.coupled.world.save() == other.world),
            ("setpoints", self.processor.save() == other.processor),
            ("zero of the wrist sensor", bits(sensor_zero) == bits(other.sensor_zero)),
            ("parameters", parameters(&self.parameters) == parameters(&other.parameters)),
        ];
        Ok(parts.into_iter().find(|(_, is_same)| !is_same).map(|(part, _)| part))
    }
}
