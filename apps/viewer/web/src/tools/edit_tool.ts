// SPDX-License-Identifier: Apache-2.0
import { usualCursor, type Tool } from "./tool";

const SELECTED = "Drag points or the line · Ctrl + click inserts · Del deletes · C copies to the next slice";
const LOOKING = "Wheel scrolls · right drag windows · Shift + move jumps · ? shows all";

export const editTool: Tool<"edit"> = {
  id: "edit",
  key: "v",
  label: "Edit",
  title: "Move the crosshair and plane lines; drag points and lines of contours",
  icon: "M4 3l5.500 13 2-5.500L17 8.500z",
  help: {
    "Look around": [
      ["Click, drag", "move the crosshair (Edit)"],
      ["Drag a plane line", "move that plane; drag its dot to turn it"],
    ],
    Edit: [
      ["V", "edit tool"],
      ["Drag a point or a line", "bend the contour"],
      ["Ctrl + click on a line", "insert a point"],
    ],
  },
  movesPlanes: true,
  hint: ({ project }) => (project.selection ? SELECTED : LOOKING),
  press: ({ edits, planeLines }, { view, screen, pointer, hit }, modifiers) =>
    hit ? edits.press(screen, pointer, hit, modifiers) : planeLines.press(view, screen, pointer),
  hover: ({ planeLines }, { view, screen, pointer, hit }) => {
    if (hit) return { contour: hit, view };
    const line = planeLines.at(view, screen, pointer);
    return line && { line, view };
  },
  cursor: usualCursor,
};
