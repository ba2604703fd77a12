// A mesh with what can be read off it: angles, shape, valence, edge lengths. Angles of the report's
// table and certificate come from the exact program; these here, from float coordinates, only
// colour and draw.
import { floats, indices, type PackedMesh } from "./report";

export class Mesh {
  readonly positions: Float32Array; // relative to `center`
  readonly triangles: Uint16Array | Uint32Array;
  readonly distance?: Float32Array;
  readonly targetLength?: Float32Array;
  readonly smallest: Float32Array; // per triangle, degrees
  readonly largest: Float32Array;
  readonly quality: Float32Array; // 6/sqrt(3) S/(p h)
  readonly angles: Float32Array; // three per triangle
  readonly valence: Uint16Array;
  readonly onBoundary: Uint8Array;
  readonly edgeLength: Float32Array; // per vertex: mean over its triangles' sides there

  constructor(packed: PackedMesh, center: [number, number, number]) {
    this.positions = floats(packed.vertices);
    const shift = packed.origin.map((x, k) => x - center[k]);
    for (let i = 0; i < this.positions.length; ++i) this.positions[i] += shift[i % 3];
    this.triangles = indices(packed.triangles);
    this.distance = packed.distance && floats(packed.distance);
    this.targetLength = packed.target_length && floats(packed.target_length);
    const faces = this.triangleCount;
    this.smallest = new Float32Array(faces);
    this.largest = new Float32Array(faces);
    this.quality = new Float32Array(faces);
    this.angles = new Float32Array(3 * faces);
    this.valence = new Uint16Array(this.vertexCount);
    this.onBoundary = new Uint8Array(this.vertexCount);
    this.edgeLength = new Float32Array(this.vertexCount);
    this.measure();
  }

  get vertexCount(): number {
    return this.positions.length / 3;
  }
  get triangleCount(): number {
    return this.triangles.length / 3;
  }

  /** Nine coordinates. */
  corners(t: number): number[] {
    const result: number[] = [];
    for (let k = 0; k < 3; ++k) {
      const v = 3 * this.triangles[3 * t + k];
      result.push(this.positions[v], this.positions[v + 1], this.positions[v + 2]);
    }
    return result;
  }

  centroid(t: number): [number, number, number] {
    const c = this.corners(t);
    return [(c[0] + c[3] + c[6]) / 3, (c[1] + c[4] + c[7]) / 3, (c[2] + c[5] + c[8]) / 3];
  }

  private measure(): void {
    const sides = new Float32Array(this.vertexCount);
    const incident = new Uint16Array(this.vertexCount);
    // Every undirected edge once or twice: a vertex is on the boundary if a side has no partner.
    const partners = new Map<number, number>();
    const n = this.vertexCount;
    const length = (p: number, q: number) =>
      Math.hypot(
        this.positions[3 * q] - this.positions[3 * p],
        this.positions[3 * q + 1] - this.positions[3 * p + 1],
        this.positions[3 * q + 2] - this.positions[3 * p + 2],
      );
    for (let t = 0; t < this.triangleCount; ++t) {
      const v = [this.triangles[3 * t], this.triangles[3 * t + 1], this.triangles[3 * t + 2]];
      const l = [length(v[1], v[2]), length(v[2], v[0]), length(v[0], v[1])]; // opposite corner k
      for (let k = 0; k < 3; ++k) {
        const [a, b, c] = [l[k], l[(k + 1) % 3], l[(k + 2) % 3]];
        const cosine = b > 0 && c > 0 ? (b * b + c * c - a * a) / (2 * b * c) : 1;
        this.angles[3 * t + k] = (Math.acos(Math.min(1, Math.max(-1, cosine))) * 180) / Math.PI;
        sides[v[k]] += b + c;
        incident[v[k]] += 2;
        const [p, q] = [v[(k + 1) % 3], v[(k + 2) % 3]];
        const key = Math.min(p, q) * n + Math.max(p, q);
        if (!partners.delete(key)) partners.set(key, 1);
        this.valence[v[k]] += 1;
      }
      const angles = this.angles.subarray(3 * t, 3 * t + 3);
      this.smallest[t] = Math.min(...angles);
      this.largest[t] = Math.max(...angles);
      const p = (l[0] + l[1] + l[2]) / 2;
      const h = Math.max(l[0], l[1], l[2]);
      const area = Math.sqrt(Math.max(0, p * (p - l[0]) * (p - l[1]) * (p - l[2])));
      this.quality[t] = h > 0 ? ((6 / Math.sqrt(3)) * area) / (p * h) : 0;
    }
    for (const key of partners.keys()) {
      for (const v of [Math.floor(key / n), key % n]) {
        if (!this.onBoundary[v]) this.valence[v] += 1; // edges are one more than triangles
        this.onBoundary[v] = 1;
      }
    }
    for (let v = 0; v < n; ++v) this.edgeLength[v] = incident[v] ? sides[v] / incident[v] : 0;
  }
}
