// SPDX-License-Identifier: Apache-2.0
import { drawingTool } from "./drawing_tool";

export const freehandTool = drawingTool({
  id: "freehand",
  key: "f",
  label: "Freehand",
  title: "Drag around the structure; releasing closes the contour",
  icon: "M3 14c2-6 4-9 6-9s0 5 1.500 6.500S15 8 17 6",
  help: { Draw: [["F", "freehand: drag around the structure"]] },
  stretch: "line",
  hint: "Drag around the structure; releasing closes the contour",
  maskHint: "Drag across the mask's outline: the line replaces the shorter piece between its ends · back to where it began: the whole outline",
  openHint: "Drag along the border; releasing ends the open line · Shift + U draws closed contours again",
});
