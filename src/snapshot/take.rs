//! Snapshots and views of a session.

use super::{
    BodySnapshot, ChamberSnapshot, ContactSnapshot, GrainsSnapshot, JammingSnapshot,
    MembraneSnapshot, ObjectSnapshot, Parts, Snapshot, view::View,
};
use crate::{
    base::{Real, Vec3, real::Wrench},
    cosim::{Coupled, FLANGE},
    measure,
    physics::System,
    session::Session,
};

impl Session {
    /// Copies the results of the last tick. The large parts are copied only if `parts` selects
    /// them.
    pub fn snapshot(&self, parts: Parts) -> Snapshot {
        let coupled = self.coupled();
        let state = &coupled.system.state;
        let flange = &state.walls[FLANGE];
        let to_flange = flange.pose.rotation.inverse();
        let in_flange_axes =
            |it: &Wrench| Wrench { force: to_flange * it.force, torque: to_flange * it.torque };
        let means = self.means();
        Snapshot {
            tick: self.now(),
            time_ns: self.time_ns(),
            run_tick: self.run_tick(),
            flange: BodySnapshot { pose: flange.pose, twist: flange.twist },
            objects: objects(self),
            contact_wrench: in_flange_axes(&means.objects_on_gripper),
            mount_wrench: self.sensor(),
            chamber: ChamberSnapshot {
                gauge_setpoint: self.processor().gauge_setpoint(),
                gauge: state.gauge,
                ambient: self.scene().chamber.ambient,
                volume: measure::enclosed_volume(&coupled.system.model, state),
            },
            jamming: jamming(coupled),
            membrane: parts.membrane.then(|| membrane(self)),
            grains: parts.grains.then(|| GrainsSnapshot {
                positions: state.grains.positions.clone(),
                radii: state.grains.radii.clone(),
                velocities: state.grains.velocities.clone(),
                normal_forces: self.normal_forces().to_vec(),
            }),
            contacts: parts.contacts.then(|| contacts(coupled)),
            commands: self.records().to_vec(),
            command_counts: self.processor().counts(),
            digest: self.digest(),
        }
    }

    /// Borrows the results of the last tick. `snapshot` is the snapshot of the same tick.
    pub fn view<'a>(&'a self, snapshot: &'a Snapshot) -> View<'a> {
        let System { state, scratch, .. } = &self.coupled().system;
        View {
            snapshot,
            grain_positions: &state.grains.positions,
            grain_velocities: &state.grains.velocities,
            grain_spins: &state.grains.angular_velocities,
            grain_radii: &state.grains.radii,
            grain_normal_forces: self.normal_forces(),
            vertex_positions: &state.membrane.positions,
            vertex_velocities: &state.membrane.velocities,
            vertex_contact_forces: &scratch.vertex_forces,
        }
    }
}

fn objects(session: &Session) -> Vec<ObjectSnapshot> {
    let means = session.means();
    let of_object = |(i, object): (usize, &crate::scene::Object)| {
        let motion = session.coupled().world.motion(i);
        ObjectSnapshot {
            name: object.name.clone(),
            body: BodySnapshot { pose: motion.pose, twist: motion.twist },
            contact_wrench: means.contacts_on_objects[i],
            membrane_wrench: means.membrane_on_objects[i],
            is_driven: session.processor().is_driven(i),
        }
    };
    session.scene().objects.iter().enumerate().map(of_object).collect()
}

fn jamming(coupled: &Coupled) -> JammingSnapshot {
    let System { model, state, scratch, .. } = &coupled.system;
    let packing = measure::packing(state, scratch);
    let diameter = 2.0 * model.radius_mean;
    JammingSnapshot {
        n_grain_contacts: packing.n_grain_contacts,
        n_membrane_contacts: packing.n_membrane_contacts,
        n_object_contacts: packing.n_body_contacts,
        coordination_number: packing.coordination_number,
        jammed_fraction: packing.jammed_fraction,
        solid_fraction: measure::grain_volume(state) / measure::enclosed_volume(model, state),
        sliding_fraction: packing.sliding_fraction,
        kinetic_energy: measure::kinetic_energy(model, state),
        overlap_ratio_max: packing.overlap_max / diameter,
        membrane_overlap_ratio_max: packing.membrane_overlap_max / diameter,
    }
}

fn membrane(session: &Session) -> MembraneSnapshot {
    let System { model, state, scratch, .. } = &session.coupled().system;
    let mesh = &model.membrane.mesh;
    let positions = &state.membrane.positions;
    let mut area_normals = vec![Vec3::zeros(); positions.len()];
    for (triangle, facet) in mesh.triangles.iter().zip(&scratch.membrane.facets) {
        for &v in triangle {
            area_normals[v as usize] += facet.area_normal;
        }
    }
    let unit = |it: &Vec3| it.try_normalize(0.0).unwrap_or_else(|| -Vec3::z());
    // Each of three corners bears a third of a facet's area, half of its area normal.
    let pressure =
        |(force, normal): (&Vec3, &Vec3)| force.norm() / (normal.norm() / 6.0).max(1e-12);
    MembraneSnapshot {
        positions: positions.clone(),
        normals: area_normals.iter().map(unit).collect(),
        contact_pressures: scratch.vertex_forces.iter().zip(&area_normals).map(pressure).collect(),
        strains: strains(session),
    }
}

/// Mean strain of the springs at each vertex; all rest lengths are shortened by the same share.
fn strains(session: &Session) -> Vec<Real> {
    let System { model, state, .. } = &session.coupled().system;
    let mesh = &model.membrane.mesh;
    let shortened = 1.0 - session.scene().membrane.rest_length_shrink;
    let mut sums = vec![(0.0, 0.0); mesh.n_vertices()];
    for edge in &mesh.edges {
        let [a, b] = edge.map(|v| v as usize);
        let length = |at: &[Vec3]| (at[b] - at[a]).norm();
        let strain =
            length(&state.membrane.positions) / (shortened * length(&mesh.positions)) - 1.0;
        for v in [a, b] {
            sums[v].0 += strain;
            sums[v].1 += 1.0;
        }
    }
    sums.iter().map(|(sum, count): &(Real, Real)| sum / count.max(1.0)).collect()
}

fn contacts(coupled: &Coupled) -> Vec<ContactSnapshot> {
    let System { model, scratch, .. } = &coupled.system;
    let n_samples = scratch.sample_forces.len() / model.bodies.len().max(1);
    let of_objects = scratch.sample_forces.iter().take(n_samples * coupled.n_objects()).enumerate();
    let touching = of_objects.filter(|(_, sample)| sample.flags.touches());
    touching
        .map(|(index, sample)| ContactSnapshot {
            object: index / n_samples,
            point: sample.point,
            normal: sample.normal,
            force: -sample.force,
            normal_force: sample.force.dot(&sample.normal).max(0.0),
            overlap: sample.overlap,
        })
        .collect()
}
