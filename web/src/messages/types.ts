/** What the world tells the page; see docs/reference/stream.md. Metres, seconds, radians, linear color. */

export type Color = [number, number, number];
export type Point = [number, number, number];

/** Least and greatest corner: x, y, z, X, Y, Z. */
export type Box = [number, number, number, number, number, number];

declare const __VERSION__: string;

/** Version of this page; the world's must be the same. */
export const VERSION: string = __VERSION__;

export interface Rig {
  name: string;
  kind: "fixed" | "orbit" | "follow";
  /** Vertical angle of view. */
  field_of_view: number;
  position?: Point;
  target?: Point;
  radius?: number;
  height?: number;
  /** Seconds per turn. */
  period?: number;
  species?: string;
  index?: number;
  /** Body lengths, in the animal's frame. */
  offset?: Point;
}

export interface Hello {
  type: "hello";
  version: string;
  world: string;
  title: string;
  seed: number;
  /** Seconds per tick. */
  dt: number;
  cameras: Rig[];
  /** The world's shot list: names of cameras and the seconds that each is held. */
  shots?: [string, number][];
  page: string[];
  /** What can be added to the world; absent in recordings. */
  catalog?: Catalog;
}

/** Species of fish, those among them that hunt, and models of plants. */
export interface Catalog {
  fish: string[];
  hunters: string[];
  plants: string[];
  /** How many leaves a plant has, by the names of the models that count them. */
  leaves?: Record<string, number>;
}

export interface MeshMessage {
  type: "mesh";
  key: number;
  positions: Float32Array;
  normals: Float32Array;
  uvs?: Float32Array;
  colors?: Float32Array;
  triangles: Uint32Array;
  parents?: Int8Array;
  /** Eight numbers per joint: x, y, z, scale, qx, qy, qz, qw. */
  rest?: Float32Array;
  joint_indices?: Uint8Array;
  joint_weights?: Float32Array;
  /** Coarser meshes: to use below this projected diameter in pixels. */
  levels: [number, number][];
}

export interface TextureMessage {
  type: "texture";
  key: number;
  width: number;
  height: number;
  png: Uint8Array;
}

export interface MaterialMessage {
  type: "material";
  key: number;
  name: string;
  color: Color;
  texture: number | null;
  cutout: boolean;
  roughness: number;
  specular: number;
  translucency: number;
  opacity: number;
  two_sided: boolean;
}

/** A batch as the stream describes it; layouts refer to it by its key. */
export interface BatchMessage extends BatchLayout {
  type: "batch";
  key: number;
}

export interface BatchLayout {
  /** By which the world's layouts mean it; absent in layouts that this page has made. */
  key?: number;
  name: string;
  species: string;
  mesh: number;
  material: number;
  alive: boolean;
  count: number;
  ids: Uint32Array;
  /** Eight numbers per instance: x, y, z, scale, qx, qy, qz, qw. */
  transforms: Float32Array;
  tints?: Float32Array;
  /** Joint poses per instance; 0 for a rigid batch. */
  joints: number;
}

export interface PointsLayout {
  name: string;
  species: string;
  color: Color;
  opacity: number;
  glassy: boolean;
}

export interface Sun {
  direction: Point;
  color: Color;
}

export interface Sky {
  zenith: Color;
  horizon: Color;
  nadir: Color;
}

export interface Medium {
  /** Height of the water surface; null for air throughout. */
  surface: number | null;
  absorption: Color;
  scattering: Color;
  glow: Color;
  caustics: number;
  caustic_scale: number;
  shafts: number;
}

export interface Layout {
  type: "layout";
  revision: number;
  batches: BatchLayout[];
  points: PointsLayout[];
  sun: Sun;
  sky: Sky;
  medium: Medium;
  bounds: Box;
}

export interface Moving {
  box?: Box;
  positions?: Uint16Array;
  rotations?: Int16Array;
  /** Least and greatest scale. */
  size?: [number, number];
  /** 0 to 65535 from the least to the greatest. */
  scales?: Uint16Array;
  extent?: number;
  poses?: Int16Array;
}

export interface Drifting {
  box: Box;
  positions: Uint16Array;
  /** Least and greatest radius, metres. */
  radius: [number, number];
  /** 0 to 255 from the least to the greatest. */
  radii: Uint8Array;
}

export interface Annotation {
  subject: number;
  role: string;
  line?: Box;
  center?: Point;
  radius?: number;
  position?: Point;
  text?: string;
}

export interface Frame {
  type: "frame";
  layout: number;
  tick: number;
  time: number;
  running: boolean;
  speed: number | null;
  rate: number;
  moving: Record<string, Moving>;
  drifting: Record<string, Drifting>;
  annotations?: Annotation[];
}

export interface Parameter {
  name: string;
  unit: string;
  minimum: number;
  maximum: number;
  default: number;
  meaning: string;
  source: string;
  value: number;
  /** Value with which the world began; absent if the world does not say. */
  initial?: number;
}

export interface Owner {
  name: string;
  parameters: Parameter[];
}

export interface ParametersMessage {
  type: "parameters";
  owners: Owner[];
}

export type Value = boolean | number | string | number[];

export interface WorldEvent {
  tick: number;
  time: number;
  kind: string;
  subject: number;
  object: number | null;
  data: Record<string, Value>;
}

export interface EventsMessage {
  type: "events";
  events: WorldEvent[];
}

export interface Statistics {
  type: "statistics";
  tick: number;
  time: number;
  values: Record<string, number>;
}

export interface Timeline {
  type: "timeline";
  first: number;
  last: number;
}

export interface Retina {
  width: number;
  height: number;
  /** Pictures side by side: one, or the left and the right eye's. */
  eyes: number;
  color: Uint8Array;
  depth: Float32Array;
  identity: Uint32Array;
  field_of_view: number;
}

export interface Inspection {
  type: "inspection";
  tick: number;
  time: number;
  id: number;
  species: string;
  population: string;
  behavior: string | null;
  values: Record<string, Value>;
  /** Its own values of its population's parameters. */
  traits: Record<string, number>;
  percepts: Record<string, unknown>;
  retina: Retina | null;
}

/** What a population can be told. */
export type OrderName = "number" | "remove" | "place" | "trait" | "steer";

export interface Resident {
  name: string;
  kind: string;
  /** Species in the scene; empty where it is not known. */
  species: string;
  count: number;
  /** Most individuals that may be asked for. */
  most: number;
  orders: OrderName[];
}

export interface PopulationsMessage {
  type: "populations";
  /** Ticks from one picture to the next; null for as many pictures as can be. */
  stride: number | null;
  populations: Resident[];
}

export interface ScriptMessage {
  type: "script";
  name: string;
  text: string;
}

export interface Snapshot {
  type: "snapshot";
  name: string;
  bytes: Uint8Array;
}

export interface Notice {
  type: "notice";
  level: "info" | "warning" | "error";
  text: string;
}

export type Message =
  | Hello
  | MeshMessage
  | TextureMessage
  | MaterialMessage
  | BatchMessage
  | Layout
  | Frame
  | ParametersMessage
  | EventsMessage
  | Statistics
  | Timeline
  | Inspection
  | PopulationsMessage
  | ScriptMessage
  | Snapshot
  | Notice;
