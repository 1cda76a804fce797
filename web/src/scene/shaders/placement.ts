/**
 * Where a vertex of an instance stands: bends it by its joints, then places it, both between the last two frames.
 *
 * Textures hold, for the older and the newer frame, two texels per instance (x, y, z, scale; quaternion) and two per
 * instance and joint (x, y, z, –; quaternion), the joints' poses already multiplied by their inverse rest.
 */
export const PLACEMENT = /* glsl */ `
in float slot;
uniform highp sampler2D uPlaceOlder;
uniform highp sampler2D uPlaceNewer;
uniform float uBlend;
#ifdef JOINTS
in vec4 jointIndices;
in vec4 jointWeights;
uniform highp sampler2D uPoseOlder;
uniform highp sampler2D uPoseNewer;
#endif

vec4 texelOf(highp sampler2D store, int number) {
  int width = textureSize(store, 0).x;
  return texelFetch(store, ivec2(number % width, number / width), 0);
}

vec3 turn(vec4 q, vec3 v) {
  return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

vec4 between(vec4 older, vec4 newer) {
  return normalize(mix(dot(older, newer) < 0.0 ? -older : older, newer, uBlend));
}

void bend(int instance, inout vec3 place, inout vec3 direction) {
#ifdef JOINTS
  vec3 bentPlace = vec3(0.0);
  vec3 bentDirection = vec3(0.0);
  for (int k = 0; k < 4; k++) {
    float weight = jointWeights[k];
    if (weight <= 0.0) continue;
    int number = 2 * (instance * JOINTS + int(jointIndices[k] + 0.5));
    vec3 offset = mix(texelOf(uPoseOlder, number).xyz, texelOf(uPoseNewer, number).xyz, uBlend);
    vec4 rotation = between(texelOf(uPoseOlder, number + 1), texelOf(uPoseNewer, number + 1));
    bentPlace += weight * (offset + turn(rotation, place));
    bentDirection += weight * turn(rotation, direction);
  }
  place = bentPlace;
  direction = bentDirection;
#endif
}

void stand(int instance, inout vec3 place, inout vec3 direction) {
  vec4 older = texelOf(uPlaceOlder, 2 * instance);
  vec4 newer = texelOf(uPlaceNewer, 2 * instance);
  vec4 at = mix(older, newer, uBlend);
  vec4 rotation = between(texelOf(uPlaceOlder, 2 * instance + 1), texelOf(uPlaceNewer, 2 * instance + 1));
  place = at.xyz + at.w * turn(rotation, place);
  direction = turn(rotation, direction);
}
`;
