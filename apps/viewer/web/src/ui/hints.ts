// SPDX-License-Identifier: Apache-2.0
import type { Editor } from "../tools/editor";

const CLOSE = "Click the first point, double click or press Enter to close · U ends it open · Backspace removes a point";
const END = "Double click or press Enter to end the open line · the first point closes it · Backspace removes a point";
const GO_ON = "Click on, or drag to draw by hand · Ctrl + Z takes a point back · Esc leaves";

const PROPOSED = "A proposal: Enter makes it a contour · E: nothing is here · Esc drops it · C goes on to the next slice, Shift + C back";
const PROPOSED_TWO = "A proposal: Enter makes it a contour · W: the neighbour's contour instead · E: nothing is here · Esc drops it · C: next slice";

/** What can be done next, for the status line. */
export function hintFor(editor: Editor): string {
  const { sketch } = editor.drawing;
  if (sketch?.isUnsaved || sketch?.redraws !== undefined) return `${sketch.title} is not saved · Enter tries again · Esc gives it up`;
  if (sketch && editor.drawing.endsOpen && sketch.canEnd) return END;
  if (sketch) return sketch.canClose ? CLOSE : GO_ON;
  if (editor.proposals.shown) return editor.proposals.shown.others?.length ? PROPOSED_TWO : PROPOSED;
  return editor.tool.hint(editor, editor.hover);
}
