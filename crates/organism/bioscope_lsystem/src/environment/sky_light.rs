//! Light from the sky on clusters of leaves that shade each other.

use bioscope_core::Vec3;
use glam::DVec3;
use rayon::prelude::*;

use super::cells::Cells;
use super::settings::{Settings, bounded};
use super::{Environment, EnvironmentError, Reply, Request};

/// Light that is dimmed to less than this share counts as none.
const DARK: f64 = 1e-7;
/// Balls that one thread takes at a time.
const SHARE: usize = 512;
/// Directions that are looked at together.
const TOGETHER: usize = 16;
/// Most directions from which light comes.
const DIRECTIONS: u32 = 8192;

/// Light of the whole sky, as seen by balls of leaves; each takes away a share of the light of those behind it.
///
/// A message `?E(r)` (or `?E(r,x,y,z)`) puts a ball of radius r here; r = 0 stands for the usual
/// radius. The answer is the share of the light of an open sky that its middle section gets, and
/// in x, y, z the brightest direction. Every step begins without balls.
///
/// Sources: R. Měch and P. Prusinkiewicz, "Visual models of plants interacting with their
/// environment", SIGGRAPH 1996, section 4.4, after A. Takenaka (1994); N. Chiba and others, "Visual simulation of
/// botanical trees based on virtual heliotropism and dormancy break", J. Visualization and Computer Animation 5 (1994).
#[derive(Clone, Debug)]
pub struct SkyLight {
    sources: Vec<Source>,
    transmittance: f64,
    radius: f32,
    /// Whether overlapping areas count (else the way of a ray through the balls).
    by_area: bool,
    /// Part of a ball's radius by which others are widened for its ray.
    beam: f64,
}

#[derive(Clone, Copy, Debug)]
struct Source {
    direction: DVec3,
    /// Share of the light of the open sky.
    share: f64,
}

#[derive(Clone, Copy)]
struct Ball {
    center: DVec3,
    radius: f64,
}

/// What one ball sees of others in one direction.
#[derive(Clone, Copy)]
struct Shadow {
    place: [f64; 2],
    depth: f64,
    radius: f64,
}

impl SkyLight {
    /// An overcast sky of 9 directions: the zenith, and 8 at an elevation of 45°.
    ///
    /// Their weights are those of the CIE overcast sky times their solid angles; the paper gives none.
    pub fn nine(transmittance: f64) -> Self {
        let eighth = std::f64::consts::FRAC_PI_8;
        let weight = |elevation: f64, angle: f64| (1.0 + 2.0 * libm::sin(elevation)) / 3.0 * angle;
        let up = std::f64::consts::FRAC_PI_2;
        let zenith = weight(up, 1.0 - libm::cos(eighth));
        let ring = weight(up / 2.0, libm::cos(eighth) / 8.0);
        let mut sources = vec![(DVec3::Y, zenith)];
        for number in 0..8 {
            let azimuth = f64::from(number) * up / 2.0;
            let (sine, cosine) = (libm::sin(azimuth), libm::cos(azimuth));
            let half = std::f64::consts::FRAC_1_SQRT_2;
            sources.push((DVec3::new(half * cosine, half, half * sine), ring));
        }
        Self::new(&sources, transmittance)
    }

    /// An overcast sky of so many directions, spread evenly (a Fibonacci spiral) over the upper half.
    pub fn hemisphere(directions: u32, transmittance: f64) -> Self {
        let count = directions.clamp(1, DIRECTIONS);
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let source = |number: u32| {
            let height = 1.0 - (f64::from(number) + 0.5) / f64::from(count);
            let (width, angle) = ((1.0 - height * height).sqrt(), golden * f64::from(number));
            let direction = DVec3::new(width * libm::cos(angle), height, width * libm::sin(angle));
            (direction, (1.0 + 2.0 * height) / 3.0)
        };
        Self::new(&(0..count).map(source).collect::<Vec<_>>(), transmittance)
    }

    /// A sky all around, of 8 · 4ⁿ directions (at least `samples`), the lower half `lower` times as bright as the upper.
    pub fn sphere(samples: u32, lower: f64, transmittance: f64) -> Self {
        let mut level = 0;
        while 8 * 4_u32.pow(level) < samples.min(DIRECTIONS) {
            level += 1;
        }
        let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let mut triangles = Vec::new();
        for x in [-1.0, 1.0] {
            for y in [-1.0, 1.0] {
                for z in [-1.0, 1.0] {
                    triangles.push([corner(x, 0., 0.), corner(0., y, 0.), corner(0., 0., z)]);
                }
            }
        }
        for _ in 0..level {
            triangles = triangles
                .iter()
                .flat_map(|&[a, b, c]| {
                    let [ab, bc, ca] = [a + b, b + c, c + a].map(DVec3::normalize);
                    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                })
                .collect();
        }
        let source = |[a, b, c]: &[DVec3; 3]| {
            let direction = (*a + *b + *c).normalize();
            (direction, if direction.y > 0.0 { 1.0 } else { lower })
        };
        Self::new(&triangles.iter().map(source).collect::<Vec<_>>(), transmittance)
    }

    /// Light from these directions, in these proportions.
    pub fn new(sources: &[(DVec3, f64)], transmittance: f64) -> Self {
        let total: f64 = sources.iter().map(|source| source.1).sum();
        let sources = sources.iter().filter(|source| source.1 > 0.0).map(|&(direction, weight)| {
            Source { direction: direction.normalize_or(DVec3::Y), share: weight / total }
        });
        Self {
            sources: sources.collect(),
            transmittance: transmittance.clamp(0.0, 1.0),
            radius: 25.0,
            by_area: true,
            beam: 0.0,
        }
    }

    /// The built-in process `sky_light sources=9 tau=0.25`.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        const NAME: &str = "sky_light";
        settings
            .check(NAME, &["sources", "directions", "tau", "transmittance", "grid", "radius"])?;
        let tau = settings.number(&["tau", "transmittance"], 0.25);
        let tau = bounded(NAME, "tau", tau, (0.0, 1.0))?;
        let sources = settings.number(&["sources", "directions"], 9.0);
        let sources = bounded(NAME, "sources", sources, (1.0, DIRECTIONS as f32))? as u32;
        let sky = if sources == 9 {
            Self::nine(f64::from(tau))
        } else {
            Self::hemisphere(sources, f64::from(tau))
        };
        Ok(Self { radius: settings.number(&["radius"], 0.5), ..sky })
    }

    /// The field program chiba.
    pub fn chiba(settings: &Settings) -> Result<Self, EnvironmentError> {
        const NAME: &str = "chiba";
        settings.check(
            NAME,
            &[
                "grid size",
                "number of samples",
                "lower to upper ratio",
                "source direction",
                "transmittance",
                "radius",
                "beam radius",
                "estimate intersection area",
                "use CIE formula",
            ],
        )?;
        let tau = settings.number(&["transmittance"], 0.6);
        let tau = f64::from(bounded(NAME, "transmittance", tau, (0.0, 1.0))?);
        let given: Vec<(DVec3, f64)> = settings
            .all("source direction")
            .filter_map(|text| {
                let [x, y, z, intensity] = crate::files::numbers(text)[..] else { return None };
                Some((Vec3::new(x, y, z).as_dvec3(), f64::from(intensity)))
            })
            .collect();
        let sky = if given.is_empty() {
            let samples = settings.number(&["number of samples"], 128.0).clamp(1.0, 8192.0);
            let lower = settings.number(&["lower to upper ratio"], 0.7).clamp(0.0, 1.0);
            Self::sphere(samples as u32, f64::from(lower), tau)
        } else {
            Self::new(&given, tau)
        };
        Ok(Self {
            radius: settings.number(&["radius"], 25.0),
            by_area: settings.switch(&["estimate intersection area"], false),
            beam: f64::from(settings.number(&["beam radius"], 0.0)),
            ..sky
        })
    }

    /// Light of each ball and the sum of the directions it comes from.
    fn light(&self, balls: &[Ball]) -> Vec<(f64, DVec3)> {
        let mut light = vec![(0.0, DVec3::ZERO); balls.len()];
        let largest = balls.iter().map(|ball| ball.radius).fold(0.0, f64::max);
        for sources in self.sources.chunks(TOGETHER) {
            let passing = sources.par_iter().map(|one| self.passing_all(one, balls, largest));
            let passing: Vec<Vec<f64>> = passing.collect();
            // Direction after direction, whatever the threads.
            for (source, passing) in sources.iter().zip(passing) {
                for ((sum, way), passing) in light.iter_mut().zip(passing) {
                    let share = source.share * passing;
                    *sum += share;
                    *way += source.direction * share;
                }
            }
        }
        light
    }

    /// The share of light from one direction that gets through to each ball.
    fn passing_all(&self, source: &Source, balls: &[Ball], largest: f64) -> Vec<f64> {
        let direction = source.direction;
        let across = direction.any_orthonormal_vector();
        let over = direction.cross(across);
        let seen = |ball: &Ball| Shadow {
            place: [ball.center.dot(across), ball.center.dot(over)],
            depth: ball.center.dot(direction),
            radius: ball.radius,
        };
        let shadows: Vec<Shadow> = balls.iter().map(seen).collect();
        let places: Vec<[f64; 2]> = shadows.iter().map(|shadow| shadow.place).collect();
        let cells = Cells::new(&places, largest);
        // In each cell those nearest to the sky first.
        let mut sorted: Vec<Shadow> = Vec::with_capacity(shadows.len());
        for range in cells.ranges() {
            let start = sorted.len();
            sorted.extend(cells.points[range].iter().map(|&ball| shadows[ball as usize]));
            sorted[start..].sort_by(|a, b| b.depth.total_cmp(&a.depth));
        }
        let lit = shadows.par_iter().with_min_len(SHARE);
        lit.map(|own| self.passing(own, &sorted, &cells, largest)).collect()
    }

    /// The share of light from one direction that gets through to a ball.
    fn passing(&self, own: &Shadow, sorted: &[Shadow], cells: &Cells, largest: f64) -> f64 {
        let reach = own.radius + largest;
        let area = std::f64::consts::PI * own.radius * own.radius;
        let mut passing = 1.0;
        for range in cells.near(own.place, reach) {
            for other in &sorted[range] {
                let ahead = other.depth - own.depth;
                // Those after it in the cell are farther from the sky still; a ball reaches behind its middle.
                if ahead <= if self.by_area { 0.0 } else { -other.radius } {
                    if self.by_area || ahead <= -largest { break } else { continue }
                }
                let (x, y) = (other.place[0] - own.place[0], other.place[1] - own.place[1]);
                let square = x * x + y * y;
                let factor = if self.by_area {
                    let apart = own.radius + other.radius;
                    if square >= apart * apart {
                        continue;
                    }
                    let covered = overlap(square.sqrt(), own.radius, other.radius);
                    1.0 - (1.0 - self.transmittance) * covered / area
                } else {
                    let radius = other.radius + self.beam * own.radius;
                    // The ball itself has neither distance nor depth.
                    if square >= radius * radius || (square == 0.0 && ahead == 0.0) {
                        continue;
                    }
                    let half = (radius * radius - square).sqrt();
                    let way = (ahead + half) - (ahead - half).max(0.0);
                    if way <= 0.0 {
                        continue;
                    }
                    libm::pow(self.transmittance, way / (2.0 * radius))
                };
                passing *= factor;
                if passing < DARK {
                    return 0.0;
                }
            }
        }
        passing
    }
}

impl Environment for SkyLight {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let mut asking = Vec::new();
        let mut balls = Vec::new();
        for (number, request) in requests.iter().enumerate() {
            let Some(&radius) = request.parameters.first() else { continue };
            let radius = if radius > 0.0 { radius } else { self.radius };
            let center = request.position.as_dvec3();
            if center.is_finite() && radius.is_finite() && radius > 0.0 {
                balls.push(Ball { center, radius: f64::from(radius) });
                asking.push(number);
            }
        }
        for (number, (light, way)) in asking.into_iter().zip(self.light(&balls)) {
            let parameters = &mut *replies[number].parameters;
            parameters[0] = light as f32;
            if let [_, x, y, z, ..] = parameters {
                [*x, *y, *z] = way.normalize_or_zero().as_vec3().to_array();
            }
        }
        Ok(())
    }

    fn forgets(&self) -> bool {
        true
    }
}

/// Common area of two discs of radii `a` and `b` whose centers are `distance` apart.
pub(super) fn overlap(distance: f64, a: f64, b: f64) -> f64 {
    let (small, large) = (a.min(b), a.max(b));
    if distance >= a + b {
        return 0.0;
    }
    if distance <= large - small {
        return std::f64::consts::PI * small * small;
    }
    let (d, r, big) = (distance, small * small, large * large);
    let x = ((d * d + r - big) / (2.0 * d * small)).clamp(-1.0, 1.0);
    let y = ((d * d + big - r) / (2.0 * d * large)).clamp(-1.0, 1.0);
    let kite =
        (small + large - d) * (d + small - large) * (d - small + large) * (d + small + large);
    r * arc_cosine(x) + big * arc_cosine(y) - 0.5 * kite.max(0.0).sqrt()
}

/// Arc cosine to 2·10⁻⁸ (Abramowitz and Stegun 4.4.46): the same bits everywhere, and quick.
fn arc_cosine(x: f64) -> f64 {
    const TERMS: [f64; 8] = [
        1.570_796_305_0,
        -0.214_598_801_6,
        0.088_978_987_4,
        -0.050_174_304_6,
        0.030_891_881_0,
        -0.017_088_125_6,
        0.006_670_090_1,
        -0.001_262_491_1,
    ];
    let size = x.abs();
    let sum = TERMS.iter().rev().fold(0.0, |sum, term| sum * size + term);
    let angle = (1.0 - size).sqrt() * sum;
    if x < 0.0 { std::f64::consts::PI - angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(place: [f64; 3], radius: f64) -> Ball {
        Ball { center: DVec3::from_array(place), radius }
    }

    #[test]
    fn lenses_have_their_area() {
        for (distance, a, b) in [(1.0, 1.0, 1.0), (1.2, 0.7, 1.1), (0.45, 1.0, 0.6)] {
            // By counting grains of a fine grid.
            let (mut grains, step) = (0, 0.002);
            for x in -1000..1000 {
                for y in -1000..1000 {
                    let (x, y) = (f64::from(x) * step, f64::from(y) * step);
                    let first = x * x + y * y <= a * a;
                    grains += i32::from(first && (x - distance).powi(2) + y * y <= b * b);
                }
            }
            let counted = f64::from(grains) * step * step;
            assert!((overlap(distance, a, b) - counted).abs() < 2e-3, "{distance} {a} {b}");
        }
        assert!((arc_cosine(-0.3) - (-0.3_f64).acos()).abs() < 3e-8);
    }

    #[test]
    fn an_open_sky_gives_everything_and_a_cover_a_quarter() {
        let sky = SkyLight::nine(0.25);
        assert_eq!(sky.sources.len(), 9);
        let alone = sky.light(&[ball([0.0; 3], 0.5)]);
        assert!((alone[0].0 - 1.0).abs() < 1e-12);
        let covered = sky.light(&[ball([0.0; 3], 0.5), ball([0.0, 3.0, 0.0], 0.5)]);
        let zenith = sky.sources[0].share;
        assert!((covered[0].0 - (1.0 - 0.75 * zenith)).abs() < 1e-6, "only the zenith is covered");
        assert!((covered[1].0 - 1.0).abs() < 1e-12, "nothing is above the upper one");
        let two = [ball([0.0; 3], 0.5), ball([0.0, 3.0, 0.0], 0.5), ball([0.0, 5.0, 0.0], 0.5)];
        assert!((sky.light(&two)[0].0 - (1.0 - zenith * (1.0 - 0.0625))).abs() < 1e-6);
    }

    #[test]
    fn the_cells_change_nothing() {
        let sky = SkyLight::hemisphere(24, 0.25);
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let balls: Vec<Ball> = (0..300)
            .map(|_| ball([next() * 6.0, next() * 6.0, next() * 6.0], 0.1 + 0.5 * next()))
            .collect();
        let quick = sky.light(&balls);
        for (index, own) in balls.iter().enumerate() {
            let mut light = 0.0;
            for source in &sky.sources {
                let mut passing = 1.0;
                for other in &balls {
                    let way = other.center - own.center;
                    let ahead = way.dot(source.direction);
                    if ahead > 0.0 {
                        let apart = (way - source.direction * ahead).length();
                        let area = std::f64::consts::PI * own.radius * own.radius;
                        passing *= 1.0 - 0.75 * overlap(apart, own.radius, other.radius) / area;
                    }
                }
                light += source.share * passing;
            }
            assert!((quick[index].0 - light).abs() < 1e-5, "{index}: {} {light}", quick[index].0);
        }
    }

    #[test]
    fn rays_are_dimmed_by_their_way_through_balls() {
        let sky = SkyLight { by_area: false, ..SkyLight::new(&[(DVec3::Y, 1.0)], 0.6) };
        let light = sky.light(&[ball([0.0; 3], 1.0), ball([0.0, 5.0, 0.0], 1.0)]);
        assert!((light[0].0 - 0.6).abs() < 1e-12, "right through the middle: {}", light[0].0);
        let beside = sky.light(&[ball([0.0; 3], 1.0), ball([0.6, 5.0, 0.0], 1.0)]);
        assert!((beside[0].0 - libm::pow(0.6, 0.8)).abs() < 1e-12, "{}", beside[0].0);
    }
}
