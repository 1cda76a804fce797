import CameraControls from "camera-controls";
import { Box3, PerspectiveCamera, Vector3, type WebGLRenderer } from "three";
import { FIELD_OF_VIEW } from "../camera/orbit";
import type { Frame, Layout } from "../messages/types";
import { isSoftware } from "../scene/graphics";
import { QUALITIES, type Quality, QualityGovernor } from "../scene/quality";
import { Stage } from "../scene/stage";
import type { PlantMesh } from "./messages";
import { GROUND_KEY, groundMeshes, layoutOf, materials, plantMesh } from "./studio";

/** Height or breadth that a plant has on the stage, whose shadows are made for this size, metres. */
const SIZE = 7;
/** A plant that fills less or more than this share of its room is framed anew. */
const TOO_SMALL = 0.3;
const TOO_LARGE = 1.5;

/** How a picture is drawn that will stand for a while, where moving ones have to be coarse. */
const STILL: Quality = { ...QUALITIES[1], shafts: false, halo: false };
/** Milliseconds without motion before it is. */
const REST = 350;
/** Metres by which the plant stands left of the middle, to leave room for the sliders. */
const ASIDE = 0.75;

/** The plant, and the camera that goes round it. */
export class PlantView {
  readonly element = document.createElement("div");
  /** Pictures drawn. */
  pictures = 0;
  private readonly stage: Stage;
  private readonly camera = new PerspectiveCamera((FIELD_OF_VIEW * 180) / Math.PI, 1, 0.05, 3000);
  private readonly controls: CameraControls;
  private readonly governor: QualityGovernor;
  private readonly observer = new ResizeObserver(() => this.resize());
  private bounds = new Box3();
  /** What the stage has room for. */
  private room = new Box3();
  private scale = 1;
  private revision = 0;
  private outdated = true;
  private lastTime = 0;
  private lastMotion = 0;
  private fine = false;

  constructor(renderer: WebGLRenderer) {
    this.element.className = "bio-plant";
    const canvas = renderer.domElement;
    canvas.className = "bio-picture";
    this.element.append(canvas);
    this.stage = new Stage(renderer);
    this.governor = new QualityGovernor(isSoftware(renderer));
    this.controls = new CameraControls(this.camera, canvas);
    this.controls.smoothTime = 0.3;
    this.controls.draggingSmoothTime = 0.1;
    this.controls.minDistance = 0.5;
    this.controls.maxDistance = 80;
    this.controls.maxPolarAngle = 0.5 * Math.PI;
    void this.controls.setFocalOffset(ASIDE, 0, 0, false);
    void this.controls.setLookAt(4.2, 5, 13.5, 0, 0.46 * SIZE, 0, false);
    for (const material of materials()) this.stage.assets.addMaterial(material);
    for (const mesh of groundMeshes()) this.stage.assets.addMesh(mesh);
    this.observer.observe(this.element);
    requestAnimationFrame((now) => this.draw(now));
  }

  /** Height above its lowest point and greatest breadth of what is shown, in the plant's own metres. */
  get size(): { height: number; breadth: number } {
    const { x, y, z } = this.bounds.isEmpty() ? new Vector3() : this.bounds.getSize(new Vector3());
    return { height: y, breadth: Math.max(x, z) };
  }

  /** Shows a plant. A complete one that has outgrown its room, or fills little of it, gets another. */
  show(mesh: PlantMesh, complete: boolean): void {
    this.bounds.setFromArray(mesh.positions as unknown as number[]);
    const share = largest(this.bounds) / largest(this.room);
    const unfit =
      !(share > TOO_SMALL && share < TOO_LARGE) ||
      this.bounds.min.y < this.room.min.y - 0.05 * largest(this.room);
    if (!this.bounds.isEmpty() && (this.room.isEmpty() || (complete && unfit))) this.fit();
    this.revision += 1;
    this.stage.assets.settle();
    const key = GROUND_KEY + this.revision;
    const drawn = mesh.triangles.length > 0;
    if (drawn) this.stage.assets.addMesh(plantMesh(key, mesh));
    this.layOut(drawn ? key : null);
  }

  /** Gives what is shown the whole room, and looks at it from the front. */
  frame(): void {
    this.fit();
    const shape = this.bounds.getSize(new Vector3()).multiplyScalar(this.scale);
    const middle = this.bounds.getCenter(new Vector3()).multiplyScalar(this.scale);
    middle.y -= this.room.min.y * this.scale;
    const away = Math.max(shape.y, Math.max(shape.x, shape.z) / Math.max(0.4, this.camera.aspect)) / SIZE;
    this.controls.setLookAt(
      middle.x + 4.2 * away,
      middle.y + 1.7 * away,
      middle.z + 13.5 * away,
      middle.x,
      middle.y,
      middle.z,
      true,
    );
    this.showAgain();
  }

  private fit(): void {
    this.room.copy(this.bounds);
    this.room.min.y = Math.min(0, this.room.min.y);
    this.scale = SIZE / largest(this.room);
  }

  private layOut(key: number | null): void {
    const layout: Layout = layoutOf(this.revision, key, this.scale, -this.room.min.y * this.scale);
    this.stage.setLayout(layout, []);
    this.stage.setFrame(still(layout), true);
    this.outdated = true;
  }

  private showAgain(): void {
    const key = this.stage.layout?.batches.find((batch) => batch.name === "plant")?.mesh ?? null;
    this.revision += 1;
    this.layOut(key);
  }

  private draw(now: number): void {
    requestAnimationFrame((next) => this.draw(next));
    const passed = now - this.lastTime;
    this.lastTime = now;
    const moved = this.controls.update(Math.min(0.1, passed / 1000));
    const { layout } = this.stage;
    if (moved || this.outdated) this.lastMotion = now;
    else if (!this.fine && this.governor.level > 1 && now - this.lastMotion > REST) this.refine(true);
    if (!layout || !(moved || this.outdated)) return;
    if (this.fine && now === this.lastMotion) this.refine(false);
    if (moved && passed < 1000 && this.governor.note(passed)) this.resize();
    this.outdated = false;
    this.camera.updateMatrixWorld();
    this.stage.prepare(this.camera, { frame: still(layout), blend: 1, fresh: true, cut: true });
    this.stage.render(this.camera);
    this.pictures += 1;
  }

  /** Draws as finely as a picture that stands can be, or as coarsely as moving ones must. */
  private refine(fine: boolean): void {
    this.fine = fine;
    this.resize();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.stage.resize(
      width,
      height,
      window.devicePixelRatio,
      this.fine ? STILL : QUALITIES[this.governor.level],
    );
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.outdated = true;
  }
}

/** A frame in which everything stands where its layout says. */
function still(layout: Layout): Frame {
  return {
    type: "frame",
    layout: layout.revision,
    tick: 0,
    time: 0,
    running: false,
    speed: 1,
    rate: 0,
    moving: {},
    drifting: {},
  };
}

/** The longest side; tiny for an empty box. */
function largest(box: Box3): number {
  const { x, y, z } = box.getSize(new Vector3());
  return Math.max(x, y, z, 1e-9);
}
