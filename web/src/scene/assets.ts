import {
  BufferAttribute,
  LinearFilter,
  LinearMipmapLinearFilter,
  RepeatWrapping,
  SRGBColorSpace,
  Texture,
} from "three";
import type { Layout, MaterialMessage, MeshMessage, TextureMessage } from "../messages/types";
import { usedAssets } from "../messages/usage";

/** A mesh as it is drawn and measured. */
export interface MeshAsset {
  message: MeshMessage;
  attributes: Record<string, BufferAttribute>;
  index: BufferAttribute;
  /** Distance of the farthest vertex from the mesh's own origin, metres. */
  radius: number;
  /** Least and greatest corner. */
  box: [number, number, number, number, number, number];
}

interface Picture {
  texture: Texture;
  image: ImageBitmap | null;
}

/** Meshes, materials and textures by key; forgets what no layout uses any more. */
export class Assets {
  private meshes = new Map<number, MeshAsset>();
  private materials = new Map<number, MaterialMessage>();
  private pictures = new Map<number, Picture>();
  /** Names of assets that came after the latest layout: their first use is still ahead. */
  private fresh = new Set<string>();

  /** `anisotropy`: samples along the long side of a slanted texel. */
  constructor(private readonly anisotropy: number) {}

  /** How many of each are held. */
  get count(): { meshes: number; materials: number; textures: number } {
    return { meshes: this.meshes.size, materials: this.materials.size, textures: this.pictures.size };
  }

  mesh(key: number): MeshAsset | undefined {
    return this.meshes.get(key);
  }

  material(key: number): MaterialMessage | undefined {
    return this.materials.get(key);
  }

  texture(key: number | null): Texture | null {
    return key === null ? null : (this.pictures.get(key)?.texture ?? null);
  }

  addMesh(message: MeshMessage): void {
    this.meshes.set(message.key, meshAsset(message));
    this.fresh.add(`mesh:${message.key}`);
  }

  addMaterial(message: MaterialMessage): void {
    this.materials.set(message.key, message);
    this.fresh.add(`material:${message.key}`);
  }

  addTexture(message: TextureMessage): void {
    this.pictures.get(message.key)?.texture.dispose();
    const picture: Picture = { texture: emptyTexture(this.anisotropy), image: null };
    this.pictures.set(message.key, picture);
    this.fresh.add(`texture:${message.key}`);
    const file = new Blob([message.png.slice()], { type: "image/png" });
    createImageBitmap(file, { colorSpaceConversion: "none", premultiplyAlpha: "none" }).then((image) => {
      if (this.pictures.get(message.key) !== picture) return image.close();
      picture.image = image;
      picture.texture.dispose(); // its storage on the graphics processor has the size of one texel
      picture.texture.image = image;
      picture.texture.needsUpdate = true;
    });
  }

  /** A layout has come: whatever came before it and is used by none may be forgotten. */
  settle(): void {
    this.fresh.clear();
  }

  /** Frees what none of these layouts uses, but for what came since the last of them. */
  keepFor(layouts: Iterable<Layout>): void {
    const links = {
      meshLevels: (key: number) => this.meshes.get(key)?.message.levels.map(([, level]) => level) ?? [],
      materialTexture: (key: number) => this.materials.get(key)?.texture ?? null,
    };
    const used = new Set<string>();
    for (const layout of layouts) for (const name of usedAssets(layout, links)) used.add(name);
    const kept = (name: string) => used.has(name) || this.fresh.has(name);
    for (const key of this.meshes.keys()) if (!kept(`mesh:${key}`)) this.meshes.delete(key);
    for (const key of this.materials.keys()) if (!kept(`material:${key}`)) this.materials.delete(key);
    for (const [key, picture] of this.pictures) {
      if (kept(`texture:${key}`)) continue;
      picture.texture.dispose();
      picture.image?.close();
      this.pictures.delete(key);
    }
  }

  clear(): void {
    for (const { texture, image } of this.pictures.values()) {
      texture.dispose();
      image?.close();
    }
    this.meshes.clear();
    this.materials.clear();
    this.pictures.clear();
    this.fresh.clear();
  }
}

function meshAsset(message: MeshMessage): MeshAsset {
  const attributes: Record<string, BufferAttribute> = {
    position: new BufferAttribute(message.positions, 3),
    normal: new BufferAttribute(message.normals, 3),
  };
  if (message.uvs?.length) attributes.uv = new BufferAttribute(message.uvs, 2);
  if (message.colors?.length) attributes.tone = new BufferAttribute(message.colors, 3);
  if (message.joint_indices && message.joint_weights && message.rest) {
    attributes.jointIndices = new BufferAttribute(message.joint_indices, 4);
    attributes.jointWeights = new BufferAttribute(message.joint_weights, 4);
  }
  const index = new BufferAttribute(message.triangles, 1);
  return { message, attributes, index, ...extent(message.positions) };
}

function extent(positions: Float32Array): Pick<MeshAsset, "radius" | "box"> {
  const box: MeshAsset["box"] = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
  let square = 0;
  for (let i = 0; i < positions.length; i += 3) {
    for (let axis = 0; axis < 3; axis++) {
      box[axis] = Math.min(box[axis], positions[i + axis]);
      box[axis + 3] = Math.max(box[axis + 3], positions[i + axis]);
    }
    square = Math.max(square, positions[i] ** 2 + positions[i + 1] ** 2 + positions[i + 2] ** 2);
  }
  return { radius: Math.sqrt(square), box };
}

/** A texture whose picture is still being unpacked: one white texel. */
function emptyTexture(anisotropy: number): Texture {
  const image = new ImageData(new Uint8ClampedArray([255, 255, 255, 255]), 1, 1);
  const texture = new Texture(image);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.magFilter = LinearFilter;
  texture.anisotropy = anisotropy;
  texture.flipY = false;
  texture.needsUpdate = true;
  return texture;
}
