// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../geometry/vec";
import type { Surface } from "../net/protocol";

/** Places that a person should look at: where contours contradict each other, and where a surface is not as it was drawn. */
export function markedPlaces(surfaces: Iterable<Surface>): Vec3[] {
  return [...surfaces].flatMap(({ conflicts = [], faults = [] }) => [...conflicts, ...faults].map(({ at }) => at));
}
