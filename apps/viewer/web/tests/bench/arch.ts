// SPDX-License-Identifier: Apache-2.0
// A made aortic arch: a bent tube in a CT's values, in a plane from the right front to the left back as in patients.
import { writeFileSync } from "node:fs";
import type { Vec3 } from "./truth";

const SIZE: Vec3 = [110, 110, 60];
const SPACING: Vec3 = [1.5, 1.5, 2.5];
const TURN = (48 * Math.PI) / 180; // of its plane about the body's axis, from the left-right axis
const BEND_MM = 33; // radius of the middle line
const ASCENDING_MM = 45;
const DESCENDING_MM = 75; // the legs
const WIDE_MM = 15;
const NARROW_MM = 11; // radius of the tube at its beginning and end

/** How deep a place lies in the tube, in mm; negative: how far outside. */
function depth([x, y, z]: Vec3): number {
  const across = x * Math.cos(TURN) + y * Math.sin(TURN);
  const off = -x * Math.sin(TURN) + y * Math.cos(TURN);
  const up = z - 15;
  const isBend = up > 0;
  const toLine = isBend ? Math.hypot(across, up) - BEND_MM : Math.abs(across) - BEND_MM;
  const whole = ASCENDING_MM + Math.PI * BEND_MM + DESCENDING_MM;
  const way = isBend ? ASCENDING_MM + BEND_MM * (Math.PI - Math.atan2(up, across)) : across < 0 ? ASCENDING_MM + up : ASCENDING_MM + Math.PI * BEND_MM - up;
  const t = way / whole;
  const beyond = Math.max(0, -way, way - whole);
  return WIDE_MM + (NARROW_MM - WIDE_MM) * Math.min(Math.max(t, 0), 1) - Math.hypot(toLine, off, 4 * beyond);
}

/** Writes the image and its true mask, as NIfTI. */
export function writeArch(image: string, mask: string): void {
  const count = SIZE[0] * SIZE[1] * SIZE[2];
  const header = (bits: 8 | 16) => {
    const file = Buffer.alloc(352 + (count * bits) / 8);
    file.writeInt32LE(348, 0);
    [3, ...SIZE, 1, 1, 1, 1].forEach((value, i) => file.writeInt16LE(value, 40 + 2 * i));
    file.writeInt16LE(bits === 8 ? 2 : 4, 70);
    file.writeInt16LE(bits, 72);
    [1, ...SPACING].forEach((value, i) => file.writeFloatLE(value, 76 + 4 * i));
    file.writeFloatLE(352, 108);
    file.writeUInt8(2, 123); // mm
    file.writeInt16LE(1, 254); // the sform counts
    SPACING.forEach((spacing, axis) => {
      file.writeFloatLE(spacing, 280 + 16 * axis + 4 * axis);
      file.writeFloatLE((-(SIZE[axis]! - 1) / 2) * spacing, 280 + 16 * axis + 12);
    });
    file.write("n+1\0", 344);
    return file;
  };
  const values = header(16);
  const truth = header(8);
  let seed = 5;
  const chance = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (let k = 0, at = 0; k < SIZE[2]; ++k)
    for (let j = 0; j < SIZE[1]; ++j)
      for (let i = 0; i < SIZE[0]; ++i, ++at) {
        const ras = [i, j, k].map((index, axis) => (index - (SIZE[axis]! - 1) / 2) * SPACING[axis]!);
        const inside = depth([-ras[0]!, -ras[1]!, ras[2]!]);
        const noise = 22 * (chance() + chance() + chance() + chance() - 2) * Math.sqrt(3);
        const edge = Math.min(Math.max(inside / 1.5 + 0.5, 0), 1); // partial volume
        values.writeInt16LE(Math.round(40 + 260 * edge + noise), 352 + 2 * at);
        truth[352 + at] = inside > 0 ? 1 : 0;
      }
  writeFileSync(image, values);
  writeFileSync(mask, truth);
}
