import {
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  type ShaderMaterial,
} from "three";
import type { MeshAsset } from "./assets";

/** Numbers per instance of each attribute. */
const WIDTHS = { stand: 4, turned: 4, tint: 3, slot: 1 };

/** One mesh of a batch, the finest or a coarser one, with the instances that it shows. */
export class Level {
  readonly mesh: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private readonly stands: Float32Array;
  private readonly turns: Float32Array;
  private readonly tints: Float32Array;
  private readonly slots: Float32Array;
  private readonly changing: InstancedBufferAttribute[] = [];
  private count = 0;

  /** `pixels`: to use below this projected diameter; `capacity`: instances at most. */
  constructor(
    asset: MeshAsset,
    readonly pixels: number,
    capacity: number,
    look: ShaderMaterial,
    readonly pick: ShaderMaterial,
  ) {
    const geometry = new InstancedBufferGeometry();
    wear(geometry, asset);
    const add = (name: keyof typeof WIDTHS) => {
      const array = new Float32Array(capacity * WIDTHS[name]);
      const attribute = new InstancedBufferAttribute(array, WIDTHS[name]);
      attribute.setUsage(DynamicDrawUsage);
      geometry.setAttribute(name, attribute);
      this.changing.push(attribute);
      return array;
    };
    this.stands = add("stand");
    this.turns = add("turned");
    this.tints = add("tint");
    this.slots = add("slot");
    this.mesh = new Mesh(geometry, look);
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
  }

  /** Shows another mesh from now on. */
  reshape(asset: MeshAsset): void {
    this.mesh.geometry.dispose(); // its storage on the graphics processor
    wear(this.mesh.geometry, asset);
  }

  /** Begins a new list of instances. */
  begin(): void {
    this.count = 0;
  }

  /** Adds an instance at a place (eight numbers). */
  put(slot: number, place: Float32Array, tints: Float32Array | undefined): void {
    const at = this.count++;
    this.slots[at] = slot;
    for (let k = 0; k < 4; k++) {
      this.stands[4 * at + k] = place[k];
      this.turns[4 * at + k] = place[4 + k];
    }
    for (let k = 0; k < 3; k++) this.tints[3 * at + k] = tints ? tints[3 * slot + k] : 1;
  }

  /** Ends the list: it is drawn from now on. */
  finish(): void {
    this.mesh.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    if (this.count === 0) return;
    for (const attribute of this.changing) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, this.count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.pick.dispose();
  }
}

function wear(geometry: InstancedBufferGeometry, asset: MeshAsset): void {
  for (const [name, attribute] of Object.entries(asset.attributes)) geometry.setAttribute(name, attribute);
  geometry.setIndex(asset.index);
}
