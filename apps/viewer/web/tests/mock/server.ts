// SPDX-License-Identifier: Apache-2.0
// A stand-in for `kontur open` to work on the page without a build of the program: `npm run mock`, then `npx vite` and
// http://127.0.0.1:5173/#mock. The image is two balls, the surface of any contours the ball around them.
import { createServer, type IncomingMessage, type ServerResponse } from "node:http";
import type { Socket } from "node:net";
import type { Plane } from "../../src/geometry/plane";
import { heightOver, projected } from "../../src/geometry/plane";
import { add, cross, distance, dot, length, mix, scale, sub, type Vec3 } from "../../src/geometry/vec";
import type { Changed, Contour, ControlPoint, Session, SketchPoint, SliceRequest, Structure, ViewGeometry } from "../../src/net/protocol";
import { TextSocket } from "./websocket";

const PORT = 8420;
const HALF: Vec3 = [160, 120, 100];
const BALLS: { center: Vec3; radius: number; value: number }[] = [
  { center: [20, 0, 0], radius: 80, value: 60 },
  { center: [55, 10, 15], radius: 18, value: 20 },
  { center: [-90, 30, -10], radius: 30, value: 220 },
];

function view(u: Vec3, v: Vec3): ViewGeometry {
  const normal = cross(u, v);
  const reach = (direction: Vec3) => direction.reduce((sum, value, i) => sum + Math.abs(value) * HALF[i]!, 0);
  return { plane: { origin: [0, 0, 0], u, v, normal }, step_mm: 2, width_mm: 2 * reach(u), height_mm: 2 * reach(v), range_mm: [-reach(normal), reach(normal)] };
}

const valueAt = (p: Vec3): number => BALLS.reduce((value, ball) => (distance(p, ball.center) < ball.radius ? ball.value : value), -80);

let state = { structures: [{ id: 1, name: "Structure 1", color: "#e8b04a", visible: true }] as Structure[], contours: [] as Contour[] };
const past: { label: string; state: typeof state }[] = [];
const future: { label: string; state: typeof state }[] = [];
let page: unknown = null;
let nextId = 2;
let revision = 0;
const sockets = new Set<TextSocket>();
const tell = (event: unknown) => sockets.forEach((socket) => socket.send(event));

function session(): Session {
  const corners = Array.from({ length: 8 }, (_, k): Vec3 => [k & 1 ? HALF[0] : -HALF[0], k & 2 ? HALF[1] : -HALF[1], k & 4 ? HALF[2] : -HALF[2]]);
  const s = Math.SQRT1_2;
  return {
    event: "session", version: "mock", title: "two balls", project: "mock.kontur",
    image: { size: [160, 120, 100], spacing_mm: [2, 2, 2], corners, center: [0, 0, 0], unit: "HU", range: [-1000, 1000], notes: [] },
    window: { center: 40, width: 400 },
    presets: [{ name: "Abdomen", center: 40, width: 400 }, { name: "Lung", center: -600, width: 1500 }, { name: "Bone", center: 400, width: 1800 }],
    views: { axial: view([1, 0, 0], [0, 1, 0]), sagittal: view([0, 1, 0], [0, 0, -1]), coronal: view([1, 0, 0], [0, 0, -1]), oblique: view([s, s, 0], [0, 0, -1]) },
    ...state, surfaces: surfaces(), history: history(), page,
  };
}

const history = () => ({ undo: past.at(-1)?.label ?? null, redo: future.at(-1)?.label ?? null });

function ballOf(structure: number): { center: Vec3; radius: number } | null {
  const points = state.contours.filter((contour) => contour.structure === structure && contour.visible).flatMap((contour) => contour.points);
  if (points.length === 0) return null;
  const center = scale(points.reduce(add), 1 / points.length);
  return { center, radius: Math.max(...points.map((p) => distance(p, center))) };
}

function surfaces() {
  return state.structures.map(({ id }) => {
    const ball = ballOf(id);
    if (!ball) return { structure: id, revision, stage: "none" as const, triangles: 0 };
    const at = add(ball.center, [ball.radius, 0, 0]);
    return {
      structure: id, revision, stage: "refined" as const, triangles: 960, volume_ml: (4.18879 * ball.radius ** 3) / 1000,
      residual: { max_mm: 1.5, rms_mm: 0.3, contour: state.contours[0]!.id, at }, conflicts: [{ at, distance_mm: 2.1, contours: [1, 2] as [number, number] }], warnings: [],
    };
  });
}

function commit(label: string, next: typeof state): void {
  past.push({ label, state });
  future.length = 0;
  become(next);
}

function become(next: typeof state): void {
  const gone = <Row extends { id: number }>(before: Row[], after: Row[]) => before.map((row) => row.id).filter((id) => !after.some((row) => row.id === id));
  const changed: Changed = {
    event: "changed", history: history(),
    structures: { set: next.structures, removed: gone(state.structures, next.structures) },
    contours: { set: next.contours, removed: gone(state.contours, next.contours) },
  };
  state = next;
  ++revision;
  tell(changed);
  for (const surface of surfaces()) tell({ event: "surface", ...surface });
}

function line(control: SketchPoint[], closed: boolean, plane: Plane): { points: Vec3[]; control: ControlPoint[] } {
  const points: Vec3[] = [];
  const placed = control.map(({ at, kind, path }, i): ControlPoint => {
    const index = points.length;
    points.push(projected(plane, at), ...(path ?? []).map((p) => projected(plane, p)));
    const next = control[i + 1] ?? (closed ? control[0] : undefined);
    if (next && !path) for (let t = 0.1; t < 0.95; t += 0.1) points.push(projected(plane, mix(at, next.at, t)));
    return { at, kind, index };
  });
  return { points, control: placed };
}

function replace(id: number, label: string, edit: (contour: Contour) => Contour, draft: boolean): { contour: Contour } {
  const edited = edit(state.contours.find((contour) => contour.id === id)!);
  if (!draft) commit(label, { ...state, contours: state.contours.map((contour) => (contour.id === id ? edited : contour)) });
  return { contour: edited };
}

const again = (contour: Contour, control: ControlPoint[]): Contour => ({ ...contour, ...line(control, true, contour.plane) });

type Arguments = Record<string, any>;
const CALLS: Record<string, (a: Arguments) => unknown> = {
  "path": (a) => line(a.control, a.closed ?? false, a.plane),
  "contour.add": (a) => {
    const id = nextId++;
    const kinds = new Set(a.control.map((point: SketchPoint) => point.kind));
    const kind = kinds.size > 1 ? "mixed" : kinds.has("free") ? "freehand" : kinds.has("wire") ? "livewire" : "spline";
    commit("Draw a contour", { ...state, contours: [...state.contours, { id, structure: a.structure, kind, plane: a.plane, hole: false, visible: true, ...line(a.control, true, a.plane) }] });
    return { contour: id };
  },
  "contour.move_point": (a) => replace(a.id, "Move a point", (c) => again(c, c.control.map((point, i) => (i === a.index ? { ...point, at: a.to } : point))), a.draft),
  "contour.insert_point": (a) => replace(a.id, "Insert a point", (c) => again(c, [...c.control, { at: a.at, kind: "line", index: 0 }]), a.draft),
  "contour.delete_point": (a) => replace(a.id, "Delete a point", (c) => again(c, c.control.filter((_, i) => i !== a.index)), a.draft),
  "contour.pull": (a) => replace(a.id, "Bend a contour", (c) => ({ ...c, points: c.points.map((p) => add(p, scale(sub(a.to, a.from), Math.exp(-((distance(p, a.from) / 15) ** 2))))) }), a.draft),
  "contour.redraw": (a) => replace(a.id, "Redraw a part", (c) => c, a.draft),
  "contour.translate": (a) => replace(a.id, "Move a contour", (c) => ({ ...c, points: c.points.map((p) => add(p, a.by)), control: c.control.map((point) => ({ ...point, at: add(point.at, a.by) })) }), a.draft),
  "contour.copy": (a) => {
    const contour = state.contours.find((c) => c.id === a.id)!;
    const by = scale(contour.plane.normal, a.offset_mm);
    const copy = { ...contour, id: nextId++, plane: { ...contour.plane, origin: add(contour.plane.origin, by) }, points: contour.points.map((p) => add(p, by)), control: contour.control.map((point) => ({ ...point, at: add(point.at, by) })) };
    commit("Copy a contour", { ...state, contours: [...state.contours, copy] });
    return { contour: copy };
  },
  "contour.set": (a) => replace(a.id, "Change a contour", (c) => ({ ...c, ...a }), false),
  "contour.remove": (a) => commit("Delete a contour", { ...state, contours: state.contours.filter((c) => !a.ids.includes(c.id)) }),
  "structure.add": () => {
    const structure = { id: nextId++, name: `Structure ${state.structures.length + 1}`, color: "#6fb1ff", visible: true };
    commit("Add a structure", { ...state, structures: [...state.structures, structure] });
    return { structure };
  },
  "structure.set": (a) => commit("Change a structure", { ...state, structures: state.structures.map((s) => (s.id === a.id ? { ...s, ...a } : s)) }),
  "structure.remove": (a) => commit("Delete a structure", { structures: state.structures.filter((s) => s.id !== a.id), contours: state.contours.filter((c) => c.structure !== a.id) }),
  "undo": () => move(past, future),
  "redo": () => move(future, past),
  "value": (a) => ({ value: valueAt(a.at) }),
  "page.save": (a) => void (page = a.state),
};

function move(from: typeof past, to: typeof past): unknown {
  const step = from.pop();
  if (!step) return { label: null };
  to.push({ label: step.label, state });
  become(step.state);
  return { label: step.label };
}

// Binary replies

function binary(header: object, arrays: Record<string, Uint8Array | Uint32Array | Float32Array>): Buffer {
  const entries: Record<string, unknown> = {};
  const typeOf = (a: object) => (a instanceof Uint8Array ? "u8" : a instanceof Uint32Array ? "u32" : "f32");
  const text = () => JSON.stringify({ ...header, arrays: entries }).padEnd(8000 + JSON.stringify(header).length);
  for (const [name, array] of Object.entries(arrays)) entries[name] = { type: typeOf(array), offset: 10_000_000, count: array.length };
  const size = Math.ceil((4 + text().length) / 4) * 4;
  let offset = size;
  for (const [name, array] of Object.entries(arrays)) {
    entries[name] = { type: typeOf(array), offset, count: array.length };
    offset += Math.ceil(array.byteLength / 4) * 4;
  }
  const reply = Buffer.alloc(offset, " ");
  reply.writeUInt32LE(size - 4, 0);
  reply.write(text(), 4);
  for (const [name, array] of Object.entries(arrays)) reply.set(new Uint8Array(array.buffer), (entries[name] as { offset: number }).offset);
  return reply;
}

const LETTERS = [["R", "L"], ["A", "P"], ["I", "S"]] as const;
const letter = (d: Vec3): string => {
  const axis = d.reduce((best, value, i) => (Math.abs(value) > Math.abs(d[best]!) ? i : best), 0);
  return LETTERS[axis]![d[axis]! > 0 ? 1 : 0];
};

function slice({ plane, width, height, window, pixels }: SliceRequest): Buffer {
  const gray = new Uint8Array(pixels ? width * height : 0);
  for (let i = 0; i < gray.length; ++i) {
    const p = add(plane.origin, add(scale(plane.u, (i % width) * plane.mm_per_pixel), scale(plane.v, Math.floor(i / width) * plane.mm_per_pixel)));
    const inside = p.every((value, axis) => Math.abs(value) <= HALF[axis]!);
    gray[i] = inside ? Math.min(255, Math.max(0, 255 * ((valueAt(p) - window.center) / window.width + 0.5))) : 0;
  }
  const toPixel = (p: Vec3) => [dot(sub(p, plane.origin), plane.u), dot(sub(p, plane.origin), plane.v)].map((mm) => mm / plane.mm_per_pixel);
  const outlines: unknown[] = [], outlinePoints: number[] = [];
  for (const { id, visible } of state.structures) {
    const ball = ballOf(id);
    const height_mm = ball ? heightOver(plane, ball.center) : 0;
    if (!ball || !visible || Math.abs(height_mm) >= ball.radius) continue;
    const radius = Math.sqrt(ball.radius ** 2 - height_mm ** 2);
    const first = outlinePoints.length / 2;
    for (let k = 0; k < 90; ++k)
      outlinePoints.push(...toPixel(add(ball.center, add(scale(plane.u, radius * Math.cos(k / 14.32)), scale(plane.v, radius * Math.sin(k / 14.32))))));
    outlines.push({ structure: id, revision, lines: [{ first, count: 90, closed: true }] });
  }
  const crossings: unknown[] = [], crossingPoints: number[] = [];
  for (const contour of state.contours) {
    if (length(cross(contour.plane.normal, plane.normal)) < 1e-3) continue;
    const first = crossingPoints.length / 2;
    contour.points.forEach((p, i) => {
      const q = contour.points[(i + 1) % contour.points.length]!;
      const a = heightOver(plane, p), b = heightOver(plane, q);
      if (a > 0 !== b > 0) crossingPoints.push(...toPixel(mix(p, q, a / (a - b))));
    });
    crossings.push({ contour: contour.id, first, count: crossingPoints.length / 2 - first });
  }
  const letters = { left: letter(scale(plane.u, -1)), right: letter(plane.u), top: letter(scale(plane.v, -1)), bottom: letter(plane.v) };
  return binary(
    { width, height, letters, outlines, crossings, contours: [] },
    { outline_points: Float32Array.from(outlinePoints), crossing_points: Float32Array.from(crossingPoints), ...(pixels ? { pixels: gray } : {}) },
  );
}

function mesh(structure: number): Buffer | null {
  const ball = ballOf(structure);
  if (!ball) return null;
  const normals: number[] = [], positions: number[] = [], triangles: number[] = [];
  const rows = 32, columns = 64;
  for (let i = 0; i <= rows; ++i)
    for (let j = 0; j < columns; ++j) {
      const a = (Math.PI * i) / rows, b = (2 * Math.PI * j) / columns;
      const n: Vec3 = [Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)];
      normals.push(...n);
      positions.push(...add(ball.center, scale(n, ball.radius)));
      const k = i * columns + j, right = i * columns + ((j + 1) % columns);
      if (i < rows) triangles.push(k, k + columns, right, right, k + columns, right + columns);
    }
  return binary({ structure, revision, stage: "refined" }, { positions: Float32Array.from(positions), normals: Float32Array.from(normals), triangles: Uint32Array.from(triangles) });
}

async function body(request: IncomingMessage): Promise<string> {
  const parts: Buffer[] = [];
  for await (const part of request) parts.push(part as Buffer);
  return Buffer.concat(parts).toString();
}

async function answer(request: IncomingMessage, response: ServerResponse): Promise<void> {
  const path = request.url ?? "";
  if (path === "/api/slice") return void response.end(slice(JSON.parse(await body(request)) as SliceRequest));
  const reply = path.startsWith("/api/mesh/") ? mesh(Number(path.split("/").at(-1))) : null;
  if (reply) return void response.end(reply);
  response.statusCode = 404;
  response.end(JSON.stringify({ error: { kind: "not_found", message: `The mock has no ${path}.` } }));
}

const server = createServer((request, response) => void answer(request, response));
server.on("upgrade", (request: IncomingMessage, socket: Socket) => {
  const connection = new TextSocket(request, socket);
  sockets.add(connection);
  socket.on("close", () => sockets.delete(connection));
  connection.onText = (text) => {
    const { id, call, ...args } = JSON.parse(text) as Arguments;
    const carryOut = CALLS[call];
    if (carryOut) connection.send({ id, result: carryOut(args) ?? {} });
    else connection.send({ id, error: { kind: "invalid_input", message: `The mock has no call "${call}".` } });
  };
  connection.send(session());
});
server.listen(PORT, "127.0.0.1", () => console.log(`mock of kontur open on port ${PORT}: npx vite, then http://127.0.0.1:5173/#mock`));
