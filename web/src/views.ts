// Two views of two surfaces through one camera.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  GLSL3,
  LineBasicMaterial,
  LineSegments,
  Mesh as Drawn,
  PerspectiveCamera,
  Raycaster,
  Scene,
  ShaderMaterial,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { TrackballControls } from "three/examples/jsm/controls/TrackballControls.js";
import type { Coloring } from "./colors";
import type { Mesh } from "./mesh";

// Triangles are drawn corner by corner, so that a fragment knows its place in its triangle.
const VERTEX = `
in vec3 first; in vec3 second; in vec3 third;
flat out vec3 colorA; flat out vec3 colorB; flat out vec3 colorC;
out vec3 place; out vec3 eye;
void main() {
  int corner = gl_VertexID % 3;
  place = vec3(corner == 0, corner == 1, corner == 2);
  colorA = first; colorB = second; colorC = third;
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  eye = p.xyz;
  gl_Position = projectionMatrix * p;
}`;
const FRAGMENT = `
precision highp float;
flat in vec3 colorA; flat in vec3 colorB; flat in vec3 colorC;
in vec3 place; in vec3 eye;
uniform bool patches; uniform float edges;
out vec4 result;
void main() {
  vec3 n = normalize(cross(dFdx(eye), dFdy(eye)));
  vec3 color = place.x * colorA + place.y * colorB + place.z * colorC;
  if (patches)
    color = place.x >= place.y && place.x >= place.z ? colorA : place.y >= place.z ? colorB : colorC;
  if (!gl_FrontFacing) color = mix(color, vec3(0.35, 0.3, 0.3), 0.6);
  float light = 0.45 + 0.5 * abs(dot(n, normalize(vec3(0.25, 0.35, 1.0))))
              + 0.08 * abs(dot(n, normalize(vec3(-1.0, 0.2, 0.3))));
  vec3 width = fwidth(place);
  vec3 inside = smoothstep(vec3(0.1), vec3(1.1), place / width);
  float line = 1.0 - min(inside.x, min(inside.y, inside.z));
  // Where triangles are smaller than a few pixels, lines would be all there is to see.
  float fine = sqrt(abs(dFdx(place.x) * dFdy(place.y) - dFdx(place.y) * dFdy(place.x)));
  line *= edges * (1.0 - smoothstep(0.06, 0.25, fine));
  result = vec4(mix(color * light, vec3(0.12, 0.12, 0.16), 0.7 * line), 1.0);
}`;

class View {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly geometry = new BufferGeometry();
  private readonly material: ShaderMaterial;
  readonly drawn: Drawn;

  constructor(
    readonly canvas: HTMLCanvasElement,
    readonly mesh: Mesh,
    features: [number, number][],
  ) {
    // Kept, so that a picture can be taken at any time.
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.scene.background = new Color(0xffffff);
    this.material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      glslVersion: GLSL3,
      side: DoubleSide,
      polygonOffset: true, // behind the lines of features
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 2,
      uniforms: { patches: { value: false }, edges: { value: 1 } },
    });
    const corners = new Float32Array(3 * mesh.triangles.length);
    for (let i = 0; i < mesh.triangles.length; ++i)
      for (let k = 0; k < 3; ++k) corners[3 * i + k] = mesh.positions[3 * mesh.triangles[i] + k];
    this.geometry.setAttribute("position", new BufferAttribute(corners, 3));
    this.drawn = new Drawn(this.geometry, this.material);
    this.drawn.frustumCulled = false;
    this.scene.add(this.drawn);
    if (features.length > 0) {
      const ends = new Float32Array(6 * features.length);
      features.flat().forEach((v, i) => ends.set(mesh.positions.subarray(3 * v, 3 * v + 3), 3 * i));
      const lines = new BufferGeometry();
      lines.setAttribute("position", new BufferAttribute(ends, 3));
      const segments = new LineSegments(lines, new LineBasicMaterial({ color: 0xc0202a }));
      segments.frustumCulled = false;
      this.scene.add(segments);
    }
  }

  show(coloring: Coloring): void {
    const count = this.mesh.triangleCount;
    ["first", "second", "third"].forEach((name, corner) => {
      const colors = new Uint8Array(12 * count); // 4 bytes each, for alignment
      for (let i = 0; i < 3 * count; ++i)
        for (let k = 0; k < 3; ++k)
          colors[4 * i + k] = coloring.corners[9 * Math.floor(i / 3) + 3 * corner + k];
      this.geometry.setAttribute(name, new BufferAttribute(colors, 4, true));
    });
    this.material.uniforms.patches.value = coloring.patches;
  }

  set edges(on: boolean) {
    this.material.uniforms.edges.value = on ? 1 : 0;
  }

  resize(): { width: number; height: number } {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement!;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height);
    return { width, height };
  }

  render(camera: PerspectiveCamera): void {
    this.renderer.render(this.scene, camera);
  }
}

/** Somewhere to fly to. */
export interface Spot {
  at: [number, number, number];
  normal: [number, number, number];
  size: number; // what should be seen around it
}

export class Views {
  private readonly camera = new PerspectiveCamera(35, 1, 0.01, 100);
  private readonly target = new Vector3();
  private readonly views: View[];
  private readonly controls: TrackballControls[];
  private readonly radius: number;
  private marked: Vector3 | null = null;
  private pending = false;
  private flight = 0;
  /** Whether the camera is on its way. */
  flying = false;

  /** features: of each mesh, pairs of vertices to draw lines between. */
  constructor(canvases: HTMLCanvasElement[], meshes: Mesh[], features: [number, number][][]) {
    this.views = canvases.map((canvas, i) => new View(canvas, meshes[i], features[i]));
    let radius = 0;
    for (const mesh of meshes)
      for (let i = 0; i < mesh.positions.length; i += 3)
        radius = Math.max(radius, Math.hypot(...mesh.positions.subarray(i, i + 3)));
    this.radius = radius || 1;
    this.controls = canvases.map((canvas) => {
      const controls = new TrackballControls(this.camera, canvas);
      controls.target = this.target; // one for both
      controls.staticMoving = true;
      controls.rotateSpeed = 3;
      controls.addEventListener("change", () => this.draw());
      const update = () => controls.update();
      for (const event of ["pointermove", "pointerup", "wheel"])
        canvas.addEventListener(event, () => requestAnimationFrame(update), { passive: true });
      return controls;
    });
    this.resize();
    this.reset();
    new ResizeObserver(() => this.resize()).observe(canvases[0].parentElement!);
  }

  show(colorings: Coloring[]): void {
    this.views.forEach((view, i) => view.show(colorings[i]));
    this.draw();
  }

  set edges(on: boolean) {
    for (const view of this.views) view.edges = on;
    this.draw();
  }

  /** Camera position, target and up, nine numbers. */
  get state(): number[] {
    return [this.camera.position, this.target, this.camera.up].flatMap((v) => v.toArray());
  }

  reset(): void {
    this.marked = null;
    const narrow = Math.min(1, this.camera.aspect);
    const far = (1.02 * this.radius) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    const from = new Vector3(0.45, 0.35, 1).normalize().multiplyScalar(far);
    this.fly(from, new Vector3(), new Vector3(0, 1, 0), this.flight === 0 ? 0 : 400);
  }

  /** Marks a spot and looks at it from outside. */
  visit(spot: Spot): void {
    const at = new Vector3(...spot.at);
    const normal = new Vector3(...spot.normal).normalize();
    const far = Math.min(this.radius * 3, Math.max(spot.size * 12, this.radius * 1e-4));
    this.marked = at;
    this.fly(at.clone().addScaledVector(normal, far), at, this.camera.up.clone(), 600);
  }

  /** The triangle under a pointer event, of the view it happened in. */
  pick(event: PointerEvent): { view: number; triangle: number } | null {
    const view = this.views.findIndex((v) => v.canvas === event.target);
    if (view < 0) return null;
    const box = this.views[view].canvas.getBoundingClientRect();
    const ray = new Raycaster();
    ray.setFromCamera(
      new Vector2(
        (2 * (event.clientX - box.left)) / box.width - 1,
        1 - (2 * (event.clientY - box.top)) / box.height,
      ),
      this.camera,
    );
    const hit = ray.intersectObject(this.views[view].drawn)[0];
    return hit ? { view, triangle: hit.faceIndex! } : null;
  }

  private fly(position: Vector3, target: Vector3, up: Vector3, milliseconds: number): void {
    const flight = ++this.flight;
    const from = [this.camera.position.clone(), this.target.clone(), this.camera.up.clone()];
    // No view along its own upward direction.
    const eye = position.clone().sub(target).normalize();
    if (Math.abs(up.dot(eye)) > 0.98) up = new Vector3(eye.z, eye.x, eye.y);
    up.addScaledVector(eye, -up.dot(eye)).normalize();
    const start = performance.now();
    const step = () => {
      if (flight !== this.flight) return; // another one has begun
      const x = milliseconds > 0 ? Math.min(1, (performance.now() - start) / milliseconds) : 1;
      const f = x * x * (3 - 2 * x);
      this.camera.position.lerpVectors(from[0], position, f);
      this.target.lerpVectors(from[1], target, f);
      this.camera.up.lerpVectors(from[2], up, f).normalize();
      this.camera.lookAt(this.target);
      this.draw();
      this.flying = x < 1;
      if (this.flying) requestAnimationFrame(step);
    };
    step();
  }

  private resize(): void {
    for (const view of this.views) {
      const { width, height } = view.resize();
      this.camera.aspect = width / Math.max(1, height);
    }
    this.camera.updateProjectionMatrix();
    for (const controls of this.controls) controls.handleResize();
    this.draw();
  }

  private draw(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      const far = this.camera.position.length() + 1.5 * this.radius;
      this.camera.far = far;
      this.camera.near = Math.max(far * 2e-4, this.camera.position.length() - 1.5 * this.radius);
      this.camera.near = Math.min(
        this.camera.near,
        0.2 * this.camera.position.distanceTo(this.target),
      );
      this.camera.updateProjectionMatrix();
      for (const view of this.views) {
        view.render(this.camera);
        this.placeRing(view);
      }
    });
  }

  // The ring around the marked spot.
  private placeRing(view: View): void {
    const ring = view.canvas.parentElement!.querySelector<HTMLElement>(".ring")!;
    const p = this.marked && this.marked.clone().project(this.camera);
    ring.hidden = !p || Math.abs(p.z) > 1;
    if (!p || ring.hidden) return;
    const { clientWidth, clientHeight } = view.canvas;
    ring.style.left = `${((p.x + 1) / 2) * clientWidth}px`;
    ring.style.top = `${((1 - p.y) / 2) * clientHeight}px`;
  }
}
