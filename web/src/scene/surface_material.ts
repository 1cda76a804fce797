import { Color, DoubleSide, FrontSide, GLSL3, ShaderMaterial, type Texture } from "three";
import type { MaterialMessage } from "../messages/types";
import { LIGHT } from "./shaders/light";
import { MEDIUM } from "./shaders/medium";
import { PLACEMENT } from "./shaders/placement";
import type { SharedUniforms } from "./shared_uniforms";

/** What a batch is drawn for: the picture, the sun's shadow, or to find out what lies under the pointer. */
export type Purpose = "look" | "shadow" | "pick";

/** Uniforms of one batch, shared by its materials of all purposes. */
export interface BatchUniforms {
  [name: string]: { value: unknown };
  uPoseOlder: { value: Texture | null };
  uPoseNewer: { value: Texture | null };
  uColor: { value: Color };
  uPicture: { value: Texture | null };
  uBatch: { value: number };
}

/** Features of a mesh that change the shader. */
export interface Features {
  joints: number;
  uvs: boolean;
  colors: boolean;
}

const VERTEX = /* glsl */ `
${PLACEMENT}
in vec3 tint;
out vec3 vPlace;
out vec3 vNormal;
out vec2 vUv;
out vec3 vTint;
flat out int vSlot;
#ifdef COLORS
in vec3 tone;
#endif

void main() {
  int instance = int(slot + 0.5);
  vec3 place = position;
  vec3 direction = normal;
  bendByJoints(instance, place, direction);
  standInWorld(place, direction);
  vPlace = place;
  vNormal = direction;
  vSlot = instance;
  vTint = tint;
#ifdef COLORS
  vTint *= tone;
#endif
#ifdef UVS
  vUv = uv;
#endif
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
`;

const HEAD = /* glsl */ `
in vec3 vPlace;
in vec3 vNormal;
in vec2 vUv;
in vec3 vTint;
flat in int vSlot;
uniform vec3 uColor;
uniform sampler2D uPicture;
uniform float uRoughness;
uniform float uSpecular;
uniform float uTranslucency;
uniform float uOpacity;
uniform int uBatch;
uniform vec3 uEye;
layout(location = 0) out vec4 outColor;

vec4 pictureAt() {
#ifdef PICTURE
  vec4 texel = texture(uPicture, vUv);
#ifdef CUTOUT
  if (texel.a < 0.5) discard;
#endif
  return texel;
#else
  return vec4(1.0);
#endif
}
`;

/** The last step of each purpose. */
const FRAGMENTS: Record<Purpose, string> = {
  look: /* glsl */ `
${HEAD}
${MEDIUM}
${LIGHT}
void main() {
  vec3 normal = normalize(vNormal) * (gl_FrontFacing ? 1.0 : -1.0);
  Finish finish = Finish(uColor * vTint * pictureAt().rgb, uSpecular, uRoughness, uTranslucency);
  float depth = depthOf(vPlace.y);
  vec3 sunlight = sunlightAt(depth) * causticAt(vPlace, depth) * sunlit(vPlace, normal);
  vec3 light = reflected(finish, sunlight, depth, normal, normalize(uEye - vPlace));
  outColor = vec4(arriving(light, uEye, vPlace), uOpacity);
}
`,
  shadow: /* glsl */ `
${HEAD}
void main() {
  outColor = pictureAt();
}
`,
  pick: /* glsl */ `
${HEAD}
void main() {
  pictureAt();
  int low = vSlot & 255;
  int middle = (vSlot >> 8) & 255;
  int high = ((vSlot >> 16) & 15) | ((uBatch & 15) << 4);
  outColor = vec4(low, middle, high, uBatch >> 4) / 255.0;
}
`,
};

/** A material of a batch for one purpose; it shares the uniforms it is given. */
export function createSurfaceMaterial(
  purpose: Purpose,
  material: MaterialMessage,
  features: Features,
  uniforms: BatchUniforms,
  shared: SharedUniforms,
): ShaderMaterial {
  const defines: Record<string, string | number> = {};
  if (features.joints > 0) defines.JOINTS = features.joints;
  if (features.colors) defines.COLORS = 1;
  if (features.uvs) defines.UVS = 1;
  if (features.uvs && uniforms.uPicture.value) defines.PICTURE = 1;
  if (material.cutout) defines.CUTOUT = 1;
  const own = {
    uRoughness: { value: material.roughness },
    uSpecular: { value: material.specular },
    uTranslucency: { value: material.translucency },
    uOpacity: { value: material.opacity },
  };
  const veils = purpose === "look" && material.opacity < 1;
  return new ShaderMaterial({
    glslVersion: GLSL3,
    transparent: veils,
    depthWrite: !veils,
    defines,
    uniforms: { ...shared, ...uniforms, ...own },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENTS[purpose],
    side: material.two_sided || purpose !== "look" ? DoubleSide : FrontSide,
  });
}

/** Number of the batch and slot in it that a picked pixel names; batch 0 is nothing. */
export function pickedFrom(pixel: ArrayLike<number>): { batch: number; slot: number } {
  const slot = pixel[0] | (pixel[1] << 8) | ((pixel[2] & 15) << 16);
  return { batch: (pixel[2] >> 4) | (pixel[3] << 4), slot };
}

/** Uniforms of a batch that has nothing to show yet. */
export function createBatchUniforms(number: number, color: readonly number[]): BatchUniforms {
  return {
    uPoseOlder: { value: null },
    uPoseNewer: { value: null },
    uColor: { value: new Color(color[0], color[1], color[2]) },
    uPicture: { value: null },
    uBatch: { value: number },
  };
}
