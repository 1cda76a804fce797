/**
 * Where a vertex of an instance stands: bends it by its joints between the last two frames, then places it.
 *
 * Attributes of the instance are its place as drawn now (x, y, z, scale; quaternion) and its number in the batch.
 * Textures hold, for the older and the newer frame, two texels per instance and joint (x, y, z, –; quaternion), the
 * joints' poses already multiplied by their inverse rest.
 */
export const PLACEMENT = /* glsl */ `
in vec4 stand;
in vec4 turned;
in float slot;
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

void bendByJoints(int instance, inout vec3 place, inout vec3 direction) {
#ifdef JOINTS
  vec3 bentPlace = vec3(0.0);
  vec3 bentDirection = vec3(0.0);
  for (int k = 0; k < 4; k++) {
    float weight = jointWeights[k];
    if (weight <= 0.0) continue;
    int number = 2 * (instance * JOINTS + int(jointIndices[k] + 0.5));
    vec3 offset = texelOf(uPoseNewer, number).xyz;
    vec4 rotation = texelOf(uPoseNewer, number + 1);
    if (uBlend < 1.0) {
      offset = mix(texelOf(uPoseOlder, number).xyz, offset, uBlend);
      rotation = between(texelOf(uPoseOlder, number + 1), rotation);
    }
    bentPlace += weight * (offset + turn(rotation, place));
    bentDirection += weight * turn(rotation, direction);
  }
  place = bentPlace;
  direction = bentDirection;
#endif
}

void standInWorld(inout vec3 place, inout vec3 direction) {
  place = stand.xyz + stand.w * turn(turned, place);
  direction = turn(turned, direction);
}
`;
