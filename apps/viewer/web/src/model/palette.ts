// SPDX-License-Identifier: Apache-2.0
import type { ViewName } from "../net/protocol";

/** Told apart by people of any colour vision; a test simulates it. */
export const PLANE_COLORS: Record<ViewName, string> = {
  axial: "#ff6a3d",
  sagittal: "#57dfc0",
  coronal: "#3f8cff",
  oblique: "#e3a6f0",
};

/** `#rrggbb` towards white (t > 0) or black (t < 0). */
export function tinted(color: string, t: number): string {
  const towards = t > 0 ? 255 : 0;
  const mixed = [1, 3, 5].map((at) => {
    const value = parseInt(color.slice(at, at + 2), 16);
    return Math.round(value + (towards - value) * Math.abs(t));
  });
  return `#${mixed.map((value) => value.toString(16).padStart(2, "0")).join("")}`;
}

export function withAlpha(color: string, alpha: number): string {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
  return `rgba(${r}, ${g}, ${b}, ${alpha})`;
}
