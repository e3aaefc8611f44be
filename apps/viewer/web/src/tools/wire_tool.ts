// SPDX-License-Identifier: Apache-2.0
import { drawingTool } from "./drawing_tool";

export const wireTool = drawingTool({
  id: "wire",
  key: "l",
  label: "Live-wire",
  title: "Click points: the line between them follows the edge in the image. Drag to draw by hand, in between or all around",
  icon: "M4 16l2-5 4-1 2-4 4-2M3 17.500a1.500 1.500 0 1 0 2-2 1.500 1.500 0 0 0-2 2zM15 5a1.500 1.500 0 1 0 2-2 1.500 1.500 0 0 0-2 2z",
  help: { Draw: [["L", "live-wire: lines follow the edge in the image"]] },
  stretch: "wire",
  hint: "Click along the edge; the line snaps to it · or drag all around it by hand",
  openHint: "Click along the edge; Enter or a double click ends the open line · Shift + U draws closed contours again",
});
