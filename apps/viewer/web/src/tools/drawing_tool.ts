// SPDX-License-Identifier: Apache-2.0
import type { StretchKind } from "../net/protocol";
import type { ContourHit } from "./hit";
import type { Place } from "./place";
import { usualCursor, type Tool, type ToolContext } from "./tool";

type Parts<Id extends string> = Pick<Tool<Id>, "id" | "key" | "label" | "title" | "icon" | "help"> & {
  stretch: StretchKind;
  hint: string;
  openHint: string;
  maskHint?: string;
};

/** A tool that draws new contours by clicks and by hand. */
export function drawingTool<Id extends string>({ hint, openHint, maskHint, stretch, ...parts }: Parts<Id>): Tool<Id> {
  return {
    ...parts,
    stretch,
    resumes: ({ kind, redraws }) => redraws === undefined && (kind === "free" ? "line" : kind) === stretch,
    hint: ({ drawing, project }) => (project.activeStructure?.mask && maskHint) || (drawing.endsOpen ? openHint : hint),
    press: (context, place, modifiers) => {
      const hit = mendable(context, place);
      if (hit) return context.edits.press(place.screen, place.pointer, hit, modifiers);
      return context.drawing.press(place.screen, place.step_mm, place.pointer, stretch);
    },
    hover: (context, place) => {
      context.drawing.stretchRubber(place.screen, place.step_mm, place.pointer);
      const contour = mendable(context, place);
      return contour && { contour, view: place.view };
    },
    cursor: usualCursor,
  };
}

/** The contour that was drawn last can be mended at once, others are out of the way. */
function mendable({ drawing, project }: ToolContext, { hit }: Place): ContourHit | null {
  return hit && !drawing.sketch && hit.contour === project.selection?.contour ? hit : null;
}
