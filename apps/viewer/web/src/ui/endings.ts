// SPDX-License-Identifier: Apache-2.0
import type { ImportEndings } from "../net/protocol";

// What the server said can be imported, in words of the page.

/** What a file is imported as, by its name; null: not at all. */
export function importKind(name: string, { contours, masks }: ImportEndings): "contours" | "mask" | null {
  const isAnyOf = (endings: string[]): boolean => endings.some((ending) => name.toLowerCase().endsWith(ending));
  if (isAnyOf(contours)) return "contours";
  return isAnyOf(masks) ? "mask" : null;
}

/** For a file chooser. Of an ending with two dots some systems match nothing, so that it is given by its last part. */
export function accepted({ contours, masks }: ImportEndings): string {
  return [...new Set([...contours, ...masks].map((ending) => ending.slice(ending.lastIndexOf("."))))].join(",");
}

export function sentence({ contours, masks }: ImportEndings): string {
  if (contours.length === 0 || masks.length === 0) return "kontur has not said yet what it imports.";
  const listed = (endings: string[]): string => `${endings.slice(0, -1).join(", ")} and ${endings.at(-1)}`;
  return `contours are imported from ${listed(contours)}, masks from ${listed(masks)}.`;
}
