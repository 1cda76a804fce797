/// The pull of an opportunity at `distance`, from 0 at `far` and beyond to 1 at `near` and nearer; all in the
/// same unit (Tu 1996, 6.2.1): with `s = 1/distance`, `q1 = 1/far` and `q2 = 1/near` it is
/// `(s − q1) / (2 q2 − q1 − s)`, convex and step-like.
pub fn stimulus(distance: f32, near: f32, far: f32) -> f32 {
    let (s, q1, q2) = (1.0 / distance.max(1e-6), 1.0 / far, 1.0 / near);
    if s <= q1 {
        0.0
    } else if s > q2 {
        1.0
    } else {
        (s - q1) / (2.0 * q2 - q1 - s)
    }
}
