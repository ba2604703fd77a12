// Plain SVG: histograms of before and after, curves over iterations, bars.

const NS = "http://www.w3.org/2000/svg";
const BEFORE = "#b9a58b";
const AFTER = "#2b6f8f";

type Attributes = Record<string, string | number>;

function element(name: string, attributes: Attributes, text?: string): SVGElement {
  const e = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, String(value));
  if (text !== undefined) e.textContent = text;
  return e;
}

function figure(title: string, width: number, height: number): { box: HTMLElement; svg: SVGElement } {
  const box = document.createElement("figure");
  box.className = "chart";
  const caption = document.createElement("figcaption");
  caption.textContent = title;
  const svg = element("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title });
  box.append(caption, svg);
  return { box, svg };
}

/** About `count` round numbers that cover [from, to]. */
function ticks(from: number, to: number, count: number): number[] {
  const raw = (to - from) / count || 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.999)!;
  const result: number[] = [];
  for (let x = Math.ceil(from / step - 1e-9) * step; x <= to + 1e-9 * step; x += step)
    result.push(Math.abs(x) < step * 1e-9 ? 0 : x);
  return result;
}

function label(x: number): string {
  const a = Math.abs(x);
  if (x === 0 || (a >= 0.01 && a < 100000)) return String(Number(x.toPrecision(4)));
  return x.toExponential(0);
}

function share(values: Float32Array, from: number, to: number, bins: number): number[] {
  const counts = new Array<number>(bins).fill(0);
  for (const v of values) {
    const k = Math.floor(((v - from) / (to - from)) * bins);
    counts[Math.min(bins - 1, Math.max(0, k))] += 100 / values.length;
  }
  return counts;
}

/** Shares in per cent of two sets of values; `marks` are vertical lines with a label. */
export function histogram(
  title: string,
  before: Float32Array,
  after: Float32Array,
  from: number,
  to: number,
  bins: number,
  marks: { at: number; strong: boolean }[],
): HTMLElement {
  const [width, height, left, bottom, top] = [560, 250, 40, 26, 20];
  const { box, svg } = figure(title, width, height);
  const shares = [share(before, from, to, bins), share(after, from, to, bins)];
  const most = Math.max(...shares.flat()) * 1.05 || 1;
  const x = (v: number) => left + ((v - from) / (to - from)) * (width - left - 8);
  const y = (v: number) => height - bottom - (v / most) * (height - bottom - top);
  for (const t of ticks(0, most, 4)) {
    svg.append(element("line", { x1: left, x2: width - 8, y1: y(t), y2: y(t), class: "grid" }));
    svg.append(element("text", { x: left - 5, y: y(t) + 4, class: "end" }, `${label(t)} %`));
  }
  for (const t of ticks(from, to, 6))
    svg.append(element("text", { x: x(t), y: height - 8, class: "middle" }, label(t)));
  shares.forEach((values, which) => {
    let path = `M${x(from)},${y(0)}`;
    values.forEach((v, k) => {
      path += `V${y(v).toFixed(2)}H${x(from + ((k + 1) / bins) * (to - from)).toFixed(2)}`;
    });
    path += `V${y(0)}Z`;
    const color = which === 0 ? BEFORE : AFTER;
    svg.append(element("path", { d: path, fill: color, "fill-opacity": 0.45, stroke: color }));
  });
  for (const { at, strong } of marks) {
    svg.append(element("line", { x1: x(at), x2: x(at), y1: top - 4, y2: y(0), class: strong ? "bound strong" : "bound" }));
    svg.append(element("text", { x: x(at), y: 11, class: "middle" }, `${label(at)}\u00b0`));
  }
  [["before", BEFORE], ["after", AFTER]].forEach(([name, color], k) => {
    const at = width - 64;
    svg.append(element("rect", { x: at, y: top + 2 + 16 * k, width: 10, height: 10, fill: color, "fill-opacity": 0.6 }));
    svg.append(element("text", { x: at + 15, y: top + 11 + 16 * k }, name));
  });
  return box;
}

/** One curve over iterations; gaps where there is no number. `zero`: the axis starts at 0. */
export function curve(title: string, values: (number | null)[], color: string, zero: boolean): HTMLElement {
  const [width, height, left, bottom, top] = [270, 150, 52, 22, 8];
  const { box, svg } = figure(title, width, height);
  const known = values.filter((v): v is number => v !== null && Number.isFinite(v));
  const least = zero ? 0 : Math.min(...known);
  const most = Math.max(...known, least + (zero ? 1 : Math.abs(least) * 1e-6 || 1e-12));
  const x = (k: number) => left + (k / Math.max(1, values.length - 1)) * (width - left - 10);
  const y = (v: number) => height - bottom - ((v - least) / (most - least)) * (height - bottom - top);
  for (const t of ticks(least, most, 3)) {
    svg.append(element("line", { x1: left, x2: width - 10, y1: y(t), y2: y(t), class: "grid" }));
    svg.append(element("text", { x: left - 5, y: y(t) + 4, class: "end" }, label(t)));
  }
  for (const t of ticks(0, Math.max(1, values.length - 1), 4).filter(Number.isInteger))
    svg.append(element("text", { x: x(t), y: height - 6, class: "middle" }, String(t)));
  let path = "";
  values.forEach((v, k) => {
    if (v === null || !Number.isFinite(v)) return;
    const joined = k > 0 && values[k - 1] !== null && path !== "";
    path += `${joined ? "L" : "M"}${x(k).toFixed(2)},${y(v).toFixed(2)}`;
    svg.append(element("circle", { cx: x(k), cy: y(v), r: 1.8, fill: color }));
  });
  svg.append(element("path", { d: path, fill: "none", stroke: color, "stroke-width": 1.4 }));
  return box;
}

/** Horizontal bars with their numbers. */
export function bars(title: string, rows: { name: string; value: number; text: string }[]): HTMLElement {
  const [width, left, line] = [560, 130, 22];
  const { box, svg } = figure(title, width, rows.length * line + 6);
  const most = Math.max(...rows.map((r) => r.value), 1e-12);
  rows.forEach((row, k) => {
    const y = k * line + 4;
    const length = (row.value / most) * (width - left - 90);
    svg.append(element("text", { x: left - 8, y: y + 12, class: "end" }, row.name));
    svg.append(element("rect", { x: left, y, width: Math.max(1, length), height: 15, fill: AFTER, "fill-opacity": 0.7 }));
    svg.append(element("text", { x: left + length + 6, y: y + 12 }, row.text));
  });
  return box;
}
