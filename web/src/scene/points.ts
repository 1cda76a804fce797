import {
  BufferAttribute,
  BufferGeometry,
  Color,
  CustomBlending,
  DynamicDrawUsage,
  GLSL3,
  OneFactor,
  OneMinusSrcAlphaFactor,
  Points as PointCloud,
  ShaderMaterial,
  Vector2,
  Vector3,
} from "three";
import type { Box, Drifting, PointsLayout } from "../messages/types";
import { LIGHT } from "./shaders/light";
import { MEDIUM } from "./shaders/medium";
import type { SharedUniforms } from "./shared_uniforms";

const VERTEX = /* glsl */ `
in vec3 older;
in vec3 newer;
in float girth;
uniform vec2 uRadius;
uniform vec3 uOlderLow;
uniform vec3 uOlderSize;
uniform vec3 uNewerLow;
uniform vec3 uNewerSize;
uniform float uBlend;
uniform float uPixels;
uniform vec3 uEye;
uniform vec3 uColor;
uniform float uOpacity;
out vec3 vLight;
out vec3 vPlace;
out vec3 vVeil;
out vec3 vThrough;
out float vAlpha;
${MEDIUM}
${LIGHT}

void main() {
  vec3 from = uOlderLow + older * uOlderSize;
  vec3 to = uNewerLow + newer * uNewerSize;
  vPlace = distance(from, to) > 0.5 ? to : mix(from, to, uBlend);
  float away = distance(vPlace, uEye);
  float radius = mix(uRadius.x, uRadius.y, girth);
  float size = 2.0 * radius * uPixels / max(away, 0.01);
  float shown = max(size, 1.6);
  float close = smoothstep(0.1, 0.45, away) * clamp(60.0 / shown, 0.25, 1.0);
  vAlpha = uOpacity * (size / shown) * (size / shown) * close;
  vec3 ahead = normalize(vPlace - uEye);
  float depth = depthOf(vPlace.y);
  float forward = 1.0 + 2.5 * pow(max(0.0, dot(ahead, depth > 0.0 ? uSunBelow : uSun)), 4.0);
  vec3 sun = sunlightAt(depth) * causticAt(vPlace, depth);
  vLight = uColor * (sun * 0.127324 * forward + ambientOf(vec3(0.0), depth));
  vVeil = arriving(vec3(0.0), uEye, vPlace);
  vThrough = arriving(vec3(1.0), uEye, vPlace) - vVeil;
  gl_PointSize = shown;
  gl_Position = projectionMatrix * viewMatrix * vec4(vPlace, 1.0);
}
`;

const HEAD = /* glsl */ `
in vec3 vLight;
in vec3 vPlace;
in vec3 vVeil;
in vec3 vThrough;
in float vAlpha;
layout(location = 0) out vec4 outColor;
`;

const MATT = /* glsl */ `
${HEAD}
void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  float cover = 1.0 - smoothstep(0.25, 1.0, dot(at, at));
  float alpha = vAlpha * cover;
  outColor = vec4((vLight * vThrough + vVeil) * alpha, alpha);
}
`;

/** A ball of gas: a bright rim (total reflection), the surroundings mirrored, a glint towards the sun. */
const GLASSY = /* glsl */ `
${HEAD}
${MEDIUM}
${LIGHT}
uniform vec3 uEye;
uniform vec3 uRight;
uniform vec3 uUp;
void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  at.y = -at.y;
  float square = dot(at, at);
  if (square > 1.0) discard;
  vec3 ahead = normalize(vPlace - uEye);
  vec3 normal = normalize(uRight * at.x + uUp * at.y - ahead * sqrt(1.0 - square));
  float edge = 1.0 - smoothstep(0.86, 1.0, square);
  float ring = smoothstep(0.45, 0.9, square);
  float depth = depthOf(vPlace.y);
  vec3 mirror = ambientOf(reflect(ahead, normal), depth);
  vec3 lamp = depth > 0.0 ? uSunBelow : uSun;
  vec3 sun = sunlightAt(depth);
  float glint = pow(max(0.0, dot(normal, normalize(lamp - ahead))), 90.0) * 3.0;
  glint += pow(max(0.0, dot(-normal, normalize(lamp + ahead * 0.5))), 24.0) * 0.35;
  vec3 color = mirror * (0.25 + 1.3 * ring) + vLight * 0.25 * ring + sun * glint;
  float alpha = edge * vAlpha * clamp(0.1 + 0.75 * ring + glint * 0.5, 0.0, 1.0);
  outColor = vec4((color * vThrough + vVeil) * alpha, alpha);
}
`;

const box = (target: { low: Vector3; size: Vector3 }, [x, y, z, X, Y, Z]: Box) => {
  target.low.set(x, y, z);
  target.size.set(X - x, Y - y, Z - z);
};

/** Plankton, bubbles, motes: one sprite each. */
export class Points {
  readonly cloud: PointCloud<BufferGeometry, ShaderMaterial>;
  private buffers: [BufferAttribute, BufferAttribute];
  private girths: BufferAttribute;
  private readonly boxes = [0, 1].map(() => ({ low: new Vector3(), size: new Vector3() }));
  private readonly radius = new Vector2();
  private newest = 0;
  private count = 0;

  constructor(
    readonly layout: PointsLayout,
    shared: SharedUniforms,
    camera: CameraUniforms,
  ) {
    this.buffers = [positionBuffer(1), positionBuffer(1)];
    this.girths = girthBuffer(1);
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      uniforms: {
        ...shared,
        ...camera,
        uRadius: { value: this.radius },
        uOlderLow: { value: null },
        uOlderSize: { value: null },
        uNewerLow: { value: null },
        uNewerSize: { value: null },
        uColor: { value: new Color(...layout.color) },
        uOpacity: { value: layout.opacity },
      },
      vertexShader: VERTEX,
      fragmentShader: layout.glassy ? GLASSY : MATT,
      depthWrite: false,
      transparent: true,
      premultipliedAlpha: true,
      blending: CustomBlending,
      blendSrc: OneFactor,
      blendDst: OneMinusSrcAlphaFactor,
    });
    this.cloud = new PointCloud(new BufferGeometry(), material);
    this.cloud.frustumCulled = false;
    this.cloud.renderOrder = 10;
    this.cloud.visible = false;
    this.bind();
  }

  /** Whether a layout shows the same points with the same looks. */
  fits(layout: PointsLayout): boolean {
    const old = this.layout;
    const looks = (one: PointsLayout) => `${one.color} ${one.opacity} ${one.glassy}`;
    return looks(old) === looks(layout);
  }

  /** Takes where the points have drifted to, and how many there are now. */
  advance(drifting: Drifting | undefined, cut: boolean): void {
    const count = (drifting?.positions.length ?? 0) / 3;
    this.cloud.visible = count > 0;
    const others = count !== this.count; // come or gone: nobody knows which is which
    this.count = count;
    if (!drifting || count === 0) return;
    this.makeRoom(count);
    this.newest = 1 - this.newest;
    this.write(this.newest, drifting);
    if (cut || others) this.write(1 - this.newest, drifting);
    this.radius.fromArray(drifting.radius);
    (this.girths.array as Uint8Array).set(drifting.radii.subarray(0, count));
    this.girths.needsUpdate = true;
    this.bind();
  }

  dispose(): void {
    this.cloud.geometry.dispose();
    this.cloud.material.dispose();
  }

  /** Makes the buffers longer if there are more points than ever. */
  private makeRoom(count: number): void {
    if (count <= this.girths.count) return;
    const room = Math.ceil(count * 1.3);
    this.cloud.geometry.dispose();
    this.cloud.geometry = new BufferGeometry();
    this.buffers = [positionBuffer(room), positionBuffer(room)];
    this.girths = girthBuffer(room);
  }

  private write(which: number, drifting: Drifting): void {
    (this.buffers[which].array as Uint16Array).set(drifting.positions);
    this.buffers[which].needsUpdate = true;
    box(this.boxes[which], drifting.box);
  }

  private bind(): void {
    const { geometry, material } = this.cloud;
    const [newer, older] = [this.newest, 1 - this.newest];
    geometry.setAttribute("position", this.buffers[newer]);
    geometry.setAttribute("newer", this.buffers[newer]);
    geometry.setAttribute("older", this.buffers[older]);
    geometry.setAttribute("girth", this.girths);
    geometry.setDrawRange(0, this.count);
    material.uniforms.uNewerLow.value = this.boxes[newer].low;
    material.uniforms.uNewerSize.value = this.boxes[newer].size;
    material.uniforms.uOlderLow.value = this.boxes[older].low;
    material.uniforms.uOlderSize.value = this.boxes[older].size;
  }
}

/** Uniforms of the camera in use, for what faces it. */
export function createCameraUniforms() {
  return {
    uPixels: { value: 1000 },
    uRight: { value: new Vector3(1, 0, 0) },
    uUp: { value: new Vector3(0, 1, 0) },
  };
}

export type CameraUniforms = ReturnType<typeof createCameraUniforms>;

function girthBuffer(count: number): BufferAttribute {
  const buffer = new BufferAttribute(new Uint8Array(count), 1, true);
  buffer.setUsage(DynamicDrawUsage);
  return buffer;
}

function positionBuffer(count: number): BufferAttribute {
  const buffer = new BufferAttribute(new Uint16Array(3 * count), 3, true);
  buffer.setUsage(DynamicDrawUsage);
  return buffer;
}
