//! Lists of the samples of the membrane that a body may touch.

use super::cell_grid::id;
use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Controls, Model, State,
        boundary::body::BodyMotion,
        contact::bodies::signed_distance,
        model::BodyModel,
        scratch::{BodyLists, NearSamples, SampleForce},
    },
};

/// Rebuilds the lists if they may be incomplete. `travel` is an upper bound of the total distance that any vertex
/// has moved relative to the carrier (m).
pub(super) fn refresh(
    model: &Model,
    controls: &Controls,
    state: &mut State,
    travel: Real,
    (lists, forces): (&mut BodyLists, &mut Vec<SampleForce>),
) {
    let mesh = &model.membrane.mesh;
    let n_samples = mesh.n_vertices() + mesh.triangles.len();
    let n_all = n_samples * model.bodies.len();
    if forces.len() == n_all && is_complete(model, controls, state, travel, lists) {
        return;
    }
    forces.clear();
    forces.resize(n_all, SampleForce::NONE);
    let State { membrane, springs, .. } = state;
    let mut points = membrane.positions.clone();
    points.extend(mesh.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|v| membrane.positions[v as usize]);
        (a + b + c) / 3.0
    }));
    lists.near.clear();
    lists.extents.clear();
    for (k, (body, motion)) in model.bodies.iter().zip(&controls.bodies).enumerate() {
        let mut distances = vec![0.0; n_samples];
        parallel::for_each(&mut distances, |s, distance| {
            *distance = distance_at_least(body, motion, &points[s], model.skin);
        });
        let is_near = |&s: &usize| distances[s] < model.skin;
        let (n_vertices, first) = (mesh.n_vertices(), k * n_samples);
        lists.near.push(NearSamples {
            vertices: (0..n_vertices).filter(is_near).map(id).collect(),
            facets: (n_vertices..n_samples).filter(is_near).map(|s| id(s - n_vertices)).collect(),
        });
        for s in (0..n_samples).filter(|s| !is_near(s)) {
            springs.bodies[first + s] = Vec3::zeros();
        }
        let origin = motion.pose.translation.vector;
        let furthest = points.iter().map(|point| (point - origin).norm()).fold(0.0, Real::max);
        lists.extents.push(body.bounding_radius.min(furthest + model.skin));
    }
    lists.bodies_at_build.clone_from(&controls.bodies);
    lists.carrier_position = state.carrier_position();
    lists.travel_at_build = travel;
    lists.is_built = true;
}

/// False if a sample that is not listed may touch a body.
fn is_complete(
    model: &Model,
    controls: &Controls,
    state: &State,
    travel: Real,
    lists: &BodyLists,
) -> bool {
    let carried = state.carrier_position() - lists.carrier_position;
    // The motion of the vertices in the next substep is not known yet; a tenth of the skin is reserved for it.
    let rest = 0.9 * model.skin - (travel - lists.travel_at_build);
    let bodies = lists.bodies_at_build.iter().zip(&controls.bodies).zip(&lists.extents);
    let mut is_near = bodies.map(|((from, to), &extent)| {
        let shift = (to.pose.translation.vector - from.pose.translation.vector - carried).norm();
        let angle = from.pose.rotation.angle_to(&to.pose.rotation);
        shift + if angle > 0.0 { angle * extent } else { 0.0 } < rest
    });
    lists.is_built && lists.near.len() == controls.bodies.len() && is_near.all(|it| it)
}

/// Signed distance of `point` (m), or a lower bound of it if the bound is at least `enough` (m).
fn distance_at_least(body: &BodyModel, motion: &BodyMotion, point: &Vec3, enough: Real) -> Real {
    let arm = point - motion.pose.translation.vector;
    let beyond = arm.norm() - body.bounding_radius;
    if beyond >= enough { beyond } else { signed_distance(body, motion, &arm).0 }
}
