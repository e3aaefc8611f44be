// SPDX-License-Identifier: Apache-2.0
import type { Point2 } from "../geometry/screen";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { StretchKind, ViewName } from "../net/protocol";
import type { ContourEdits } from "./contour_edits";
import type { Drawing } from "./drawing";
import type { Gesture, Modifiers } from "./gesture";
import type { ContourHit, LineHit } from "./hit";
import type { Measuring } from "./measuring";
import type { OutlineEdits, OutlineHit } from "./outline_edits";
import type { ToolPainter } from "./painter";
import type { Place } from "./place";
import type { PlaneLines } from "./plane_lines";
import type { Pushing } from "./pushing";
import type { Sketch } from "./sketch";
import type { SinglePoint, SurfacePlace, SinglePoints } from "./single_points";

/** What a tool works with. */
export interface ToolContext {
  navigation: Navigation;
  project: Project;
  drawing: Drawing;
  edits: ContourEdits;
  outlines: OutlineEdits;
  planeLines: PlaneLines;
  pushing: Pushing;
  points: SinglePoints;
  measuring: Measuring;
  /** What is worked on belongs to another time than the one that is seen. */
  isOutOfTime: boolean;
}

/** What the pointer would take. */
export type Hover =
  | { contour: ContourHit; view: ViewName }
  | { line: LineHit; view: ViewName }
  | { outline: OutlineHit; view: ViewName }
  | { point: SinglePoint; view: ViewName }
  | { brush: Point2; view: ViewName }
  | { measure: boolean; at: Point2; view: ViewName }
  | null;

export const HELP_SECTIONS = ["Look around", "Draw", "Edit", "3D", "Touch"] as const;
export type HelpSection = (typeof HELP_SECTIONS)[number];
export type HelpRow = readonly [keys: string, what: string];
export type Help = Partial<Record<HelpSection, readonly HelpRow[]>>;

/** What the left button does on a slice. Each tool is one file, and a line in `registry.ts`. */
export interface Tool<Id extends string = string> {
  readonly id: Id;
  /** A small letter. */
  readonly key: string;
  readonly label: string;
  /** What its button says when the pointer rests on it. */
  readonly title: string;
  /** Lines on 20 x 20. */
  readonly icon: string;
  /** Shown without its label where the page is narrow. */
  readonly isMinor?: boolean;
  /** Its rows of the `?` sheet. */
  readonly help: Help;
  /** Of the line from a point that is clicked, where it draws new contours: then a sketch goes on when the tool is taken. */
  readonly stretch?: StretchKind;
  /** It takes the lines of other planes: they are bright, and have handles. */
  readonly movesPlanes?: boolean;
  /** It takes single points by the hand, on slices and in 3D. */
  readonly grabsPoints?: boolean;
  /** It may be used where another time is seen than the one that what is worked on belongs to. */
  readonly looksAround?: boolean;
  /** Whether it is the tool to go on with this sketch. */
  resumes?(sketch: Sketch): boolean;
  /** What can be done next, for the status line. */
  hint(context: ToolContext, hover: Hover): string;
  press(context: ToolContext, place: Place, modifiers: Modifiers): Gesture | null;
  /** The pointer is here, and no button is held. */
  hover(context: ToolContext, place: Place): Hover;
  /** A click on a surface in the 3D view. */
  clickSurface?(context: ToolContext, place: SurfacePlace): void;
  /** The wheel with Ctrl, where it does not zoom; above 1: larger. */
  wheel?(context: ToolContext, factor: number): void;
  /** Del and Backspace, where they mean something to the tool; false where they do not. */
  remove?(context: ToolContext): boolean;
  /** Esc, and another tool: gives up what was begun; false where nothing was. */
  leave?(context: ToolContext): boolean;
  /** The pointer is gone from the view. */
  left?(context: ToolContext): void;
  cursor(hover: Hover): string;
  /** What it shows on a view beside contours and sketch. */
  paint?(painter: ToolPainter, context: ToolContext, view: ViewName, hover: Hover): void;
}

export function usualCursor(hover: Hover): string {
  if (!hover || "brush" in hover || "measure" in hover) return "crosshair";
  if ("outline" in hover || "point" in hover) return "grab";
  if ("contour" in hover) return hover.contour.on === "point" ? "grab" : "pointer";
  return hover.line.on === "turn" ? "alias" : "move";
}
