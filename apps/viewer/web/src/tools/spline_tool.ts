// SPDX-License-Identifier: Apache-2.0
import { drawingTool } from "./drawing_tool";

export const splineTool = drawingTool({
  id: "spline",
  key: "s",
  label: "Spline",
  title: "Click points: a smooth curve goes through them. Drag to draw by hand, in between or all around",
  icon: "M3 15C5 5 10 5 10 10s5 5 7-4M3 15h.01M10 10h.01M17 6h.01",
  help: { Draw: [["S", "spline: a smooth curve through points"]] },
  stretch: "spline",
  hint: "Click points; a smooth curve goes through them",
  openHint: "Click points of a smooth curve; Enter or a double click ends the open line · Shift + U draws closed contours again",
});
