//! Coordination numbers: contacts per grain, with and without rattlers.
//!
//! A rattler has fewer contacts than a grain needs for mechanical equilibrium: four without friction,
//! since three repulsive forces cannot balance in space unless they lie in a plane; two with friction.
//! Removing rattlers removes contacts of their neighbors, so this is repeated until all grains have
//! enough. Isostatic coordination numbers without rattlers: 6 without friction, 4 with infinite friction.

use crate::{
    base::{Real, real::real},
    physics::{Scratch, State},
};

/// Contacts a grain needs without friction.
pub const NEEDED_SMOOTH: usize = 4;
/// Contacts a grain needs with friction.
pub const NEEDED_ROUGH: usize = 2;

/// Coordination of a packing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coordination {
    /// Mean number of contacts of a grain, with grains, walls and membrane.
    pub mean: Real,
    /// The same among the grains that are not rattlers.
    pub backbone: Real,
    /// Fraction of the grains that are rattlers.
    pub rattler_share: Real,
    /// True for each rattler.
    pub is_rattler: Vec<bool>,
}

/// Coordination after the last substep. Grains with fewer than `n_needed` contacts are rattlers.
pub fn coordination(state: &State, scratch: &Scratch, n_needed: usize) -> Coordination {
    let n_grains = state.grains.len();
    let mut supports = vec![0_usize; n_grains];
    for (i, patches) in scratch.patch_forces.iter().enumerate() {
        supports[i] += patches.n;
    }
    for (_, [_, i]) in scratch.touching_walls(state) {
        supports[i] += 1;
    }
    let touching = scratch.touching_pairs(state);
    let pairs: Vec<[usize; 2]> = touching.map(|(_, ids)| ids.map(|id| id as usize)).collect();
    of_contacts(&pairs, &supports, n_needed)
}

/// Coordination of grains with contacts `pairs` and with `supports` other contacts each.
pub fn of_contacts(pairs: &[[usize; 2]], supports: &[usize], n_needed: usize) -> Coordination {
    let n_grains = supports.len();
    let counts = |is_rattler: &[bool]| {
        let mut counts = supports.to_vec();
        for &[i, j] in pairs {
            counts[i] += usize::from(!is_rattler[j]);
            counts[j] += usize::from(!is_rattler[i]);
        }
        counts
    };
    let mut is_rattler = vec![false; n_grains];
    let mean = real(counts(&is_rattler).iter().sum()) / real(n_grains.max(1));
    loop {
        let now = counts(&is_rattler);
        let mut has_changed = false;
        for (is_rattler, &n) in is_rattler.iter_mut().zip(&now) {
            has_changed |= !*is_rattler && n < n_needed;
            *is_rattler |= n < n_needed;
        }
        if !has_changed {
            let carrying = now.iter().zip(&is_rattler).filter(|(_, is_rattler)| !**is_rattler);
            let (n, sum) = carrying.fold((0, 0), |(n, sum), (&count, _)| (n + 1, sum + count));
            let rattler_share = 1.0 - real(n) / real(n_grains.max(1));
            return Coordination {
                mean,
                backbone: real(sum) / real(n.max(1)),
                rattler_share,
                is_rattler,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Five grains that all touch each other; a chain of two is attached to one of them.
    #[test]
    fn a_chain_attached_to_a_cluster_is_removed_link_by_link() {
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for i in 0..5 {
            pairs.extend((0..i).map(|j| [i, j]));
        }
        pairs.extend([[4, 5], [5, 6]]);
        let found = of_contacts(&pairs, &[0; 7], 2);
        assert_eq!(found.is_rattler, [false, false, false, false, false, true, true]);
        assert!((found.mean - 24.0 / 7.0).abs() < 1e-15);
        assert!((found.backbone - 4.0).abs() < 1e-15);
        assert!((found.rattler_share - 2.0 / 7.0).abs() < 1e-15);
        // A support at the end of the chain stabilizes it.
        let found = of_contacts(&pairs, &[0, 0, 0, 0, 0, 0, 1], 2);
        assert_eq!(found.rattler_share.to_bits(), 0.0_f64.to_bits());
    }
}
