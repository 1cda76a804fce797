/** The ripples of the water surface, a sum of sine waves on a tile that repeats; from the engine's rasterizer/waves.rs. */
export const WAVES = /* glsl */ `
/** Waves per tile along x and z, slope amplitude, turns per second. */
const vec4 WAVES[9] = vec4[9](
  vec4(2.0, 1.0, 0.10, 0.23), vec4(-1.0, 3.0, 0.09, 0.29), vec4(3.0, -2.0, 0.09, 0.31),
  vec4(1.0, 4.0, 0.08, 0.37), vec4(-4.0, -2.0, 0.07, 0.41), vec4(5.0, 2.0, 0.06, 0.47),
  vec4(-3.0, 5.0, 0.05, 0.53), vec4(6.0, -3.0, 0.04, 0.61), vec4(4.0, 7.0, 0.03, 0.67)
);

/** Beyond this distance the surface looks flat, metres. */
const float FLAT = 150.0;

/** Slope of the surface along x and z at a place given in tiles. */
vec2 tileSlope(vec2 at, float time) {
  vec2 slope = vec2(0.0);
  for (int i = 0; i < 9; i++) {
    vec4 wave = WAVES[i];
    float turns = fract(float(i) * 0.37 + dot(wave.xy, at) + time * wave.w);
    slope += wave.xy * (sin(turns * 6.2831853) * wave.z / length(wave.xy));
  }
  return slope;
}

/** Upward unit normal of the surface, calmer with distance. */
vec3 surfaceTilt(vec2 at, float away, float tileSize, float time) {
  float calm = 0.5 / (1.0 + away * 0.06) * max(0.0, 1.0 - away / FLAT);
  vec2 near = at / tileSize;
  vec2 slope = tileSlope(near, time) + tileSlope(vec2(near.y, -near.x) * 0.31, time);
  return normalize(vec3(-slope.x * calm, 1.0, -slope.y * calm));
}
`;
