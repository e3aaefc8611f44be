// SPDX-License-Identifier: Apache-2.0
import * as THREE from "three";
import { TrackballControls } from "three/examples/jsm/controls/TrackballControls.js";
import { boxSection } from "../geometry/plane";
import type { Plane } from "../geometry/plane";
import { add, distance, scale, type Vec3 } from "../geometry/vec";
import type { Scheme } from "../model/theme";
import { tinted } from "../model/palette";
import { coarseTriangles } from "./coarse";
import { drawsInSoftware, Materials, type SurfaceMaterial } from "./materials";
import { Pace } from "./pace";

export interface MeshData {
  positions: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
  /** Of each point, linear; without them the surface has one colour. */
  colors?: Float32Array | undefined;
}

export interface ScenePoint {
  at: Vec3;
  color: string;
  selected: boolean;
  isOnSurface: boolean;
}

/** A surface, and the same with fewer triangles for when it must be drawn fast. */
interface Shown {
  mesh: THREE.Mesh<THREE.BufferGeometry, SurfaceMaterial>;
  fine: THREE.BufferGeometry;
  coarse: THREE.BufferGeometry | null;
  style: string;
}

const MARK_PIXELS = 4.5; // their radius
const LOOK_MS = 3; // how often to look whether a frame is finished
const ROUGH_PIXELS = 0.5; // along each side, of the screen's

const vector = (p: Vec3): THREE.Vector3 => new THREE.Vector3(p[0], p[1], p[2]);

/** Surfaces, contours and slice planes in space; drawn only when something has changed. */
export class Scene {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.OrthographicCamera();
  private readonly controls: TrackballControls;
  private readonly light = new THREE.DirectionalLight(0xffffff, 2.1);
  private readonly surfaces = new Map<number, Shown>();
  private readonly lines = new THREE.Group();
  private readonly planes = new THREE.Group();
  private readonly marks = new THREE.Group();
  private readonly points = new THREE.Group();
  private readonly box: THREE.LineSegments; // the image's edges, while there is no surface
  private readonly extent_mm: number;
  private readonly center: Vec3;
  private readonly pace: Pace;
  private readonly isSoftware = drawsInSoftware();
  private readonly materials = new Materials(this.isSoftware);
  private aspect = 1;
  private ground: Scheme = "dark"; // what lies behind all
  private touched = false; // the user has turned, zoomed or shifted the view: it stays as he wants it

  /** Throws where the browser has no WebGL. `begin` is called as a frame begins, and what it returns when that is finished. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly corners: readonly Vec3[],
    private readonly begin: () => () => void,
  ) {
    // Without a graphics processor smooth edges more than double a frame's time, and slices wait for it, too.
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.isSoftware, alpha: true, powerPreference: "high-performance" });
    let isHeld = false;
    for (const type of ["pointerdown", "pointermove", "pointerup", "pointercancel"] as const)
      window.addEventListener(type, (event) => void (isHeld = event.buttons !== 0), { capture: true });
    this.pace = new Pace({
      frame: () => new Promise((resolve) => void requestAnimationFrame(() => resolve())),
      render: (fine) => this.render(fine),
      isHeld: () => isHeld,
      later: (act, ms) => void window.setTimeout(act, ms),
      now: () => performance.now(),
    });
    this.center = scale(corners.reduce(add), 1 / corners.length);
    this.extent_mm = Math.max(...corners.map((corner) => distance(corner, this.center)));
    this.scene.add(new THREE.HemisphereLight(0xdfe8f5, 0x2a2f38, 1.5), this.light, this.lines, this.planes, this.marks, this.points);
    this.scene.add((this.box = this.imageBox()));
    this.controls = new TrackballControls(this.camera, canvas);
    Object.assign(this.controls, { rotateSpeed: 3, zoomSpeed: 1.2, panSpeed: 0.9, staticMoving: true });
    this.controls.addEventListener("change", () => this.pace.changed());
    this.controls.addEventListener("start", () => void (this.touched = true));
    this.viewFrom([0.55, -1, 0.45], this.center, this.extent_mm);
    canvas.addEventListener("pointermove", () => this.controls.update());
    canvas.addEventListener("wheel", () => void requestAnimationFrame(() => this.controls.update()));
    this.canvas.addEventListener("webglcontextrestored", () => this.pace.changed());
  }

  resize(width: number, height: number): void {
    if (width < 2 || height < 2) return;
    this.renderer.setSize(width, height, false);
    this.setPixels(true);
    this.aspect = width / height;
    this.setFrustum();
    this.controls.handleResize();
    this.pace.changed();
  }

  setMesh(structure: number, data: MeshData): void {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(data.positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(data.normals, 3));
    if (data.colors) geometry.setAttribute("color", new THREE.BufferAttribute(data.colors, 3));
    geometry.setIndex(new THREE.BufferAttribute(data.triangles, 1));
    const shown = this.surfaces.get(structure) ?? this.addMesh(structure);
    shown.fine.dispose();
    shown.coarse?.dispose();
    Object.assign(shown, { fine: geometry, coarse: null });
    shown.mesh.geometry = geometry;
    if (!this.touched && !this.isInSight()) this.frame();
    this.pace.changed();
  }

  private addMesh(structure: number): Shown {
    const mesh = new THREE.Mesh(new THREE.BufferGeometry(), this.materials.surface());
    const shown = { mesh, fine: mesh.geometry, coarse: null, style: "" };
    this.surfaces.set(structure, shown);
    this.scene.add(mesh);
    return shown;
  }

  removeMesh(structure: number): void {
    const shown = this.surfaces.get(structure);
    if (!shown) return;
    this.scene.remove(shown.mesh);
    shown.fine.dispose();
    shown.coarse?.dispose();
    shown.mesh.material.dispose();
    this.surfaces.delete(structure);
    this.pace.changed();
  }

  style(structure: number, color: string, visible: boolean, opacity: number): void {
    const shown = this.surfaces.get(structure);
    if (!shown) return;
    const hasColors = shown.fine.hasAttribute("color");
    const wanted = `${color} ${visible} ${opacity} ${hasColors}`;
    if (shown.style === wanted) return;
    shown.style = wanted;
    const { mesh } = shown;
    this.materials.look(mesh.material, color, opacity, hasColors);
    mesh.visible = visible;
    this.pace.changed();
  }

  /** The structures that have a mesh. */
  get meshes(): number[] {
    return [...this.surfaces.keys()];
  }

  /** What lines that are set from now on are seen before. */
  setGround(ground: Scheme): void {
    this.ground = ground;
    this.box.material = this.materials.line(ground === "light" ? "#6d7a88" : "#56606c", 0.5);
    this.pace.changed();
  }

  /** Away from the ground. */
  private stands(color: string, t: number): string {
    return tinted(color, this.ground === "light" ? -t : t);
  }

  setContours(contours: { points: readonly Vec3[]; closed: boolean; color: string; selected: boolean }[]): void {
    this.clear(this.lines);
    for (const { points, closed, color, selected } of contours) {
      const geometry = new THREE.BufferGeometry().setFromPoints(points.map(vector));
      const material = this.materials.line(this.stands(color, selected ? 0.95 : 0.6), 1);
      this.lines.add(closed ? new THREE.LineLoop(geometry, material) : new THREE.Line(geometry, material));
    }
    this.pace.changed(true);
  }

  setPlanes(planes: { plane: Plane; color: string }[]): void {
    this.clear(this.planes);
    for (const { plane, color } of planes) {
      const outline = boxSection(this.corners, plane);
      if (outline.length < 3) continue;
      const points = outline.map(vector);
      const fan = outline.slice(2).flatMap((_, i) => [0, i + 1, i + 2]);
      const sheet = new THREE.BufferGeometry().setFromPoints(points).setIndex(fan);
      const rim = new THREE.BufferGeometry().setFromPoints(points);
      this.planes.add(
        new THREE.Mesh(sheet, this.materials.glass(color)),
        new THREE.LineLoop(rim, this.ground === "light" ? this.materials.line(tinted(color, -0.25), 0.7) : this.materials.line(color, 0.4)),
      );
    }
    this.pace.changed(true);
  }

  setMarks(places: readonly Vec3[]): void {
    if (places.length === 0 && this.marks.children.length === 0) return;
    this.clear(this.marks);
    for (const place of places) this.marks.add(ball(place, this.materials.mark()));
    this.pace.changed(true);
  }

  /** Single points: those that surfaces pass are seen where the surface is, the others through it. */
  setPoints(points: readonly ScenePoint[]): void {
    if (points.length === 0 && this.points.children.length === 0) return;
    this.clear(this.points);
    for (const { at, color, selected, isOnSurface } of points)
      this.points.add(ball(at, this.materials.point(selected ? "#ffffff" : tinted(color, 0.6), isOnSurface)));
    this.pace.changed(true);
  }

  /** Turns the camera to look at the surfaces, or at the whole image without any. */
  frame(): void {
    const towards = this.camera.position.clone().sub(this.controls.target).normalize();
    const sphere = this.surfaceSphere();
    if (!sphere) return this.viewFrom(towards.toArray(), this.center, this.extent_mm);
    this.viewFrom(towards.toArray(), sphere.center.toArray(), sphere.radius * 1.05);
  }

  private surfaceSphere(): THREE.Sphere | null {
    const all = new THREE.Sphere().makeEmpty();
    for (const { mesh, fine } of this.surfaces.values()) {
      if (!fine.boundingSphere) fine.computeBoundingSphere();
      if (mesh.visible && fine.boundingSphere) all.union(fine.boundingSphere);
    }
    return all.isEmpty() ? null : all;
  }

  /** Whether the surfaces lie within the view and fill most of it. */
  private isInSight(): boolean {
    const sphere = this.surfaceSphere();
    if (!sphere) return true;
    return sphere.center.distanceTo(this.controls.target) + sphere.radius <= 1.1 * this.radius && sphere.radius > 0.75 * this.radius;
  }

  /** Looks from this direction (LPS), head up. */
  viewFrom(direction: Vec3, target: Vec3 = this.controls.target.toArray(), radius?: number): void {
    this.controls.target.copy(vector(target));
    this.camera.up.set(0, 0, 1);
    if (Math.abs(direction[2]) > 0.95) this.camera.up.set(0, -1, 0);
    const reach = 4 * this.extent_mm;
    this.camera.position.copy(vector(target)).addScaledVector(vector(direction).normalize(), reach);
    this.camera.near = 0.01 * reach;
    this.camera.far = 3 * reach;
    if (radius !== undefined) {
      this.camera.zoom = 1;
      this.radius = radius;
    }
    this.setFrustum();
    this.controls.update();
    this.pace.changed();
  }

  /** Where a ray through this place of the canvas, in pixels, meets a surface; `only`: that of one structure. */
  pick(x: number, y: number, only?: number): { structure: number; at: Vec3 } | null {
    return this.meets(this.rayThrough(x, y), only);
  }

  /** The place of the canvas, at the same distance from the viewer as another place. */
  beside(p: Vec3, x: number, y: number): Vec3 {
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(vector(this.axes.back), vector(p));
    return this.rayThrough(x, y).ray.intersectPlane(plane, new THREE.Vector3())?.toArray() ?? p;
  }

  private rayThrough(x: number, y: number): THREE.Raycaster {
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / this.canvas.clientWidth - 1, 1 - (2 * y) / this.canvas.clientHeight), this.camera);
    return ray;
  }

  private meets(ray: THREE.Raycaster, only?: number): { structure: number; at: Vec3 } | null {
    let nearest: { structure: number; at: Vec3; distance: number } | null = null;
    for (const [structure, { mesh, fine }] of this.surfaces) {
      if (!mesh.visible || structure !== (only ?? structure)) continue;
      mesh.geometry = fine; // a rough one is millimetres off
      const hit = ray.intersectObject(mesh)[0];
      if (hit && hit.distance < (nearest?.distance ?? Infinity)) nearest = { structure, at: hit.point.toArray(), distance: hit.distance };
    }
    return nearest;
  }

  private radius = 100;

  private setFrustum(): void {
    const half = this.radius * Math.max(1, 1 / this.aspect);
    Object.assign(this.camera, { left: -half * this.aspect, right: half * this.aspect, top: half, bottom: -half });
    this.camera.updateProjectionMatrix();
  }

  /** Without a graphics processor a rough frame has a quarter of the pixels: each one costs. */
  private setPixels(fine: boolean): void {
    const share = fine || !this.isSoftware ? 1 : ROUGH_PIXELS;
    const ratio = share * Math.min(window.devicePixelRatio || 1, 2);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    this.materials.drawOn(share);
  }

  /** Once more and at once, for who wants to copy it: the canvas forgets its picture after each frame. */
  redraw(): void {
    this.renderer.render(this.scene, this.camera);
  }

  private async render(fine: boolean): Promise<boolean> {
    if (this.canvas.clientWidth === 0) return false; // another view is shown alone; resize() draws when this one comes back
    this.setPixels(fine);
    for (const shown of this.surfaces.values()) shown.mesh.geometry = fine ? shown.fine : (shown.coarse ??= coarse(shown.fine));
    this.light.position.copy(this.camera.position).add(new THREE.Vector3(0, 0, this.extent_mm));
    this.light.target.position.copy(this.controls.target);
    this.light.target.updateMatrixWorld();
    this.camera.updateMatrixWorld(); // who is told that the frame begins asks which way it looks
    this.sizeMarks();
    this.box.visible = this.surfaces.size === 0;
    const drawn = this.begin();
    this.renderer.render(this.scene, this.camera);
    await this.finished();
    drawn();
    return true;
  }

  /** Settles when the graphics processor, or what stands in for it, has drawn all that it was told. */
  private finished(): Promise<void> {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return new Promise((resolve) => {
      const look = () => {
        if (fence && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) return void setTimeout(look, LOOK_MS);
        gl.deleteSync(fence);
        resolve();
      };
      setTimeout(look, 0);
    });
  }

  /** Of a CSS pixel, everywhere alike: there is no perspective. */
  get mm_per_pixel(): number {
    return (this.camera.top - this.camera.bottom) / this.camera.zoom / Math.max(this.canvas.clientHeight, 1);
  }

  /** Which way (LPS) is right and up on the screen, and towards the viewer. */
  get axes(): { right: Vec3; up: Vec3; back: Vec3 } {
    const [right, up, back] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    this.camera.matrixWorld.extractBasis(right, up, back);
    return { right: right.toArray(), up: up.toArray(), back: back.toArray() };
  }

  /** Marks keep their size on the screen. */
  private sizeMarks(): void {
    for (const mark of [...this.marks.children, ...this.points.children]) mark.scale.setScalar(MARK_PIXELS * this.mm_per_pixel);
  }

  /** The mark that is nearest to this place of the canvas, in pixels, if that is within `reach`. */
  markAt(x: number, y: number, reach: number): Vec3 | null {
    return this.nearestOf(this.marks.children, x, y, reach)?.position.toArray() ?? null;
  }

  /** The number of the point that is nearest to this place, as `setPoints` had it; none that a surface hides. */
  pointAt(x: number, y: number, reach: number): number | null {
    const all = this.points.children;
    const found = this.nearestOf(
      all.filter((point) => !this.isCovered(point)),
      x,
      y,
      reach,
    );
    return found ? all.indexOf(found) : null;
  }

  private nearestOf(objects: readonly THREE.Object3D[], x: number, y: number, reach: number): THREE.Object3D | null {
    const seen = new THREE.Vector3();
    let nearest = reach;
    let found: THREE.Object3D | null = null;
    for (const object of objects) {
      seen.copy(object.position).project(this.camera);
      const distance = Math.hypot(((seen.x + 1) / 2) * this.canvas.clientWidth - x, ((1 - seen.y) / 2) * this.canvas.clientHeight - y);
      if (distance > nearest) continue;
      nearest = distance;
      found = object;
    }
    return found;
  }

  /** Whether a surface that is no glass lies between the point and the viewer. */
  private isCovered(point: THREE.Object3D): boolean {
    const { material, position } = point as THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial>;
    if (!material.depthTest || ![...this.surfaces.values()].some(({ mesh }) => !mesh.material.transparent)) return false;
    const back = vector(this.axes.back);
    const start = position.clone().addScaledVector(back, MARK_PIXELS * this.mm_per_pixel);
    return this.meets(new THREE.Raycaster(start, back)) !== null;
  }

  private clear(group: THREE.Group): void {
    for (const child of group.children) (child as THREE.Mesh).geometry.dispose();
    group.clear();
  }

  private imageBox(): THREE.LineSegments {
    const ends: THREE.Vector3[] = [];
    for (let a = 0; a < 8; ++a) for (const bit of [1, 2, 4]) if (!(a & bit)) ends.push(vector(this.corners[a]!), vector(this.corners[a | bit]!));
    return new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(ends), this.materials.line("#56606c", 0.5));
  }
}

function ball(center: Vec3, material: THREE.Material): THREE.Mesh {
  const made = new THREE.Mesh(new THREE.SphereGeometry(1, 16, 12), material);
  made.position.copy(vector(center));
  return made;
}

function coarse(fine: THREE.BufferGeometry): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  const positions = fine.getAttribute("position");
  const triangles = fine.getIndex();
  if (!triangles) return geometry;
  geometry.setAttribute("position", positions);
  geometry.setAttribute("normal", fine.getAttribute("normal"));
  if (fine.hasAttribute("color")) geometry.setAttribute("color", fine.getAttribute("color"));
  geometry.setIndex(new THREE.BufferAttribute(coarseTriangles(positions.array as Float32Array, triangles.array as Uint32Array), 1));
  return geometry;
}
