// The report's data: docs/json.md, "The report".

/** An array as base64 of little-endian numbers. */
export interface PackedArray {
  type: "float32" | "uint16" | "uint32";
  shape: number[];
  base64: string;
}

export interface PackedMesh {
  /** Coordinates relative to `origin`, in input units. */
  vertices: PackedArray;
  origin: [number, number, number];
  triangles: PackedArray;
  /** Of every vertex to the other surface, input units; may be absent. */
  distance?: PackedArray;
  /** Target edge length at every vertex; absent where it is the same everywhere. */
  target_length?: PackedArray;
}

export interface Angles {
  triangles: number;
  obtuse: number;
  small: number;
  min_angle: number;
  max_angle: number;
  mean_min_angle: number;
  quality_min: number;
  quality_mean: number;
  percent_small: number;
  percent_obtuse: number;
  percent_valence_567: number;
}

export interface Place {
  triangle: number;
  smallest_angle: number;
  largest_angle: number;
}

export interface Certificate {
  min_angle: number;
  max_angle: number;
  certified: boolean;
  triangles: number;
  too_large: number;
  too_small: number;
  worst_too_large: Place[];
  worst_too_small: Place[];
}

export interface IterationRecord {
  stage: string;
  iteration: number;
  energy: number | null;
  obtuse: number;
  small: number;
}

export interface Topology {
  components: number;
  boundary_loops: number;
  euler_characteristic: number;
  nonmanifold_edges: number;
  nonmanifold_vertices: number;
}

export interface Report {
  version: string;
  input?: string;
  output?: string;
  command_line?: string;
  status: string;
  options: Record<string, unknown>;
  repairs: { what: string; count: number; first: number }[];
  before_vertices: number;
  after_vertices: number;
  before: Angles;
  after: Angles;
  before_topology?: Topology;
  after_topology?: Topology;
  self_intersections?: number;
  flipped?: number;
  size_ratio: { median: number; percentile_5: number; percentile_95: number };
  /** Of the result: creases and boundaries of the input. */
  feature_edges?: [number, number][];
  narrow_corners?: { vertex: number; input_angle: number; reached_angle: number }[];
  goal: Certificate;
  promise: Certificate;
  distance?: { diagonal: number; hausdorff: number; rms: number };
  seconds: number;
  stages: { stage: string; seconds: number }[];
  history?: IterationRecord[];
  meshes: { before: PackedMesh; after: PackedMesh };
}

function bytes(base64: string): ArrayBuffer {
  const text = atob(base64);
  const result = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) result[i] = text.charCodeAt(i);
  return result.buffer;
}

export function floats(array: PackedArray): Float32Array {
  return new Float32Array(bytes(array.base64));
}

export function indices(array: PackedArray): Uint16Array | Uint32Array {
  const buffer = bytes(array.base64);
  return array.type === "uint16" ? new Uint16Array(buffer) : new Uint32Array(buffer);
}

export function readReport(): Report {
  return JSON.parse(document.getElementById("report")!.textContent!) as Report;
}
