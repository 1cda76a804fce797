import { Frustum, Matrix4, type PerspectiveCamera, Scene, Vector3, type WebGLRenderer } from "three";
import type { Frame, Layout, Message } from "../messages/types";
import type { Label } from "../overlays/marks";
import type { Moment } from "../playout/queue";
import { Assets } from "./assets";
import { Background } from "./background";
import { Batch, type View } from "./batch";
import { Caustics } from "./caustics";
import { Develop } from "./develop";
import { createPicture, isSoftware } from "./graphics";
import { Ground } from "./ground";
import { createCameraUniforms, Points } from "./points";
import { QUALITIES, type Quality } from "./quality";
import { Shadows } from "./shadows";
import { Shafts } from "./shafts";
import { applyLight, createSharedUniforms } from "./shared_uniforms";
import { WaterSurface } from "./water_surface";

/** Seconds after which the waves repeat. */
const WAVE_PERIOD = 100;
/** Radius round the point of interest within which things throw shadows, metres. */
const SHADOW_RADIUS = 14;
/** How far ahead of the camera that point lies, metres. */
const SHADOW_AHEAD = 8;

/** Everything that is drawn: takes layouts and frames, gives pictures. */
export class Stage {
  readonly scene = new Scene();
  readonly assets: Assets;
  readonly shared = createSharedUniforms();
  readonly cameraUniforms = createCameraUniforms();
  readonly batches = new Map<string, Batch>();
  readonly points = new Map<string, Points>();
  readonly ground = new Ground();
  layout: Layout | null = null;
  /** Individual through whose eyes we look. */
  hidden = 0;
  private quality: Quality = QUALITIES[0];
  private picture;
  private readonly caustics: Caustics;
  private readonly shadows = new Shadows(this.shared);
  private readonly background = new Background(this.shared);
  private readonly surface = new WaterSurface(this.shared);
  private readonly shafts = new Shafts(this.shared);
  private readonly develop = new Develop();
  private readonly frustum = new Frustum();
  private readonly matrix = new Matrix4();
  private batchNumber = 0;
  private outdated = false;
  private before: { time: number } | null = null;
  private current: Frame | null = null;
  private edges = false;

  constructor(readonly renderer: WebGLRenderer) {
    const software = isSoftware(renderer);
    this.assets = new Assets(software ? 1 : 4);
    this.caustics = new Caustics(software ? 128 : 256);
    this.scene.matrixWorldAutoUpdate = false;
    this.scene.add(this.background.mesh, this.surface.mesh);
    this.shared.uCausticTile.value = this.caustics.texture;
    this.picture = createPicture(1, 1, this.quality);
    this.shadows.resize(renderer, this.quality.shadowMap);
  }

  /** Whether only the edges of triangles are drawn. */
  get wireframe(): boolean {
    return this.edges;
  }

  set wireframe(on: boolean) {
    this.edges = on;
    for (const batch of this.batches.values()) batch.drawEdges(on);
  }

  /** What is shown is of another connection: the next layout replaces all of it, whatever its keys. */
  outdate(): void {
    this.outdated = true;
  }

  /** Takes an asset; says whether the message was one. */
  takeAsset(message: Message): boolean {
    if (message.type === "mesh") this.assets.addMesh(message);
    else if (message.type === "material") this.assets.addMaterial(message);
    else if (message.type === "texture") this.assets.addTexture(message);
    else return false;
    return true;
  }

  /**
   * Rebuilds what a new layout has changed; throws if it needs an asset that never came.
   * `coming` are layouts received but not yet shown.
   */
  setLayout(layout: Layout, coming: Layout[]): void {
    this.layout = layout;
    applyLight(this.shared, layout);
    this.setBatches(layout);
    this.setPoints(layout);
    this.outdated = false;
    this.assets.keepFor([layout, ...coming]);
    this.ground.measure(this.batches.values());
  }

  /** Places everything as a frame of the present layout says. */
  setFrame(frame: Frame, cut: boolean): void {
    this.before = cut ? frame : this.current;
    this.current = frame;
    for (const [name, batch] of this.batches) batch.advance(frame.moving[name], cut);
    for (const [name, points] of this.points) points.advance(frame.drifting[name], cut);
  }

  /** All that lives and moves about, with its place. */
  labels(): Label[] {
    const moving = [...this.batches.values()].filter(
      ({ layout }) => layout.alive && this.current?.moving[layout.name]?.positions,
    );
    return moving.flatMap((batch) =>
      [...batch.layout.ids].map((id, slot) => {
        const [x, y, z] = batch.placeOf(slot);
        return { id, species: batch.layout.species, place: [x, y, z] as [number, number, number] };
      }),
    );
  }

  /** The picture has this size in pixels of the screen. */
  resize(width: number, height: number, ratio: number, quality: Quality): void {
    this.quality = quality;
    const even = (side: number) =>
      Math.max(2, 2 * Math.round((side * Math.min(ratio, quality.pixelRatio)) / 2));
    const [w, h] = [even(width), even(height)]; // video encoders want even sides
    this.renderer.setSize(w, h, false);
    this.picture.depthTexture?.dispose();
    this.picture.dispose();
    this.picture = createPicture(w, h, quality);
    this.shadows.resize(this.renderer, quality.shadowMap);
    this.shafts.resize(w, h);
  }

  /** Places batches between the last two frames, chooses what to draw and how finely. */
  prepare(camera: PerspectiveCamera, moment: Moment): void {
    this.shared.uBlend.value = this.quality.smooth ? moment.blend : 1;
    const from = this.before ? this.before.time : moment.frame.time;
    const time = from + (moment.frame.time - from) * this.shared.uBlend.value;
    this.shared.uTime.value = ((time % WAVE_PERIOD) + WAVE_PERIOD) % WAVE_PERIOD;
    const view = this.viewOf(camera);
    for (const batch of this.batches.values()) batch.cull(view);
  }

  /** Draws the picture on the canvas. */
  render(camera: PerspectiveCamera): void {
    const { renderer, shared } = this;
    if (shared.uWater.value) this.caustics.render(renderer, shared.uTime.value);
    const ahead = camera.getWorldDirection(new Vector3());
    const center = camera.position.clone().addScaledVector(ahead, SHADOW_AHEAD);
    this.shadows.render(renderer, this.batches.values(), center, SHADOW_RADIUS);
    this.background.update(camera);
    this.surface.update(camera.position);
    renderer.setRenderTarget(this.picture);
    renderer.clear();
    renderer.render(this.scene, camera);
    const beams = this.quality.shafts && shared.uWater.value && shared.uShafts.value > 0;
    if (beams) this.shafts.render(renderer, camera, this.picture.depthTexture!);
    this.develop.render(
      renderer,
      this.picture.texture,
      beams ? this.shafts.texture : null,
      this.quality.halo,
    );
  }

  /** Where an individual is: its batch and slot; null if it is not in the scene. */
  find(id: number): { batch: Batch; slot: number } | null {
    if (id === 0) return null;
    for (const batch of this.batches.values()) {
      const slot = batch.slotOf(id);
      if (slot >= 0) return { batch, slot };
    }
    return null;
  }

  private clear(): void {
    for (const name of [...this.batches.keys()]) this.removeBatch(name);
    for (const name of [...this.points.keys()]) this.removePoints(name);
    this.assets.clear();
    this.layout = this.current = this.before = null;
  }

  dispose(): void {
    this.clear();
    for (const part of [
      this.caustics,
      this.shadows,
      this.background,
      this.surface,
      this.shafts,
      this.develop,
    ]) {
      part.dispose();
    }
    this.picture.depthTexture?.dispose();
    this.picture.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private viewOf(camera: PerspectiveCamera): View {
    const height = this.renderer.domElement.height;
    const pixels = height / (2 * Math.tan((camera.fov * Math.PI) / 360));
    this.matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    this.frustum.setFromProjectionMatrix(this.matrix);
    this.shared.uEye.value.copy(camera.position);
    this.cameraUniforms.uPixels.value = pixels;
    camera.matrixWorld.extractBasis(
      this.cameraUniforms.uRight.value,
      this.cameraUniforms.uUp.value,
      new Vector3(),
    );
    return {
      eye: camera.position,
      frustum: this.frustum,
      pixels,
      detail: this.quality.detail,
      hidden: this.hidden,
    };
  }

  private setBatches(layout: Layout): void {
    const names = new Set(layout.batches.map((batch) => batch.name));
    for (const name of [...this.batches.keys()]) if (!names.has(name)) this.removeBatch(name);
    for (const one of layout.batches) {
      const former = this.batches.get(one.name);
      if (!this.outdated && former?.accepts(one)) continue;
      const asset = this.assets.mesh(one.mesh);
      if (!asset) throw new Error(`the mesh of ${one.name} is missing`);
      this.batchNumber = (this.batchNumber % 4095) + 1;
      const batch = new Batch(this.batchNumber, one, asset, this.assets, this.shared);
      if (former && !this.outdated) batch.carry(former);
      for (const level of batch.levels) this.scene.add(level.mesh);
      batch.drawEdges(this.edges);
      this.shadows.scene.add(batch.shadow.mesh);
      if (former) this.removeBatch(one.name);
      this.batches.set(one.name, batch);
    }
  }

  private removeBatch(name: string): void {
    const batch = this.batches.get(name);
    if (!batch) return;
    for (const level of batch.levels) this.scene.remove(level.mesh);
    this.shadows.scene.remove(batch.shadow.mesh);
    batch.dispose();
    this.batches.delete(name);
  }

  private setPoints(layout: Layout): void {
    const names = new Set(layout.points.map((points) => points.name));
    for (const name of [...this.points.keys()]) if (!names.has(name)) this.removePoints(name);
    for (const one of layout.points) {
      if (this.points.get(one.name)?.fits(one)) continue;
      this.removePoints(one.name);
      const points = new Points(one, this.shared, this.cameraUniforms);
      this.points.set(one.name, points);
      this.scene.add(points.cloud);
    }
  }

  private removePoints(name: string): void {
    const points = this.points.get(name);
    if (!points) return;
    this.scene.remove(points.cloud);
    points.dispose();
    this.points.delete(name);
  }
}
