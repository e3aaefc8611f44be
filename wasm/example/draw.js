// SPDX-License-Identifier: Apache-2.0
// Outlines on slices to a surface, without a server: kontur-wasm in a worker, two canvases.
import { Kontur, KonturWorker } from "./kontur-wasm/index.js";

const MM_PER_PIXEL = 0.4;
const byId = (id) => document.getElementById(id);
const slice = byId("slice"),
  surface = byId("surface"),
  height = byId("height"),
  told = byId("told");
const module = await WebAssembly.compile(await (await fetch("./kontur-wasm/kontur.wasm")).arrayBuffer());
const kontur = new KonturWorker(module, () => new Worker(new URL("./kontur-wasm/worker.js", import.meta.url), { type: "module" }));

let planes = [];
let center = [0, 0, 0]; // of what is shown, mm
let mesh;
let outline = [];
let turn = [0.6, -1.1];
let line; // being drawn

const z = () => Number(height.value) + center[2];
const toMm = (event) => [(event.offsetX - slice.width / 2) * MM_PER_PIXEL + center[0], (event.offsetY - slice.height / 2) * MM_PER_PIXEL + center[1], z()];
const toPixel = ([x, y]) => [(x - center[0]) / MM_PER_PIXEL + slice.width / 2, (y - center[1]) / MM_PER_PIXEL + slice.height / 2];

function stroke(context, points, closed, color) {
  context.strokeStyle = color;
  context.lineWidth = 2;
  context.beginPath();
  for (const point of points) context.lineTo(...toPixel(point));
  if (closed) context.closePath();
  context.stroke();
}

function showSlice() {
  const context = slice.getContext("2d");
  context.clearRect(0, 0, slice.width, slice.height);
  byId("mm").textContent = `${height.value} mm`;
  for (const { closed, points } of outline)
    stroke(
      context,
      Array.from({ length: points.length / 3 }, (_, n) => points.slice(3 * n, 3 * n + 3)),
      closed,
      "#e8a33d",
    );
  for (const plane of planes)
    if (Math.abs(plane.normal[2]) > 0.999 && Math.abs(plane.origin[2] - z()) < 0.5)
      for (const { points } of plane.contours) stroke(context, points, true, "#58b4ff");
  if (line) stroke(context, line, false, "#ffffff");
}

/** Triangles from the farthest to the nearest, as bright as they face the eye. */
function showSurface() {
  const context = surface.getContext("2d");
  context.clearRect(0, 0, surface.width, surface.height);
  if (!mesh) return;
  const [a, b] = turn,
    [ca, sa, cb, sb] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
  const seen = (v, n, at) => {
    const [x, y, z] = [v[3 * n] - at[0], v[3 * n + 1] - at[1], v[3 * n + 2] - at[2]];
    const [p, q] = [ca * x - sa * y, sa * x + ca * y];
    return [p, cb * q - sb * z, sb * q + cb * z];
  };
  const faces = [];
  for (let t = 0; t < mesh.triangles.length; t += 3) {
    const corners = [0, 1, 2].map((n) => seen(mesh.points, mesh.triangles[t + n], center));
    const facing = seen(mesh.normals, mesh.triangles[t], [0, 0, 0])[2];
    if (facing > -0.2) faces.push({ corners, facing, depth: corners[0][2] });
  }
  faces.sort((one, other) => one.depth - other.depth);
  for (const { corners, facing } of faces) {
    const light = Math.round(60 + 170 * Math.max(0, facing));
    context.fillStyle = context.strokeStyle = `rgb(${light}, ${Math.round(0.72 * light)}, ${Math.round(0.45 * light)})`;
    context.beginPath();
    for (const [x, y] of corners) context.lineTo(x / MM_PER_PIXEL + surface.width / 2, -y / MM_PER_PIXEL + surface.height / 2);
    context.closePath();
    context.fill();
    context.stroke();
  }
}

function millilitres({ points, triangles }) {
  let sum = 0;
  const at = (n) => points.subarray(3 * n, 3 * n + 3);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((n) => at(triangles[t + n]));
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6000;
}

async function showOutline() {
  outline = mesh ? await kontur.outline({ origin: [0, 0, z()], normal: [0, 0, 1] }) : [];
  showSlice();
}

async function fit() {
  mesh = undefined;
  try {
    if (planes.length > 0) ({ mesh } = await kontur.preview({ frame: "LPS mm", planes }));
    told.textContent = mesh ? `${planes.length} ${planes.length === 1 ? "outline" : "outlines"}, ${millilitres(mesh).toFixed(1)} ml` : "Drag on the left.";
  } catch (error) {
    told.textContent = error.message;
  }
  showSurface();
  await showOutline();
}

slice.onpointerdown = (event) => {
  slice.setPointerCapture(event.pointerId);
  line = [toMm(event)];
};
slice.onpointermove = (event) => {
  if (!line) return;
  line.push(toMm(event));
  showSlice();
};
slice.onpointerup = () => {
  if (line?.length > 2) planes.push({ origin: [0, 0, z()], normal: [0, 0, 1], u: [1, 0, 0], v: [0, 1, 0], contours: [{ closed: true, points: line }] });
  line = undefined;
  void fit();
};
surface.onpointermove = (event) => {
  if (event.buttons === 0) return;
  turn = [turn[0] + 0.01 * event.movementX, turn[1] + 0.01 * event.movementY];
  showSurface();
};
height.oninput = () => void showOutline();
byId("undo").onclick = () => {
  planes.pop();
  void fit();
};
byId("phantom").onclick = async () => {
  ({ planes } = (await Kontur.load(module)).phantom("kidney_radial6").contours);
  const points = planes.flatMap((plane) => plane.contours.flatMap((contour) => contour.points));
  center = [0, 1, 2].map((axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length);
  await fit();
};
showSlice();
