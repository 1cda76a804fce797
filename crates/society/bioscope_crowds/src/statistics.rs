//! Figures that describe a flock.

use bioscope_core::Vec3;

use crate::Grid;

/// Length of the mean heading: 1 if all fly the same way, near 0 if each flies its own. Those
/// that stand still count as headless; 0 for nobody.
pub fn polarization(velocities: &[Vec3]) -> f32 {
    let sum: Vec3 = velocities.iter().map(|velocity| velocity.normalize_or_zero()).sum();
    sum.length() / velocities.len().max(1) as f32
}

/// Distance of each to its nearest neighbor, metres; infinite where none is within `reach`.
pub fn nearest_neighbor_distances(positions: &[Vec3], reach: f32) -> Vec<f32> {
    let grid = Grid::new(positions, reach);
    let nearest = |(index, &position): (usize, &Vec3)| {
        let mut least = f32::INFINITY;
        grid.within(position, reach, |other, square| {
            if other != index {
                least = least.min(square);
            }
        });
        least.sqrt()
    };
    positions.iter().enumerate().map(nearest).collect()
}

/// Number of the flockette to which each belongs: connected components of the graph that links
/// all nearer than `link` metres, numbered from 0 in the order of their first members.
pub fn flockettes(positions: &[Vec3], link: f32) -> Vec<usize> {
    const NONE: usize = usize::MAX;
    let grid = Grid::new(positions, link);
    let mut labels = vec![NONE; positions.len()];
    let mut waiting = Vec::new();
    let mut count = 0;
    for first in 0..positions.len() {
        if labels[first] != NONE {
            continue;
        }
        labels[first] = count;
        waiting.push(first);
        while let Some(index) = waiting.pop() {
            grid.within(positions[index], link, |other, _| {
                if labels[other] == NONE {
                    labels[other] = count;
                    waiting.push(other);
                }
            });
        }
        count += 1;
    }
    labels
}

/// How many flockettes there are.
pub fn flockette_count(positions: &[Vec3], link: f32) -> usize {
    flockettes(positions, link).into_iter().max().map_or(0, |last| last + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polarization_is_one_for_parallel_and_zero_for_opposite_flight() {
        assert_eq!(polarization(&[Vec3::X, Vec3::X * 7.0]), 1.0);
        assert_eq!(polarization(&[Vec3::X, -Vec3::X * 7.0]), 0.0);
        assert_eq!(polarization(&[]), 0.0);
    }

    #[test]
    fn two_groups_are_two_flockettes() {
        let positions = [0.0, 1.0, 10.0, 1.9, 11.0].map(|x| Vec3::X * x);
        assert_eq!(flockettes(&positions, 1.5), [0, 0, 1, 0, 1]);
        assert_eq!(flockette_count(&positions, 20.0), 1);
        assert_eq!(flockette_count(&[], 1.0), 0);
        let distances = nearest_neighbor_distances(&positions, 5.0);
        assert!((distances[3] - 0.9).abs() < 1e-6);
        assert!(nearest_neighbor_distances(&positions, 0.5).iter().all(|one| one.is_infinite()));
    }
}
