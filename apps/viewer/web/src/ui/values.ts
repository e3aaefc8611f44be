// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../geometry/vec";
import { coordinateText } from "../model/lengths";
import type { FurtherImage, Session } from "../net/protocol";
import { shortName } from "./second_image_card";

function valueText(value: number | null, unit: string): string {
  if (value === null) return "outside";
  return `${unit === "HU" ? Math.round(value) : Number(value.toPrecision(4))} ${unit}`.trim();
}

/** What the images have at a place; with two of them each is named. */
export function valuesText(
  values: readonly (number | null)[],
  { image, identity }: Pick<Session, "image" | "identity">,
  second: Pick<FurtherImage, "unit" | "identity"> | null,
): string {
  const [first = null, other = null] = values;
  const own = valueText(first, image.unit);
  if (!second) return own;
  return `${shortName(identity, "first")} ${own}  ·  ${shortName(second.identity, "second")} ${valueText(other, second.unit)}`;
}

/** "R 12.0  P 3.4  S 20.1 mm": which way from the frame's origin, and how far, as finely as voxels of `step_mm` ask for. */
export function placeText(p: Vec3, step_mm = 1): string {
  const letters = [
    ["R", "L"],
    ["A", "P"],
    ["I", "S"],
  ] as const;
  return p.map((value, i) => `${letters[i]![value >= 0 ? 1 : 0]} ${coordinateText(Math.abs(value), step_mm)}`).join("  ") + " mm";
}
