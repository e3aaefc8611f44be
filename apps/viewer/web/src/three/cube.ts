// SPDX-License-Identifier: Apache-2.0
import { cross, dot, type Vec3 } from "../geometry/vec";
import { el } from "../dom/dom";

export interface Side {
  letter: string;
  title: string;
  /** From where one looks (LPS), and what is up then. */
  from: Vec3;
  up: Vec3;
}

const HEAD: Vec3 = [0, 0, 1];
const FRONT: Vec3 = [0, -1, 0];

export const SIDES: readonly Side[] = [
  { letter: "A", title: "From the front", from: FRONT, up: HEAD },
  { letter: "P", title: "From the back", from: [0, 1, 0], up: HEAD },
  { letter: "L", title: "From the patient's left", from: [1, 0, 0], up: HEAD },
  { letter: "R", title: "From the patient's right", from: [-1, 0, 0], up: HEAD },
  { letter: "S", title: "From above", from: HEAD, up: FRONT },
  { letter: "I", title: "From below", from: [0, 0, -1], up: FRONT },
];

/** Which way is right and up on the screen, and towards the viewer. */
export interface ViewAxes {
  right: Vec3;
  up: Vec3;
  back: Vec3;
}

const matrix = (x: Vec3, y: Vec3, z: Vec3): string => `matrix3d(${[...x, 0, ...y, 0, ...z, 0, 0, 0, 0, 1].map((value) => value.toFixed(5)).join()})`;

/** The stylesheet's y goes down, and its z towards the viewer. */
export function cubeMatrix({ right, up, back }: ViewAxes): string {
  const seen = ([0, 1, 2] as const).map((i): Vec3 => [right[i], -up[i], back[i]]);
  return matrix(seen[0]!, seen[1]!, seen[2]!);
}

/** Of a side whose own x goes right and y down, as one sees who stands there. */
export function sideMatrix({ from, up }: Side): string {
  return matrix(cross(up, from), [-up[0], -up[1], -up[2]], from);
}

/** The sides that are turned to the viewer. */
export const sidesInSight = ({ back }: ViewAxes): Side[] => SIDES.filter(({ from }) => dot(from, back) > 0.05);

/** A small cube that lies as the patient does; a click on a side looks from there. For the pointer: the pane's letters do the same. */
export class OrientationCube {
  private readonly solid = el("div", { class: "cube" });
  readonly element = el("div", { class: "cube-place", "aria-hidden": "true" }, this.solid);

  constructor(look: (side: Side) => void) {
    for (const side of SIDES) {
      const face = el("span", { class: "cube-side", title: side.title, "data-side": side.letter, on: { click: () => look(side) } }, side.letter);
      face.style.transform = `${sideMatrix(side)} translateZ(var(--half))`;
      this.solid.append(face);
    }
  }

  turn(axes: ViewAxes): void {
    this.solid.style.transform = cubeMatrix(axes);
  }
}
