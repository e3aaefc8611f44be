// SPDX-License-Identifier: Apache-2.0
import type { Tool } from "./tool";

export const redrawTool: Tool<"redraw"> = {
  id: "redraw",
  key: "r",
  label: "Redraw",
  title: "Draw a new piece over a contour, beginning and ending on its line",
  icon: "M4 10a6 6 0 0 1 10.500-4M14.500 2.500V6H11M16 10a6 6 0 0 1-10.500 4M5.500 17.500V14H9",
  isMinor: true,
  help: { Edit: [["R", "redraw a piece: draw from the line back to the line; from an open line's end it leads on"]] },
  resumes: ({ redraws }) => redraws !== undefined,
  hint: ({ project }) =>
    project.selectedContour?.closed === false
      ? "Draw the new piece from the line back to it · from an end of it on, to lead it on · from end to end, to close it"
      : "Draw the new piece from the contour's line back to it",
  press: ({ edits }, { screen, step_mm, pointer, hit }) => edits.redraw(screen, step_mm, pointer, hit),
  hover: (_, { hit, view }) => hit && { contour: hit, view },
  cursor: () => "crosshair",
};
