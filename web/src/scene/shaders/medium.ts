/**
 * What fills the space: how much light arrives through it, and its own glow. Translated from the engine's rasterizer
 * (crates/core/bioscope_geometry/src/rasterizer/light.rs), function by function, so that page, preview and retina agree.
 */
export const MEDIUM = /* glsl */ `
uniform bool uWater;
uniform float uSurface;
uniform vec3 uAbsorption;
uniform vec3 uExtinction;
uniform vec3 uGlow;
uniform vec3 uSun;
uniform vec3 uSunBelow;
uniform vec3 uSunColor;
uniform vec3 uZenith;
uniform vec3 uHorizon;
uniform vec3 uNadir;
const float REFRACTION = 1.34;
const float FAR_AWAY = 1e5;

/** Metres below the surface; negative in air. */
float depthOf(float height) {
  return uWater ? uSurface - height : -1.0;
}

/** Share of the medium's own light collected along a ray that rises by so much per metre. */
vec3 collected(float rise, float len) {
  vec3 rate = max(uExtinction - uAbsorption * rise, vec3(1e-6));
  return uExtinction / rate * (1.0 - exp(-rate * len));
}

/** Radiance that water sends towards an eye at this depth; brighter towards the sun. */
vec3 waterGlow(float depth, vec3 direction, float len) {
  float towards = max(0.0, dot(direction, uSunBelow));
  float square = towards * towards;
  float forward = 1.0 + 0.8 * square * square * towards;
  return uGlow * exp(-uAbsorption * max(depth, 0.0)) * collected(direction.y, len) * forward;
}

/** Sky in a direction, without the sun. */
vec3 skyOf(vec3 direction) {
  float rise = direction.y;
  return rise > 0.0 ? mix(uHorizon, uZenith, sqrt(rise)) : mix(uHorizon, uNadir, min(1.0, -rise * 4.0));
}

/** The sun's disc and its halo; blur widens the disc. */
vec3 sunDisc(vec3 direction, float blur) {
  float away = 1.0 - dot(direction, uSun);
  float disc = (1.0 - smoothstep(0.00005, 0.00012 + blur, away)) * 40.0 / (1.0 + blur * 4000.0);
  float halo = 0.6 * exp(-away * 60.0) + 1.5 * exp(-away * 900.0);
  return uSunColor * (disc + halo);
}

/** Unpolarized reflectance of the water surface for the cosines of the two angles. */
float fresnelOf(float inside, float outside) {
  float a = (inside - REFRACTION * outside) / (inside + REFRACTION * outside);
  float b = (REFRACTION * inside - outside) / (REFRACTION * inside + outside);
  return 0.5 * (a * a + b * b);
}

/** The underside of the surface: Snell's window with sky and sun, the mirror of the deep around it. */
vec3 windowOf(vec3 direction, vec3 tilt) {
  float inside = max(0.0, dot(direction, tilt));
  vec3 mirrored = direction - tilt * (2.0 * inside);
  vec3 deep = waterGlow(0.0, vec3(mirrored.x, min(mirrored.y, 0.0), mirrored.z), FAR_AWAY);
  float rest = 1.0 - REFRACTION * REFRACTION * (1.0 - inside * inside);
  if (rest <= 0.0) return deep;
  float outside = sqrt(rest);
  vec3 bent = direction * REFRACTION + tilt * (outside - REFRACTION * inside);
  vec3 seen = skyOf(vec3(bent.x, max(bent.y, 0.02), bent.z)) * 1.3 + sunDisc(bent, 0.002);
  return mix(seen, deep, fresnelOf(inside, outside));
}

/** Direction of a ray below the surface that came from above. */
vec3 bentDown(vec3 direction, vec3 tilt) {
  float outside = max(0.02, -dot(direction, tilt));
  float inside = sqrt(1.0 - (1.0 - outside * outside) / (REFRACTION * REFRACTION));
  return direction / REFRACTION + tilt * (outside / REFRACTION - inside);
}

/** What arrives at the eye of the radiance of a thing; what the water's surface adds is drawn with the surface. */
vec3 arriving(vec3 radiance, vec3 eye, vec3 place) {
  vec3 path = place - eye;
  float len = length(path);
  vec3 direction = path / max(len, 1e-5);
  if (!uWater) {
    vec3 kept = exp(-uExtinction * len);
    return radiance * kept + uGlow * (1.0 - kept);
  }
  float depth = uSurface - eye.y;
  float crossing = depth / direction.y;
  bool crosses = crossing > 0.0 && crossing < len;
  if (depth > 0.0) {
    float run = crosses ? crossing : len;
    return radiance * exp(-uExtinction * run) + waterGlow(depth, direction, run);
  }
  if (!crosses) return radiance;
  float run = len - crossing;
  vec3 bent = bentDown(direction, vec3(0.0, 1.0, 0.0));
  return radiance * exp(-uExtinction * run) + waterGlow(0.0, bent, run);
}
`;
