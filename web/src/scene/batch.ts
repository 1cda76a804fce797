import {
  DynamicDrawUsage,
  type Frustum,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  type ShaderMaterial,
  Sphere,
  type Vector3,
} from "three";
import type { BatchLayout, Moving } from "../messages/types";
import {
  carryOver,
  placeAsLaidOut,
  placeAsMoved,
  placeBetween,
  poseAsMoved,
  poseAtRest,
} from "../playout/dequantize";
import type { Assets, MeshAsset } from "./assets";
import { NumberTexture } from "./number_texture";
import type { SharedUniforms } from "./shared_uniforms";
import { type BatchUniforms, createBatchUniforms, createSurfaceMaterial } from "./surface_material";

/** Things smaller on the screen than this many pixels are not drawn. */
const SMALLEST = 0.6;

/** From where a batch is looked at. */
export interface View {
  eye: Vector3;
  frustum: Frustum;
  /** Pixels that a thing of one metre spans at a distance of one metre. */
  pixels: number;
  /** Individual through whose eyes we look; its body is not drawn. */
  hidden: number;
}

/** Everything at one moment, on both sides of the bus. */
interface Moment {
  places: NumberTexture;
  poses: NumberTexture;
  /** As laid out: no frame has moved anything. */
  still: boolean;
  posed: boolean;
}

/** One mesh of a batch: the finest or a coarser one, with the list of the instances that it shows. */
interface Level {
  /** To use below this projected diameter in pixels. */
  pixels: number;
  mesh: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  pick: ShaderMaterial;
  slots: InstancedBufferAttribute;
  count: number;
}

const sphere = new Sphere();
const place = new Float32Array(8);

/** All instances of one mesh in one material, placed and posed on the graphics processor. */
export class Batch {
  readonly levels: Level[] = [];
  /** What throws shadows. */
  readonly shadow: Level;
  private older: Moment;
  private newer: Moment;
  private readonly tints: NumberTexture;
  private readonly uniforms: BatchUniforms;
  private readonly slotsById = new Map<number, number>();

  constructor(
    readonly number: number,
    public layout: BatchLayout,
    readonly asset: MeshAsset,
    private readonly assets: Assets,
    private readonly shared: SharedUniforms,
  ) {
    const material = assets.material(layout.material);
    if (!material) throw new Error(`the material of ${layout.name} is missing`);
    this.uniforms = createBatchUniforms(number, material.color);
    this.uniforms.uPicture.value = assets.texture(material.texture);
    this.tints = tintTexture(layout);
    this.uniforms.uTint.value = this.tints.texture;
    this.older = this.laidOut();
    this.newer = this.laidOut();
    this.bindMoments();
    this.levels.push(this.createLevel(asset, Infinity, "look"));
    for (const [pixels, key] of asset.message.levels) {
      const coarser = assets.mesh(key);
      if (coarser) this.levels.push(this.createLevel(coarser, pixels, "look"));
    }
    const coarser = asset.message.levels.length > 0 ? assets.mesh(asset.message.levels[0][1]) : undefined;
    this.shadow = this.createLevel(coarser ?? asset, Infinity, "shadow");
    layout.ids.forEach((id, slot) => {
      this.slotsById.set(id, slot);
    });
  }

  /** Number of the slot of an individual, −1 if it is not in this batch. */
  slotOf(id: number): number {
    return this.slotsById.get(id) ?? -1;
  }

  /** Place of an instance as drawn now: x, y, z, scale, quaternion. Valid until the next call. */
  placeOf(slot: number): Float32Array {
    placeBetween(place, this.older.places.data, this.newer.places.data, slot, this.shared.uBlend.value);
    return place;
  }

  /** Takes a new layout if it shows the same individuals with the same looks; else says no. */
  accepts(layout: BatchLayout): boolean {
    const old = this.layout;
    const same =
      old.mesh === layout.mesh &&
      old.material === layout.material &&
      old.joints === layout.joints &&
      old.alive === layout.alive &&
      sameNumbers(old.ids, layout.ids) &&
      sameNumbers(old.tints, layout.tints);
    if (!same) return false;
    if (!sameNumbers(old.transforms, layout.transforms)) this.older.still = this.newer.still = false;
    this.layout = layout;
    return true;
  }

  /** The last frame becomes the one before; takes what has moved in the new one. */
  advance(moving: Moving | undefined, cut: boolean): void {
    const spare = this.older;
    this.older = this.newer;
    this.newer = spare;
    if (!(moving === undefined && spare.still)) this.write(spare, moving);
    if (cut && !(spare.still && this.older.still)) this.copyNewerToOlder();
    this.bindMoments();
  }

  /** Starts from where the same individuals were in the layout before. */
  carry(from: Batch): void {
    const { joints } = this.layout;
    const posed = from.layout.joints === joints ? joints : 0;
    const [to, old] = [this.newer, from.newer];
    const source = { places: old.places.data, poses: old.poses.data };
    const target = { places: to.places.data, poses: to.poses.data };
    carryOver(target, this.layout.ids, source, from.layout.ids, posed);
    to.still = old.still && sameNumbers(this.layout.transforms, from.layout.transforms);
    to.posed = old.posed;
    send(to);
  }

  /** Chooses what to draw, and how finely. */
  cull(view: View): void {
    for (const level of this.levels) level.count = 0;
    const { places } = this.newer;
    for (let slot = 0; slot < this.layout.count; slot++) {
      const size = this.boundAt(places.data, slot);
      if (!view.frustum.intersectsSphere(sphere) || this.layout.ids[slot] === view.hidden) continue;
      const distance = Math.max(1e-3, sphere.center.distanceTo(view.eye) - size);
      const pixels = (2 * size * view.pixels) / distance;
      if (pixels >= SMALLEST) put(this.levelFor(pixels), slot);
    }
    for (const level of this.levels) finish(level);
  }

  /** Chooses what throws shadows into a part of the world. */
  cullShadows(frustum: Frustum): void {
    this.shadow.count = 0;
    for (let slot = 0; slot < this.layout.count; slot++) {
      this.boundAt(this.newer.places.data, slot);
      if (frustum.intersectsSphere(sphere)) put(this.shadow, slot);
    }
    finish(this.shadow);
  }

  dispose(): void {
    for (const level of [...this.levels, this.shadow]) {
      level.mesh.geometry.dispose();
      level.mesh.material.dispose();
      level.pick.dispose();
    }
    this.tints.dispose();
    for (const moment of [this.older, this.newer]) {
      moment.places.dispose();
      moment.poses.dispose();
    }
  }

  private boundAt(places: Float32Array, slot: number): number {
    const start = 8 * slot;
    sphere.center.set(places[start], places[start + 1], places[start + 2]);
    sphere.radius = 1.1 * this.asset.radius * places[start + 3];
    return sphere.radius;
  }

  private levelFor(pixels: number): Level {
    let chosen = this.levels[0];
    for (const level of this.levels) if (pixels < level.pixels) chosen = level;
    return chosen;
  }

  private laidOut(): Moment {
    const { count, joints } = this.layout;
    const places = new NumberTexture(2 * count);
    const poses = new NumberTexture(2 * count * joints);
    placeAsLaidOut(places.data, this.layout);
    poseAtRest(poses.data);
    return { places, poses, still: true, posed: false };
  }

  private write(moment: Moment, moving: Moving | undefined): void {
    placeAsLaidOut(moment.places.data, this.layout);
    if (moving) placeAsMoved(moment.places.data, moving);
    const { rest } = this.asset.message;
    if (moving?.poses && rest) {
      poseAsMoved(moment.poses.data, moving.poses, moving.extent ?? 1, rest);
      moment.posed = true;
      moment.poses.send();
    } else if (moment.posed) {
      poseAtRest(moment.poses.data);
      moment.posed = false;
      moment.poses.send();
    }
    moment.still = moving === undefined;
    moment.places.send();
  }

  private copyNewerToOlder(): void {
    this.older.places.data.set(this.newer.places.data);
    this.older.poses.data.set(this.newer.poses.data);
    this.older.still = this.newer.still;
    this.older.posed = this.newer.posed;
    send(this.older);
  }

  private bindMoments(): void {
    this.uniforms.uPlaceOlder.value = this.older.places.texture;
    this.uniforms.uPlaceNewer.value = this.newer.places.texture;
    this.uniforms.uPoseOlder.value = this.older.poses.texture;
    this.uniforms.uPoseNewer.value = this.newer.poses.texture;
  }

  private createLevel(asset: MeshAsset, pixels: number, purpose: "look" | "shadow"): Level {
    const material = this.assets.material(this.layout.material)!; // checked in the constructor
    const geometry = new InstancedBufferGeometry();
    for (const [name, attribute] of Object.entries(asset.attributes)) geometry.setAttribute(name, attribute);
    geometry.setIndex(asset.index);
    const slots = new InstancedBufferAttribute(new Float32Array(this.layout.count), 1);
    slots.setUsage(DynamicDrawUsage);
    geometry.setAttribute("slot", slots);
    const features = {
      joints: asset.attributes.jointIndices ? this.layout.joints : 0,
      uvs: "uv" in asset.attributes,
      colors: "tone" in asset.attributes,
    };
    const make = (what: "look" | "shadow" | "pick") =>
      createSurfaceMaterial(what, material, features, this.uniforms, this.shared);
    const mesh = new Mesh(geometry, make(purpose));
    mesh.frustumCulled = false;
    mesh.matrixAutoUpdate = false;
    return { pixels, mesh, pick: make("pick"), slots, count: 0 };
  }
}

function put(level: Level, slot: number): void {
  const list = level.slots.array as Float32Array;
  if (list[level.count] !== slot || level.slots.version === 0) {
    list[level.count] = slot;
    level.slots.needsUpdate = true;
  }
  level.count += 1;
}

function finish(level: Level): void {
  level.mesh.geometry.instanceCount = level.count;
  level.mesh.visible = level.count > 0;
}

function send(moment: Moment): void {
  moment.places.send();
  moment.poses.send();
}

type Numbers = Float32Array | Uint32Array;

function sameNumbers(a: Numbers | undefined, b: Numbers | undefined): boolean {
  if (!a || !b) return a === b;
  return a.length === b.length && a.every((number: number, index: number) => number === b[index]);
}

function tintTexture(layout: BatchLayout): NumberTexture {
  const store = new NumberTexture(layout.count);
  const { tints } = layout;
  for (let i = 0; i < layout.count; i++) {
    for (let k = 0; k < 3; k++) store.data[4 * i + k] = tints ? tints[3 * i + k] : 1;
  }
  return store;
}
