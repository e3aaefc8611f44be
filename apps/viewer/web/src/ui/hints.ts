// SPDX-License-Identifier: Apache-2.0
import type { Project } from "../model/project";
import type { Editor } from "../tools/editor";

/** What can be done next, for the status line. */
export function hintFor(editor: Editor, project: Project): string {
  const { sketch } = editor.drawing;
  if (sketch?.isUnsaved || sketch?.redraws !== undefined) return `${sketch.title} is not saved · Enter tries again · Esc gives it up`;
  if (sketch) return sketch.canClose ? "Click the first point, double click or press Enter to close · Backspace removes a point" : "Click on, or drag to draw by hand · Ctrl + Z takes a point back · Esc leaves";
  switch (editor.tool) {
    case "wire":
      return "Click along the edge; the line snaps to it · drag to draw by hand";
    case "freehand":
      return "Drag around the structure; releasing closes the contour";
    case "spline":
      return "Click points; a smooth curve goes through them";
    case "redraw":
      return "Draw the new piece from the contour's line back to it";
    case "move":
      return "Drag a contour";
    case "edit":
      return project.selection ? "Drag points or the line · Ctrl + click inserts · Del deletes · C copies to the next slice" : "Wheel scrolls · right drag windows · Shift + move jumps · ? shows all";
  }
}
