//! Input of reference codes: the numbers of a case, and the grains.

use serde_json::{Value, json};

use super::tool::Tool;
use crate::{
    base::Real,
    benchmarks::{
        packing::{Boxed, MATERIAL, RESTITUTION, SUBSTEP, SURFACE},
        repetitions::Work,
    },
    physics::System,
};

/// Skin of the neighbor lists of reference codes (m).
const SKIN: Real = 2e-4;

/// The numbers of a case, with the names that the scripts use.
pub(super) fn numbers(boxed: &Boxed, work: Work) -> Value {
    let (size, gravity) = (boxed.size(), boxed.gravity());
    let stiffness = MATERIAL.youngs_modulus / (1.0 - MATERIAL.poisson_ratio.powi(2));
    let shear = MATERIAL.youngs_modulus / (2.0 * (1.0 + MATERIAL.poisson_ratio));
    // F_d = 2 E* A a v as in jamgrip, with E* = stiffness / 2, for the mean grain's effective mass.
    let mass = 0.5 * MATERIAL.density * crate::physics::packing::sphere_volume(2e-3);
    json!({
        "steps": work.n_steps,
        "warm": work.n_warm,
        "dt": SUBSTEP,
        "skin": SKIN,
        "lx": size.x, "ly": size.y, "lz": size.z,
        "g": gravity.norm(), "gx": gravity.x, "gz": gravity.z,
        "young": MATERIAL.youngs_modulus,
        "poisson": MATERIAL.poisson_ratio,
        "density": MATERIAL.density,
        "friction": SURFACE.friction,
        "restitution": RESTITUTION,
        "kn": 2.0 / 3.0 * stiffness,
        "kt": 4.0 * shear / (2.0 - MATERIAL.poisson_ratio),
        "gn": stiffness * SURFACE.dissipation_time / mass,
    })
}

/// The grains in the format of a reference code.
pub(super) fn packing(tool: Tool, system: &System, boxed: &Boxed) -> String {
    let grains = &system.state.grains;
    let row = |values: &[Real]| {
        let texts: Vec<String> = values.iter().map(|it| format!("{it:e}")).collect();
        texts.join(" ")
    };
    let (mut positions, mut velocities) = (String::new(), String::new());
    for i in 0..grains.len() {
        let (p, radius) = (grains.positions[i], grains.radii[i]);
        let (v, w) = (grains.velocities[i], grains.angular_velocities[i]);
        let motion = row(&[v.x, v.y, v.z, w.x, w.y, w.z]);
        if tool == Tool::Yade {
            positions += &format!("{} {motion}\n", row(&[p.x, p.y, p.z, radius]));
        } else {
            let position = row(&[2.0 * radius, MATERIAL.density, p.x, p.y, p.z]);
            positions += &format!("{} 1 {position}\n", i + 1);
            velocities += &format!("{} {motion}\n", i + 1);
        }
    }
    if tool == Tool::Yade {
        return positions;
    }
    let style = if tool == Tool::Liggghts { "" } else { " # sphere" };
    let size = boxed.size();
    let edge = |axis: usize, name: char| {
        // Grains overlap with the walls.
        format!("-0.001 {:e} {name}lo {name}hi\n", size[axis] + 0.001)
    };
    format!(
        "grains\n\n{} atoms\n1 atom types\n{}{}{}\nAtoms{style}\n\n{positions}\nVelocities\n\n{velocities}",
        grains.len(),
        edge(0, 'x'),
        edge(1, 'y'),
        edge(2, 'z')
    )
}
