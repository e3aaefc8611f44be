// SPDX-License-Identifier: Apache-2.0
import { onSlice } from "./single_points";
import { usualCursor, type Tool } from "./tool";

const SELECTED = "Drag points or the line · Ctrl + click inserts · Del deletes · C proposes the next slice";
const OUTLINE = "Drag the outline where it is wrong, and it becomes a contour · A makes it one as it is";
const LOOKING = "Wheel scrolls · right drag windows · Shift + move jumps · ? shows all";

export const editTool: Tool<"edit"> = {
  id: "edit",
  key: "v",
  label: "Edit",
  title: "Move the crosshair and plane lines; drag points and lines of contours, and computed outlines",
  icon: "M4 3l5.500 13 2-5.500L17 8.500z",
  help: {
    "Look around": [
      ["Click, drag", "move the crosshair (Edit)"],
      ["Drag a plane line", "move that plane; drag its dot to turn it"],
    ],
    Edit: [
      ["V", "edit tool"],
      ["Drag a point or a line", "bend the contour"],
      ["Drag a computed outline", "make it a contour, bent by the drag"],
      ["Ctrl + click on a line", "insert a point"],
    ],
  },
  movesPlanes: true,
  grabsPoints: true,
  looksAround: true,
  hint: ({ project }, hover) => (hover && "outline" in hover ? OUTLINE : project.selection ? SELECTED : LOOKING),
  press: ({ edits, isOutOfTime, outlines, planeLines, points }, place, modifiers) => {
    const { view, screen, pointer, hit } = place;
    if (isOutOfTime) return planeLines.press(view, screen, pointer);
    const point = points.at(place);
    if (point) return points.grab(onSlice(screen), pointer, point);
    if (hit) return edits.press(screen, pointer, hit, modifiers);
    const isHandle = planeLines.at(view, screen, pointer)?.on === "turn";
    return (isHandle ? null : outlines.press(view, screen, pointer)) ?? planeLines.press(view, screen, pointer);
  },
  hover: ({ isOutOfTime, outlines, planeLines, points }, place) => {
    const { view, screen, pointer, hit } = place;
    const line = planeLines.at(view, screen, pointer);
    if (isOutOfTime) return line && { line, view };
    const point = points.at(place);
    if (point) return { point, view };
    if (hit) return { contour: hit, view };
    const outline = line?.on === "turn" ? null : outlines.at(view, screen, pointer);
    if (outline) return { outline, view };
    return line && { line, view };
  },
  remove: ({ isOutOfTime, points }) => !isOutOfTime && points.removeSelected(),
  leave: ({ points }) => points.deselect(),
  cursor: usualCursor,
  paint: (painter, { outlines, project }, view, hover) => {
    if (!hover || !("outline" in hover) || hover.view !== view) return;
    painter.outlineToTake(outlines.line(view, hover.outline), project.structures.get(hover.outline.structure)?.color ?? "#888888");
  },
};
