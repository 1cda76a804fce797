//! How conflicting wishes become one: each function takes acceleration requests in the order of
//! their priority and returns the acceleration to ask of the body.
//!
//! Requests are in units of the greatest acceleration, at most 1 long (see [`request`]).
//! Source: Reynolds, "Flocks, herds, and schools", SIGGRAPH 1987, section on arbitrating
//! independent behaviors; first-active and dither from his later slides on steering.

use bioscope_core::{Random, Vec3};

/// A wish of this acceleration (m/s²) as a request: in units of `maximum_acceleration` (m/s²),
/// shortened to length 1 where it is longer, then times `strength` (0 to 1).
pub fn request(acceleration: Vec3, maximum_acceleration: f32, strength: f32) -> Vec3 {
    (acceleration / maximum_acceleration).clamp_length_max(1.0) * strength
}

/// What prioritized allocation granted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allocation {
    /// Sum of the granted requests.
    pub acceleration: Vec3,
    /// Index of the request that was granted most; none if all were zero.
    pub winner: Option<usize>,
}

/// Grants requests in order until their magnitudes (not the length of their sum) add up to
/// `budget`; the one that exceeds it is trimmed, the rest get nothing. So an emergency at the
/// head of the list is granted in full and cannot be cancelled by what follows.
#[inline]
pub fn prioritized(requests: &[Vec3], budget: f32) -> Allocation {
    let mut allocation = Allocation { acceleration: Vec3::ZERO, winner: None };
    let (mut used, mut most) = (0.0, 0.0);
    for (index, &request) in requests.iter().enumerate() {
        if request == Vec3::ZERO {
            continue;
        }
        let magnitude = request.length();
        let granted = magnitude.min(budget - used);
        if granted > most {
            (most, allocation.winner) = (granted, Some(index));
        }
        if granted < magnitude {
            allocation.acceleration += request * (granted / magnitude);
            break;
        }
        allocation.acceleration += request;
        used += magnitude;
    }
    allocation
}

/// The sum of all requests, shortened to `budget`: opposite requests cancel.
pub fn sum(requests: &[Vec3], budget: f32) -> Vec3 {
    requests.iter().sum::<Vec3>().clamp_length_max(budget)
}

/// The mean of all requests; zero for none. Near an obstacle this is the known failure: the
/// emergency is diluted by everything else.
pub fn average(requests: &[Vec3]) -> Vec3 {
    requests.iter().sum::<Vec3>() / requests.len().max(1) as f32
}

/// The first request that is not zero.
pub fn first_active(requests: &[Vec3]) -> Vec3 {
    requests.iter().copied().find(|request| *request != Vec3::ZERO).unwrap_or(Vec3::ZERO)
}

/// Each (probability, request) in turn is executed with its probability if it is not zero, else
/// passed over; zero if none is.
pub fn dither(requests: &[(f32, Vec3)], random: &mut Random) -> Vec3 {
    let executed = requests
        .iter()
        .find(|(probability, request)| *request != Vec3::ZERO && random.uniform() < *probability);
    executed.map_or(Vec3::ZERO, |(_, request)| *request)
}

#[cfg(test)]
mod tests {
    use bioscope_core::Purpose;
    use proptest::prelude::*;

    use super::*;

    fn vector() -> impl Strategy<Value = Vec3> {
        (-1f32..1.0, -1f32..1.0, -1f32..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn an_emergency_is_granted_in_full(
            emergency in vector(), others in prop::collection::vec(vector(), 0..6)
        ) {
            let requests: Vec<Vec3> =
                std::iter::once(emergency.normalize_or_zero()).chain(others).collect();
            prop_assume!(requests[0] != Vec3::ZERO);
            let allocation = prioritized(&requests, 1.0);
            prop_assert!((allocation.acceleration - requests[0]).length() < 1e-5);
            prop_assert_eq!(allocation.winner, Some(0));
        }

        #[test]
        fn magnitudes_add_up_to_the_budget_and_no_further(
            requests in prop::collection::vec(vector(), 0..8), budget in 0.1f32..2.0
        ) {
            // All along one axis the length of the sum is the sum of the magnitudes.
            let along: Vec<Vec3> = requests.iter().map(|one| Vec3::X * one.length()).collect();
            let total: f32 = requests.iter().map(|one| one.length()).sum();
            let granted = prioritized(&along, budget).acceleration.length();
            prop_assert!((granted - total.min(budget)).abs() < 1e-4);
        }
    }

    #[test]
    fn the_last_request_is_trimmed_by_magnitudes() {
        let requests = [Vec3::X * 0.6, Vec3::Y * 0.6, Vec3::Z];
        let expected = Vec3::new(0.6, 0.4, 0.0);
        assert!((prioritized(&requests, 1.0).acceleration - expected).length() < 1e-6);
    }

    #[test]
    fn averaging_cancels_what_allocation_decides() {
        let requests = [Vec3::X, -Vec3::X];
        assert_eq!(average(&requests), Vec3::ZERO);
        assert_eq!(sum(&requests, 1.0), Vec3::ZERO);
        assert_eq!(prioritized(&requests, 1.0).acceleration, Vec3::X);
        assert_eq!(first_active(&[Vec3::ZERO, -Vec3::X, Vec3::X]), -Vec3::X);
    }

    #[test]
    fn sums_are_shortened_to_the_budget_and_averages_divided() {
        let requests = [Vec3::X, Vec3::Y];
        assert!((sum(&requests, 0.5).length() - 0.5).abs() < 1e-6);
        assert_eq!(average(&requests), Vec3::new(0.5, 0.5, 0.0));
        assert_eq!(average(&[]), Vec3::ZERO);
    }

    #[test]
    fn dither_executes_each_behavior_with_its_probability() {
        let requests = [(0.7, Vec3::X), (0.5, Vec3::Y)];
        let mut counts = [0_i32; 3];
        for tick in 0..10_000 {
            let chosen = dither(&requests, &mut Random::new(1, 1, tick, Purpose::new("dither")));
            counts[if chosen == Vec3::X {
                0
            } else if chosen == Vec3::Y {
                1
            } else {
                2
            }] += 1;
        }
        for (count, expected) in counts.into_iter().zip([7000, 1500, 1500]) {
            assert!((count - expected).abs() < 200, "{counts:?}");
        }
    }

    #[test]
    fn requests_are_shortened_then_scaled_by_their_strength() {
        assert_eq!(request(Vec3::X * 4.0, 8.0, 0.5), Vec3::X * 0.25);
        assert_eq!(request(Vec3::X * 40.0, 8.0, 0.7), Vec3::X * 0.7);
    }
}
