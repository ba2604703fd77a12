// The page: fills its sections from the report and ties them to the views.
import "./style.css";
import { bars, curve, histogram } from "./charts";
import { modes, type Mode } from "./colors";
import { Mesh } from "./mesh";
import { readReport, type Angles, type Place, type Report } from "./report";
import { Views } from "./views";

function make(name: string, text = "", className = ""): HTMLElement {
  const e = document.createElement(name);
  e.textContent = text;
  if (className) e.className = className;
  return e;
}

function by(id: string): HTMLElement {
  return document.getElementById(id)!;
}

const content = (section: string) => by(section).querySelector("div")!;
const degrees = (x: number) => `${x.toFixed(2)}\u00b0`;
const whole = (x: number) => x.toLocaleString("en");

function table(head: string[], rows: string[][]): HTMLElement {
  const result = make("table");
  const add = (tag: string, cells: string[]) => {
    const row = make("tr");
    row.append(...cells.map((text) => make(tag, text)));
    result.append(row);
  };
  if (head.length) add("th", head);
  for (const row of rows) add("td", row);
  const scrolled = make("div", "", "scrolled");
  scrolled.append(result);
  return scrolled;
}

function fillHeader(report: Report): void {
  const name = report.input?.split(/[\\/]/).pop() ?? "surface";
  document.title = `${name} \u2013 nonobtuse`;
  by("title").textContent = `${name}: ${whole(report.before_vertices)} \u2192 ${whole(report.after_vertices)} vertices`;
  const certified = report.promise.certified;
  const badge = make("span", certified ? "non-obtuse, certified" : "not certified", certified ? "good badge" : "bad badge");
  const said = ` ${report.status.replace("_", " ")} in ${report.seconds.toFixed(2)} s; angles ${degrees(report.after.min_angle)} to ${degrees(report.after.max_angle)}, before ${degrees(report.before.min_angle)} to ${degrees(report.before.max_angle)}`;
  by("summary").append(badge, document.createTextNode(said));
}

function fillFigures(report: Report): void {
  const rows: string[][] = [["vertices", whole(report.before_vertices), whole(report.after_vertices)]];
  const add = (name: string, key: keyof Angles, digits: number) =>
    rows.push([name, report.before[key].toFixed(digits), report.after[key].toFixed(digits)]);
  add("triangles", "triangles", 0);
  add("obtuse triangles", "obtuse", 0);
  add("triangles with an angle below 30\u00b0", "small", 0);
  add("smallest angle, degrees", "min_angle", 3);
  add("largest angle", "max_angle", 3);
  add("mean smallest angle", "mean_min_angle", 2);
  add("Q_min (1 = equilateral)", "quality_min", 3);
  add("Q_avg", "quality_mean", 3);
  add("% of triangles with an angle below 30\u00b0", "percent_small", 2);
  add("% of triangles with an angle of 90\u00b0 or more", "percent_obtuse", 2);
  add("% of vertices of valence 5, 6, 7", "percent_valence_567", 2);
  if (report.before_topology && report.after_topology) {
    const [b, a] = [report.before_topology, report.after_topology];
    rows.push(["components", whole(b.components), whole(a.components)]);
    rows.push(["Euler characteristic", whole(b.euler_characteristic), whole(a.euler_characteristic)]);
    rows.push(["boundary loops", whole(b.boundary_loops), whole(a.boundary_loops)]);
  }
  if (report.self_intersections !== undefined)
    rows.push(["self-intersecting pairs", "", whole(report.self_intersections)]);
  if (report.flipped !== undefined) rows.push(["flipped triangles", "", whole(report.flipped)]);
  if (report.distance) {
    const { diagonal, rms, hausdorff } = report.distance;
    rows.push(["d_RMS, 1e-3 of the diagonal", "", ((1e3 * rms) / diagonal).toFixed(3)]);
    rows.push(["d_H, 1e-2 of the diagonal", "", ((1e2 * hausdorff) / diagonal).toFixed(3)]);
  }
  const r = report.size_ratio;
  rows.push(["edge length over target, median", "", r.median.toFixed(3)]);
  rows.push(["90 % of all in", "", `${r.percentile_5.toFixed(3)} \u2013 ${r.percentile_95.toFixed(3)}`]);
  content("figures").append(table(["", "before", "after"], rows));
}

function fillCertificate(report: Report): void {
  const box = content("certificate");
  const say = (c: Report["goal"], what: string) => {
    const range = `[${c.min_angle}\u00b0, ${c.max_angle}\u00b0)`;
    const text = c.certified
      ? `${what}: every angle of the ${whole(c.triangles)} triangles is in ${range}, decided in exact arithmetic on the coordinates as written.`
      : `${what}: of ${whole(c.triangles)} triangles ${whole(c.too_large)} have an angle of ${c.max_angle}\u00b0 or more, ${whole(c.too_small)} one below ${c.min_angle}\u00b0.`;
    box.append(make("p", text, c.certified ? "good" : "bad"));
  };
  say(report.promise, "The promise");
  if (report.goal.min_angle !== 30 || report.goal.max_angle !== 90) say(report.goal, "Asked for");
}

interface Listed {
  which: "before" | "after";
  triangle: number;
  text: string;
}

// The k triangles with the greatest value.
function extremes(values: Float32Array, k: number): number[] {
  const order = Array.from(values.keys());
  return order.sort((a, b) => values[b] - values[a]).slice(0, k);
}

// A triangle at a vertex.
function triangleAt(mesh: Mesh, vertex: number): number {
  return Math.floor(Math.max(0, mesh.triangles.indexOf(vertex)) / 3);
}

function listPlaces(report: Report, before: Mesh, after: Mesh): [string, Listed[]][] {
  const groups: [string, Listed[]][] = [];
  const named = (places: Place[]) =>
    places.map((p): Listed => ({
      which: "after",
      triangle: p.triangle,
      text: `triangle ${p.triangle}: ${degrees(p.smallest_angle)} to ${degrees(p.largest_angle)}`,
    }));
  const found = (which: "before" | "after", mesh: Mesh, triangles: number[]) =>
    triangles.map((t): Listed => ({
      which,
      triangle: t,
      text: `triangle ${t}: ${degrees(mesh.smallest[t])} to ${degrees(mesh.largest[t])}`,
    }));
  const { goal } = report;
  if (goal.too_large)
    groups.push([`Result, ${goal.max_angle}\u00b0 or more (${whole(goal.too_large)})`, named(goal.worst_too_large)]);
  if (goal.too_small)
    groups.push([`Result, below ${goal.min_angle}\u00b0 (${whole(goal.too_small)})`, named(goal.worst_too_small)]);
  if (!goal.too_large && !goal.too_small) {
    groups.push(["Result, nearest to the upper bound", found("after", after, extremes(after.largest, 5))]);
    groups.push(["Result, nearest to the lower bound", found("after", after, extremes(after.smallest.map((x) => -x), 5))]);
  }
  if (report.narrow_corners?.length)
    groups.push([
      "Corners of the input below 30\u00b0",
      report.narrow_corners.map((c): Listed => ({
        which: "after",
        triangle: triangleAt(after, c.vertex),
        text: `vertex ${c.vertex}: ${degrees(c.input_angle)}, in the result ${degrees(c.reached_angle)}`,
      })),
    ]);
  if (after.distance && before.distance && report.distance) {
    const percent = (d: number) => `${((100 * d) / report.distance!.diagonal).toFixed(3)} % of the diagonal`;
    const far = (which: "before" | "after", mesh: Mesh): Listed => {
      const v = extremes(mesh.distance!, 1)[0];
      return { which, triangle: triangleAt(mesh, v), text: `${which === "after" ? "result" : "input"} vertex ${v}: ${percent(mesh.distance![v])}` };
    };
    groups.push(["Farthest from the other surface", [far("after", after), far("before", before)]]);
  }
  groups.push(["Input, largest angles", found("before", before, extremes(before.largest, 5))]);
  return groups;
}

function fillPlaces(groups: [string, Listed[]][], visit: (place: Listed) => void): void {
  const box = content("places");
  for (const [name, places] of groups) {
    box.append(make("h3", name));
    const list = make("ol");
    for (const place of places) {
      const button = make("button", place.text, "place") as HTMLButtonElement;
      button.type = "button";
      button.addEventListener("click", () => {
        document.querySelectorAll(".place.current").forEach((b) => b.classList.remove("current"));
        button.classList.add("current");
        visit(place);
      });
      const item = make("li");
      item.append(button);
      list.append(item);
    }
    box.append(list);
  }
}

function fillHistograms(report: Report, before: Mesh, after: Mesh): void {
  const marks = [{ at: 30, strong: true }, { at: 90, strong: true }];
  for (const at of [report.goal.min_angle, report.goal.max_angle])
    if (at !== 30 && at !== 90) marks.push({ at, strong: false });
  const box = content("histograms");
  box.append(
    histogram("All angles, degrees", before.angles, after.angles, 0, 180, 90, marks),
    histogram("Shape Q of triangles", before.quality, after.quality, 0, 1, 50, []),
  );
  if (before.distance && after.distance && report.distance) {
    const scale = 100 / report.distance.diagonal;
    const [b, a] = [before.distance, after.distance].map((d) => d.map((x) => x * scale));
    const most = Math.max(extremeAt(b, 0.999), extremeAt(a, 0.999)) || 1e-9;
    box.append(histogram("Distance of vertices to the other surface, % of the diagonal", b, a, 0, most, 50, []));
  }
}

function extremeAt(values: Float32Array, p: number): number {
  const sorted = Float32Array.from(values).sort();
  return sorted[Math.min(sorted.length - 1, Math.floor(p * sorted.length))] ?? 0;
}

function fillConvergence(report: Report): void {
  const box = content("convergence");
  const stages = [...new Set((report.history ?? []).map((r) => r.stage))];
  for (const stage of stages) {
    const records = report.history!.filter((r) => r.stage === stage);
    box.append(curve(`${stage}: energy`, records.map((r) => r.energy), "#2b6f8f", false));
    box.append(curve(`${stage}: obtuse triangles`, records.map((r) => (r.obtuse < 0 ? null : r.obtuse)), "#e24a8d", true));
  }
  box.append(
    bars(stages.length ? "Seconds, the recording of the iterations included" : "Seconds", report.stages.map((s) => ({ name: s.stage, value: s.seconds, text: `${s.seconds.toFixed(3)} s` }))),
  );
}

function fillOptions(report: Report): void {
  const box = content("options");
  if (report.command_line) box.append(make("pre", report.command_line));
  const rows = Object.entries(report.options).map(([key, value]) => [key, String(value)]);
  rows.unshift(["version", report.version]);
  box.append(table([], rows));
  if (report.repairs.length) {
    box.append(make("h3", "Repaired in the input"));
    box.append(table([], report.repairs.map((r) => [r.what, whole(r.count)])));
  }
}

function legend(mode: Mode): HTMLElement {
  const box = make("div", "", mode.scale ? "scale" : "keys");
  const css = mode.swatches.map((s) => `rgb(${s.color.join(",")})`);
  if (mode.scale) {
    const bar = make("i");
    bar.style.background = `linear-gradient(to right, ${css.join(",")})`;
    const labels = make("div");
    labels.append(...mode.swatches.map((s) => make("span", s.label)));
    box.append(bar, labels);
  } else {
    mode.swatches.forEach((s, k) => {
      const key = make("span", s.label);
      const swatch = make("i");
      swatch.style.background = css[k];
      key.prepend(swatch);
      box.append(key);
    });
  }
  return box;
}

function fillModes(all: Mode[], choose: (mode: Mode) => void): void {
  for (const mode of all) {
    const label = make("label");
    const input = document.createElement("input");
    input.type = "radio";
    input.name = "mode";
    input.value = mode.name;
    input.checked = mode === all[0];
    input.addEventListener("change", () => choose(mode));
    label.append(input, document.createTextNode(` ${mode.title}`));
    by("modes").append(label);
  }
}

/** Normal and size of a triangle, where a camera should look at it from. */
function spot(mesh: Mesh, t: number) {
  const [ax, ay, az, bx, by_, bz, cx, cy, cz] = mesh.corners(t);
  const [ux, uy, uz, vx, vy, vz] = [bx - ax, by_ - ay, bz - az, cx - ax, cy - ay, cz - az];
  const normal: [number, number, number] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
  const size = Math.max(Math.hypot(ux, uy, uz), Math.hypot(vx, vy, vz));
  if (Math.hypot(...normal) === 0) normal[2] = 1;
  return { at: mesh.centroid(t), normal, size };
}

function start(): void {
  const report = readReport();
  fillHeader(report);
  const center = report.meshes.before.origin;
  const before = new Mesh(report.meshes.before, center);
  const after = new Mesh(report.meshes.after, center);
  fillCertificate(report);
  fillFigures(report);
  fillHistograms(report, before, after);
  fillConvergence(report);
  fillOptions(report);
  by("before-caption").textContent = `before: ${whole(before.triangleCount)} triangles`;
  by("after-caption").textContent = `after: ${whole(after.triangleCount)} triangles`;

  const canvases = ["before", "after"].map((id) => by(id) as HTMLCanvasElement);
  const views = new Views(canvases, [before, after], [[], report.feature_edges ?? []]);
  const diagonal = report.distance?.diagonal ?? 1;
  const all = modes(before, after, report.goal, diagonal);
  const choose = (mode: Mode) => {
    views.show([mode.color(before), mode.color(after)]);
    by("legend").replaceChildren(legend(mode));
  };
  fillModes(all, choose);
  choose(all[0]);
  by("edges").addEventListener("change", (e) => {
    views.edges = (e.target as HTMLInputElement).checked;
  });
  by("reset").addEventListener("click", () => views.reset());
  fillPlaces(listPlaces(report, before, after), (place) => {
    by("views").scrollIntoView({ block: "nearest" });
    views.visit(spot(place.which === "after" ? after : before, place.triangle));
  });
  let pressed = [0, 0];
  for (const canvas of canvases) {
    canvas.addEventListener("pointerdown", (e) => {
      pressed = [e.clientX, e.clientY];
    });
    canvas.addEventListener("pointerup", (e) => {
      if (Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) > 3 || e.button !== 0) return;
      const hit = views.pick(e);
      const mesh = hit?.view === 0 ? before : after;
      by("picked").textContent = hit
        ? `${hit.view === 0 ? "before" : "after"}, triangle ${hit.triangle}: ${degrees(mesh.smallest[hit.triangle])} to ${degrees(mesh.largest[hit.triangle])}, Q ${mesh.quality[hit.triangle].toFixed(3)}`
        : "";
    });
  }
  // For tests: where the camera is, and whether it is on its way.
  const nonobtuseReport = { camera: () => views.state, flying: () => views.flying };
  Object.assign(window, { nonobtuseReport });
}

start();
