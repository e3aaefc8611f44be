// SPDX-License-Identifier: Apache-2.0
import type { Tool } from "./tool";

export const moveTool: Tool<"move"> = {
  id: "move",
  key: "m",
  label: "Move",
  title: "Drag a contour as a whole within its plane",
  icon: "M10 3v14M3 10h14M10 3l-2 2M10 3l2 2M10 17l-2-2M10 17l2-2M3 10l2-2M3 10l2 2M17 10l-2-2M17 10l-2 2",
  isMinor: true,
  help: { Edit: [["M, Shift + drag", "move a contour"]] },
  hint: () => "Drag a contour",
  press: ({ edits }, { screen, pointer, hit }) => hit && edits.move(screen, pointer, hit.contour),
  hover: (_, { hit, view }) => hit && { contour: hit, view },
  cursor: (hover) => (hover ? "move" : "default"),
};
