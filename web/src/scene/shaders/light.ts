/**
 * How a surface answers sun and sky; uses the medium chunk. Translated from the engine's rasterizer/light.rs, shadows
 * apart, which are the page's own.
 */
export const LIGHT = /* glsl */ `
uniform highp sampler2DShadow uShadowMap;
uniform mat4 uShadowMatrix;
uniform float uShadowTexel;
uniform bool uShadows;
uniform sampler2D uCausticTile;
uniform float uCaustics;
uniform float uCausticScale;
uniform float uTileSize;

/** Caustic pattern alone, read along the sun's rays; level 0 is sharp, each further one halves its detail. */
float causticPattern(vec3 place, float depth, float level) {
  vec2 entry = place.xz + uSunBelow.xz * (depth / uSunBelow.y);
  return textureLod(uCausticTile, entry / uTileSize, level).r;
}

/** Brightness of sunlight at a place: faint just below the surface, sharpest a little deeper, then softer; mean 1. */
float causticAt(vec3 place, float depth) {
  if (depth <= 0.0 || uCaustics <= 0.0) return 1.0;
  float strength = uCaustics * smoothstep(0.0, 2.0, depth / uCausticScale) * 14.0 / (14.0 + depth);
  return 1.0 + strength * (causticPattern(place, depth, log2(1.0 + depth * 0.35)) - 1.0);
}

/** Place in the shadow map, 0 to 1 each way. */
vec3 shadowPlace(vec3 place) {
  vec4 at = uShadowMatrix * vec4(place, 1.0);
  return at.xyz / at.w * 0.5 + 0.5;
}

/** Share of the sun that nothing stands in front of. */
float sunlit(vec3 place, vec3 normal) {
  if (!uShadows) return 1.0;
  vec3 at = shadowPlace(place + normal * 0.02);
  vec2 edge = abs(at.xy - 0.5);
  float outside = smoothstep(0.42, 0.5, max(edge.x, edge.y));
  if (outside >= 1.0 || at.z > 1.0) return 1.0;
  float lit = 0.0;
  for (int y = -1; y <= 1; y++) for (int x = -1; x <= 1; x++)
    lit += texture(uShadowMap, vec3(at.xy + vec2(x, y) * uShadowTexel * 1.25, at.z - 0.0008));
  return mix(lit / 9.0, 1.0, outside);
}

/** Diffuse radiance that a surface of this unit normal sees at this depth. */
vec3 ambientOf(vec3 normal, float depth) {
  float up = 0.5 + 0.5 * normal.y;
  if (depth <= 0.0) {
    vec3 low = mix(uHorizon, uNadir, 0.7);
    return mix(low, mix(uZenith, uHorizon, 0.3), up);
  }
  vec3 dim = exp(-uAbsorption * depth);
  vec3 side = uGlow * dim;
  vec3 through = (uZenith + uHorizon) * dim;
  vec3 above = side * 0.9 + through * 0.22;
  vec3 level = side * 0.7 + through * 0.06;
  vec3 below = side * 0.25 + through * 0.05;
  return mix(mix(below, level, min(1.0, up * 2.0)), above, max(0.0, up * 2.0 - 1.0));
}

/** Sunlight on a surface that faces the sun, before shadows and caustics. */
vec3 sunlightAt(float depth) {
  return depth <= 0.0 ? uSunColor : uSunColor * exp(uExtinction * (-depth / uSunBelow.y));
}

struct Finish {
  vec3 albedo;
  float specular;
  float roughness;
  float translucency;
};

/** Reflected share of sunlight per steradian (a spherical Gaussian of the roughness's width). */
float highlightOf(Finish finish, float fresnel, vec3 normal, vec3 halfway) {
  float width = max(0.03, finish.roughness * finish.roughness);
  float sharpness = 2.0 / (width * width);
  return fresnel * exp(sharpness * (dot(normal, halfway) - 1.0)) * (sharpness + 2.0) * 0.125 * 0.31830989;
}

/** Radiance that a surface sends to the eye; sunlight is what arrives at its place from the sun. */
vec3 reflected(Finish finish, vec3 sunlight, float depth, vec3 normal, vec3 toEye) {
  vec3 sun = depth > 0.0 ? uSunBelow : uSun;
  float facing = dot(normal, sun);
  float through = finish.translucency * max(0.0, -facing);
  vec3 even = sunlight * (0.31830989 * (max(0.0, facing) * (1.0 - 0.5 * finish.translucency) + through));
  float grazing = 1.0 - clamp(dot(normal, toEye), 0.0, 1.0);
  float fifth = grazing * grazing * grazing * grazing * grazing;
  float fresnel = finish.specular + (1.0 - finish.specular) * 0.3 * (1.0 - finish.roughness) * fifth;
  vec3 mirror = normal * (2.0 * dot(normal, toEye)) - toEye;
  vec3 image = ambientOf(mirror, depth) * (fresnel * (1.0 - 0.6 * finish.roughness));
  vec3 radiance = finish.albedo * (even + ambientOf(normal, depth)) * (1.0 - fresnel) + image;
  if (facing > 0.0)
    radiance += sunlight * (facing * highlightOf(finish, fresnel, normal, normalize(sun + toEye)));
  return radiance;
}
`;
