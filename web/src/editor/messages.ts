import { decode } from "@msgpack/msgpack";
import { type Fields, typed } from "../messages/arrays";

/** Something wrong or doubtful in a text; lines and columns count from 1. */
export interface Problem {
  severity: "error" | "warning";
  message: string;
  line: number;
  column: number;
  /** Characters that are meant; 0 for the whole line. */
  width: number;
  help: string;
}

export interface Hello {
  type: "hello";
  version: string;
  file: string;
  /** Whether the text may be written back. */
  savable: boolean;
  text: string;
  /** Names of surroundings to grow in. */
  environments: string[];
  most_modules: number;
  most_letters: number;
}

export interface PlantMesh {
  positions: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
  colors?: Float32Array;
}

export interface Grown {
  type: "grown";
  number: number;
  /** Steps that were derived. */
  steps: number;
  /** Steps after which the text says that the plant is complete. */
  length: number;
  modules: number;
  /** The beginning of the string. */
  string: string;
  /** Letters of the whole string. */
  letters: number;
  segments: number;
  seconds: number;
  problems: Problem[];
  mesh: PlantMesh;
}

export interface Failed {
  type: "failed";
  number: number;
  problems: Problem[];
  /** Whether it would have become too large, or taken too long: after fewer steps it might do. */
  too_large: boolean;
}

export interface Saved {
  type: "saved";
  text: string;
}

export interface Notice {
  type: "notice";
  level: "info" | "warning" | "error";
  text: string;
}

export type Answer = Hello | Grown | Failed | Saved | Notice;

/** What is asked of the server to grow. */
export interface Order {
  text: string;
  /** Null for as many as the text says. */
  steps: number | null;
  seed: number;
  homomorphism: boolean;
  environment: string | null;
}

export type Request =
  | { do: "join"; version: string; token?: string }
  | ({ do: "grow"; number: number } & Order)
  | { do: "save"; text: string };

const MESH: Fields = {
  positions: Float32Array,
  normals: Float32Array,
  triangles: Uint32Array,
  colors: Float32Array,
};

/** One answer of the server. */
export function decodeAnswer(bytes: Uint8Array): Answer {
  const answer = decode(bytes) as Answer;
  if (answer.type === "grown") typed(answer.mesh as unknown as Record<string, unknown>, MESH);
  return answer;
}
