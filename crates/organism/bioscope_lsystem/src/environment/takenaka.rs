use bioscope_core::Vec3;
use glam::DVec3;

use super::cells::Cells;
use super::settings::{Settings, bounded};
use super::{Environment, EnvironmentError, Reply, Request};

/// Light of one year on a square centimetre, mol: 1000 µmol/m²/s, 12 hours a day, 200 days.
const YEAR: f64 = 10e-7 * 3600.0 * 12.0 * 200.0;
/// Leaves whose light is dimmed below this share get none.
const DARK: f64 = 1e-9;

/// Photosynthesis of balls of sparse leaves in the light of a few lamps.
///
/// A message `?E(a,m)` is a ball of leaf area a that needs the product m to stay alive; the second
/// answer is what it makes beyond that.
///
/// Source: A. Takenaka, "A simulation model of tree architecture development based on growth
/// response to local light environment", J. Plant Research 107 (1994), as the field program takenaka has it.
#[derive(Clone, Debug)]
pub struct LeafBalls {
    sources: Vec<(DVec3, f64)>,
    sparsity: f64,
    transmittance: f64,
    efficiency: f64,
    beam: f64,
}

#[derive(Clone, Copy)]
struct Ball {
    center: DVec3,
    radius: f64,
    area: f64,
    upkeep: f64,
}

impl LeafBalls {
    /// The field program takenaka.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        const NAME: &str = "takenaka";
        settings.check(
            NAME,
            &["grid size", "parameter s", "transmittance", "efficiency", "source", "beam radius"],
        )?;
        let sparsity = settings.number(&["parameter s"], 1.5);
        let sparsity = f64::from(bounded(NAME, "parameter s", sparsity, (1e-3, 1e3))?);
        let tau = settings.number(&["transmittance"], 0.1);
        let transmittance = f64::from(bounded(NAME, "transmittance", tau, (0.0, 1.0))?);
        let given = settings.all("source").filter_map(|text| {
            let [x, y, z, light] = crate::files::numbers(text)[..] else { return None };
            Some((Vec3::new(x, y, z).as_dvec3(), f64::from(light)))
        });
        let mut sources: Vec<(DVec3, f64)> = given.collect();
        if sources.is_empty() {
            sources.push((DVec3::new(10_000.0, 0.0, 0.0), 1.0));
        }
        let total: f64 = sources.iter().map(|source| source.1).sum();
        sources.iter_mut().for_each(|source| source.1 *= YEAR / total.max(1e-30));
        Ok(Self {
            sources,
            sparsity,
            transmittance,
            efficiency: f64::from(settings.number(&["efficiency"], 0.015)),
            beam: f64::from(settings.number(&["beam radius"], 0.0)),
        })
    }

    /// The share of light that passes a ball.
    fn passing(&self) -> f64 {
        let through = 1.0 - (1.0 - self.transmittance) / (self.sparsity * self.sparsity);
        (through * through).clamp(0.0, 1.0)
    }

    /// Light of all lamps at each ball.
    fn light(&self, balls: &[Ball]) -> Vec<f64> {
        let mut light = vec![0.0; balls.len()];
        let largest = balls.iter().map(|ball| ball.radius).fold(0.0, f64::max);
        let middle =
            balls.iter().map(|ball| ball.center).sum::<DVec3>() / balls.len().max(1) as f64;
        let passing = self.passing();
        for &(lamp, intensity) in &self.sources {
            let axis = (lamp - middle).normalize_or(DVec3::Y);
            let across = axis.any_orthonormal_vector();
            let over = axis.cross(across);
            // Seen from the lamp, in the plane through the middle.
            let far = (lamp - middle).dot(axis).max(1e-9);
            let seen = |place: DVec3| {
                let way = place - lamp;
                let depth = -way.dot(axis);
                let scale = if depth > 1e-6 { far / depth } else { 1.0 };
                [way.dot(across) * scale, way.dot(over) * scale]
            };
            let places: Vec<[f64; 2]> = balls.iter().map(|ball| seen(ball.center)).collect();
            let nearest = balls.iter().map(|ball| (lamp - ball.center).dot(axis));
            let nearest = nearest.fold(f64::INFINITY, f64::min).max(1e-6);
            let widest = 2.0 * largest * (1.0 + self.beam) * (far / nearest).max(1.0);
            let cells = Cells::new(&places, widest);
            for (own, ball) in balls.iter().enumerate() {
                let direction = (lamp - ball.center).normalize_or(axis);
                let mut share = 1.0;
                for range in cells.near(places[own], widest) {
                    for &other in &cells.points[range] {
                        if other as usize != own
                            && self.meets(ball, direction, &balls[other as usize])
                        {
                            share *= passing;
                        }
                    }
                    if share < DARK {
                        break;
                    }
                }
                light[own] += intensity * share;
            }
        }
        light
    }

    /// Whether the ray from a ball to a lamp meets another ball.
    fn meets(&self, ball: &Ball, direction: DVec3, other: &Ball) -> bool {
        let way = ball.center - other.center;
        let along = direction.dot(way);
        let radius = other.radius + ball.radius * self.beam;
        let square = along * along - way.length_squared() + radius * radius;
        square >= 0.0 && square.sqrt() > along
    }
}

impl Environment for LeafBalls {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let (mut balls, mut asking) = (Vec::new(), Vec::new());
        for (number, request) in requests.iter().enumerate() {
            if let [area, upkeep, ..] = request.parameters
                && *area > 0.0
                && area.is_finite()
                && request.position.is_finite()
            {
                let area = f64::from(*area);
                let radius = self.sparsity * 0.5 * (area / std::f64::consts::PI).sqrt();
                let center = request.position.as_dvec3();
                balls.push(Ball { center, radius, area, upkeep: f64::from(*upkeep) });
                asking.push(number);
            }
        }
        let caught = 1.0 - self.passing();
        let factor = self.sparsity * self.sparsity * caught / 4.0 * self.efficiency;
        for ((number, ball), light) in asking.iter().zip(&balls).zip(self.light(&balls)) {
            let product = light * ball.area * factor - ball.upkeep;
            replies[*number].parameters[1] = product as f32;
        }
        Ok(())
    }

    fn forgets(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::ask;

    #[test]
    fn a_ball_behind_another_makes_less() {
        let mut settings = Settings::default();
        settings.set("source", "0 1000 0 1");
        let mut leaves = LeafBalls::from_settings(&settings).unwrap();
        let asked: [(&[f32], Vec3, Vec3); 3] = [
            (&[10.0, 0.0], Vec3::ZERO, Vec3::Y),
            (&[10.0, 0.0], Vec3::Y * 5.0, Vec3::Y),
            (&[10.0, 0.1], Vec3::X * 50.0, Vec3::Y),
        ];
        let answers = ask(&mut leaves, &asked);
        let passing = leaves.passing() as f32;
        assert!((answers[0][1] / answers[1][1] - passing).abs() < 1e-5, "{answers:?}");
        assert!((answers[1][1] - answers[2][1] - 0.1).abs() < 1e-4);
        // All the light of a year on the section of a ball that lets nothing more through.
        let caught = 1.0 - leaves.passing();
        let expected = YEAR * 10.0 / 4.0 * 2.25 * caught * 0.015;
        assert!((f64::from(answers[1][1]) - expected).abs() < 1e-5);
    }
}
