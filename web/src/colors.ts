// What a view can show: three colours for every triangle, one per corner, and what they mean.
import type { Mesh } from "./mesh";

export type Rgb = [number, number, number];

/** A colour and its meaning; several in a row for a scale. */
export interface Swatch {
  color: Rgb;
  label: string;
}

export interface Coloring {
  /** Colours of the corners of every triangle: 9 bytes each. */
  corners: Uint8Array;
  /** Every corner keeps its colour up to the middle of the sides, instead of blending. */
  patches: boolean;
}

export interface Mode {
  name: string;
  title: string;
  /** Whether its swatches are a scale from the first to the last. */
  scale: boolean;
  swatches: Swatch[];
  color(mesh: Mesh): Coloring;
}

const OBTUSE: Rgb = [226, 74, 141];
const SMALL: Rgb = [58, 120, 220];
const BOTH: Rgb = [122, 60, 170];
const LARGE_TINT: Rgb = [247, 190, 214];
const SMALL_TINT: Rgb = [183, 208, 246];
const GOOD: Rgb = [240, 235, 220];

const VALENCE: [string, Rgb][] = [
  ["4 and fewer", [33, 60, 150]],
  ["5", [120, 170, 230]],
  ["6", [240, 235, 220]],
  ["7", [240, 160, 110]],
  ["8 and more", [180, 30, 40]],
];

// Viridis, and a diverging scale, at even steps.
const VIRIDIS: Rgb[] = [
  [68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
  [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37],
];
const HEAT: Rgb[] = [
  [245, 243, 235], [254, 224, 170], [253, 180, 100], [240, 110, 60], [200, 40, 40], [110, 0, 40],
];
const DIVERGING: Rgb[] = [
  [40, 70, 160], [100, 150, 215], [190, 215, 235], [242, 238, 228], [245, 205, 165],
  [225, 130, 90], [165, 35, 45],
];

function along(scale: Rgb[], x: number): Rgb {
  const at = Math.min(1, Math.max(0, x)) * (scale.length - 1);
  const k = Math.min(scale.length - 2, Math.floor(at));
  const f = at - k;
  return [0, 1, 2].map((c) => scale[k][c] + f * (scale[k + 1][c] - scale[k][c])) as Rgb;
}

function perTriangle(mesh: Mesh, color: (t: number) => Rgb): Coloring {
  const corners = new Uint8Array(9 * mesh.triangleCount);
  for (let t = 0; t < mesh.triangleCount; ++t) {
    const c = color(t);
    for (let k = 0; k < 9; ++k) corners[9 * t + k] = c[k % 3];
  }
  return { corners, patches: false };
}

function perVertex(mesh: Mesh, patches: boolean, color: (v: number) => Rgb): Coloring {
  const colors = new Uint8Array(3 * mesh.vertexCount);
  for (let v = 0; v < mesh.vertexCount; ++v) colors.set(color(v), 3 * v);
  const corners = new Uint8Array(9 * mesh.triangleCount);
  for (let i = 0; i < mesh.triangles.length; ++i) {
    const v = 3 * mesh.triangles[i];
    corners[3 * i] = colors[v];
    corners[3 * i + 1] = colors[v + 1];
    corners[3 * i + 2] = colors[v + 2];
  }
  return { corners, patches };
}

function angleMode(goal: { min_angle: number; max_angle: number }): Mode {
  return {
    name: "angle",
    title: "angles",
    scale: false,
    swatches: [
      { color: OBTUSE, label: "an angle of 90\u00b0 or more" },
      { color: SMALL, label: "an angle below 30\u00b0" },
      { color: BOTH, label: "both" },
      { color: LARGE_TINT, label: `${goal.max_angle}\u00b0 or more` },
      { color: SMALL_TINT, label: `below ${goal.min_angle}\u00b0` },
      { color: GOOD, label: "inside the bounds" },
    ],
    color: (mesh) =>
      perTriangle(mesh, (t) => {
        const obtuse = mesh.largest[t] >= 90;
        const small = mesh.smallest[t] < 30;
        if (obtuse) return small ? BOTH : OBTUSE;
        if (small) return SMALL;
        if (mesh.largest[t] >= goal.max_angle) return LARGE_TINT;
        return mesh.smallest[t] < goal.min_angle ? SMALL_TINT : GOOD;
      }),
  };
}

const qualityMode: Mode = {
  name: "quality",
  title: "shape Q",
  scale: true,
  swatches: [0, 0.25, 0.5, 0.75, 1].map((q) => ({ color: along(VIRIDIS, q), label: String(q) })),
  color: (mesh) => perTriangle(mesh, (t) => along(VIRIDIS, mesh.quality[t])),
};

const valenceMode: Mode = {
  name: "valence",
  title: "valence",
  scale: false,
  swatches: VALENCE.map(([label, color]) => ({ label, color })),
  // A boundary vertex has a side of 180 degrees: 4 neighbours there are as good as 6 inside.
  color: (mesh) =>
    perVertex(mesh, true, (v) => {
      const n = mesh.valence[v] + (mesh.onBoundary[v] ? 2 : 0);
      return VALENCE[Math.min(4, Math.max(0, n - 4))][1];
    }),
};

function percentile(values: Float32Array, p: number): number {
  const sorted = Float32Array.from(values).sort();
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(p * sorted.length))] : 0;
}

function digits(x: number): string {
  return x === 0 ? "0" : x.toPrecision(2).replace(/\.0+$/, "");
}

function distanceMode(meshes: Mesh[], diagonal: number): Mode {
  const most = Math.max(...meshes.map((m) => percentile(m.distance!, 0.999)), 1e-12 * diagonal);
  return {
    name: "distance",
    title: "distance",
    scale: true,
    swatches: [0, 0.25, 0.5, 0.75, 1].map((x) => ({
      color: along(HEAT, x),
      label: `${digits((100 * x * most) / diagonal)} %`,
    })),
    color: (mesh) => perVertex(mesh, false, (v) => along(HEAT, mesh.distance![v] / most)),
  };
}

// Edge lengths on a logarithmic scale around what the result has in the middle.
function sizingMode(after: Mesh): Mode {
  const middle = percentile(after.edgeLength, 0.5) || 1;
  const steps = [0.25, 0.5, 1, 2, 4];
  return {
    name: "sizing",
    title: "edge length",
    scale: true,
    swatches: steps.map((s) => ({
      color: along(DIVERGING, Math.log2(s) / 4 + 0.5),
      label: digits(s * middle),
    })),
    color: (mesh) =>
      perVertex(mesh, false, (v) =>
        along(DIVERGING, Math.log2((mesh.edgeLength[v] || middle) / middle) / 4 + 0.5),
      ),
  };
}

export function modes(
  before: Mesh,
  after: Mesh,
  goal: { min_angle: number; max_angle: number },
  diagonal: number,
): Mode[] {
  const result = [angleMode(goal), qualityMode, valenceMode];
  if (before.distance && after.distance) result.push(distanceMode([before, after], diagonal));
  result.push(sizingMode(after));
  return result;
}
