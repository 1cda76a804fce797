import { type Frustum, Sphere, type Vector3 } from "three";
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
import { Level } from "./level";
import { NumberTexture } from "./number_texture";
import type { SharedUniforms } from "./shared_uniforms";
import { type BatchUniforms, createBatchUniforms, createSurfaceMaterial } from "./surface_material";

/** Things smaller on the screen than this many pixels are not drawn. */
const SMALLEST = 1;

/** From where a batch is looked at. */
export interface View {
  eye: Vector3;
  frustum: Frustum;
  /** Pixels that a thing of one metre spans at a distance of one metre. */
  pixels: number;
  /** Share of their size on the screen by which coarser meshes are chosen. */
  detail: number;
  /** Individual through whose eyes we look; its body is not drawn. */
  hidden: number;
}

/** Everything at one moment. */
interface Moment {
  /** Eight numbers per instance: x, y, z, scale and a quaternion. */
  places: Float32Array;
  poses: NumberTexture;
  /** As laid out: no frame has moved anything. */
  still: boolean;
  posed: boolean;
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
  private readonly uniforms: BatchUniforms;
  private readonly slotsById = new Map<number, number>();
  /** Whether one sees through it; then it throws no shadow. */
  private readonly veils: boolean;

  constructor(
    readonly number: number,
    public layout: BatchLayout,
    public asset: MeshAsset,
    private readonly assets: Assets,
    private readonly shared: SharedUniforms,
  ) {
    const material = assets.material(layout.material);
    if (!material) throw new Error(`the material of ${layout.name} is missing`);
    this.veils = material.opacity < 1;
    this.uniforms = createBatchUniforms(number, material.color);
    this.uniforms.uPicture.value = assets.texture(material.texture);
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
    placeBetween(place, this.older.places, this.newer.places, slot, this.shared.uBlend.value);
    return place;
  }

  /** Takes a new layout if it shows the same individuals in the same material; else says no. */
  accepts(layout: BatchLayout): boolean {
    const old = this.layout;
    if (old === layout) return true;
    const same =
      old.material === layout.material &&
      old.joints === layout.joints &&
      old.alive === layout.alive &&
      sameNumbers(old.ids, layout.ids) &&
      sameNumbers(old.tints, layout.tints);
    if (!same || !(old.mesh === layout.mesh || this.reshape(layout))) return false;
    if (!sameNumbers(old.transforms, layout.transforms)) this.older.still = this.newer.still = false;
    this.layout = layout;
    return true;
  }

  /** Shows another mesh of the same kind, as a plant that has grown; says no if it is of another kind. */
  private reshape(layout: BatchLayout): boolean {
    const asset = this.assets.mesh(layout.mesh);
    const kind = ({ message, attributes }: MeshAsset) => [message.levels.length, ...Object.keys(attributes)];
    if (!asset || this.levels.length > 1 || String(kind(asset)) !== String(kind(this.asset))) return false;
    this.asset = asset;
    for (const level of [...this.levels, this.shadow]) level.reshape(asset);
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
    const source = { places: old.places, poses: old.poses.data };
    const target = { places: to.places, poses: to.poses.data };
    carryOver(target, this.layout.ids, source, from.layout.ids, posed);
    to.still = old.still && sameNumbers(this.layout.transforms, from.layout.transforms);
    to.posed = old.posed;
    to.poses.send();
  }

  /** Chooses what to draw, and how finely. */
  cull(view: View): void {
    for (const level of this.levels) level.begin();
    const { ids, tints, count } = this.layout;
    for (let slot = 0; slot < count; slot++) {
      const size = this.boundAt(this.newer.places, slot);
      if (!view.frustum.intersectsSphere(sphere) || ids[slot] === view.hidden) continue;
      const distance = Math.max(1e-3, sphere.center.distanceTo(view.eye) - size);
      const pixels = (2 * size * view.pixels) / distance;
      if (pixels >= SMALLEST) this.levelFor(pixels * view.detail).put(slot, this.placeOf(slot), tints);
    }
    for (const level of this.levels) level.finish();
  }

  /** Chooses what throws shadows into a part of the world. */
  cullShadows(frustum: Frustum): void {
    this.shadow.begin();
    const count = this.veils ? 0 : this.layout.count;
    for (let slot = 0; slot < count; slot++) {
      this.boundAt(this.newer.places, slot);
      if (frustum.intersectsSphere(sphere)) this.shadow.put(slot, this.placeOf(slot), undefined);
    }
    this.shadow.finish();
  }

  /** Draws the edges of triangles instead of surfaces. */
  drawEdges(on: boolean): void {
    for (const level of this.levels) level.mesh.material.wireframe = on;
  }

  dispose(): void {
    for (const level of [...this.levels, this.shadow]) level.dispose();
    for (const moment of [this.older, this.newer]) moment.poses.dispose();
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
    const places = new Float32Array(8 * count);
    const poses = new NumberTexture(2 * count * joints);
    placeAsLaidOut(places, this.layout);
    poseAtRest(poses.data);
    return { places, poses, still: true, posed: false };
  }

  private write(moment: Moment, moving: Moving | undefined): void {
    placeAsLaidOut(moment.places, this.layout);
    if (moving) placeAsMoved(moment.places, moving);
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
  }

  private copyNewerToOlder(): void {
    this.older.places.set(this.newer.places);
    this.older.poses.data.set(this.newer.poses.data);
    this.older.still = this.newer.still;
    this.older.posed = this.newer.posed;
    this.older.poses.send();
  }

  private bindMoments(): void {
    this.uniforms.uPoseOlder.value = this.older.poses.texture;
    this.uniforms.uPoseNewer.value = this.newer.poses.texture;
  }

  private createLevel(asset: MeshAsset, pixels: number, purpose: "look" | "shadow"): Level {
    const material = this.assets.material(this.layout.material)!; // checked in the constructor
    const features = {
      joints: asset.attributes.jointIndices ? this.layout.joints : 0,
      uvs: "uv" in asset.attributes,
      colors: "tone" in asset.attributes,
    };
    const make = (what: "look" | "shadow" | "pick") =>
      createSurfaceMaterial(what, material, features, this.uniforms, this.shared);
    return new Level(asset, pixels, this.layout.count, make(purpose), make("pick"));
  }
}

type Numbers = Float32Array | Uint32Array;

function sameNumbers(a: Numbers | undefined, b: Numbers | undefined): boolean {
  if (!a || !b) return a === b;
  return a.length === b.length && a.every((number: number, index: number) => number === b[index]);
}
