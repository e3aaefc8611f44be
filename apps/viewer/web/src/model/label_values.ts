// SPDX-License-Identifier: Apache-2.0
import type { Structure } from "../net/protocol";

/** The values of structures in a label map, as the server gives them: their own, and for the others the smallest ones, from 1 on, that none has. */
export function labelValues(structures: readonly Structure[]): number[] {
  const taken = new Set<number>();
  const own = structures.map(({ label_value: value }) => (value === undefined || taken.has(value) ? undefined : (taken.add(value), value)));
  let next = 0;
  const free = () => {
    do ++next;
    while (taken.has(next));
    return next;
  };
  return own.map((value) => value ?? free());
}
