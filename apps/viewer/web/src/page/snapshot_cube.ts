// SPDX-License-Identifier: Apache-2.0
import { cross, dot, type Vec3 } from "../geometry/vec";
import { sidesInSight, type ViewAxes } from "../three/cube";

const FACE = "#3a434d";
const EDGE = "#aab4bf";
const SHARE = 0.3; // of its place: half of an edge, so that corners stay within

/** The cube of the 3D view as it lies, with the letters of the sides that are turned to the viewer. */
export function paintCube(context: CanvasRenderingContext2D, axes: ViewAxes, box: DOMRect, area: DOMRect): void {
  const [x, y] = [box.left - area.left + box.width / 2, box.top - area.top + box.height / 2];
  const half = SHARE * Math.min(box.width, box.height);
  const seen = (p: Vec3): [number, number] => [x + half * dot(p, axes.right), y - half * dot(p, axes.up)];
  for (const { letter, from, up } of sidesInSight(axes)) {
    const across = cross(up, from);
    const corner = (i: number, j: number): Vec3 => [0, 1, 2].map((k) => from[k]! + i * across[k]! + j * up[k]!) as unknown as Vec3;
    const path = new Path2D();
    for (const p of [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)]) path.lineTo(...seen(p));
    path.closePath();
    context.fillStyle = FACE;
    context.fill(path);
    context.strokeStyle = EDGE;
    context.lineWidth = 1;
    context.stroke(path);
    context.font = `600 ${Math.round(half)}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillStyle = "#ffffff";
    context.fillText(letter, ...seen(from));
  }
  context.textAlign = "start";
  context.textBaseline = "alphabetic";
}
