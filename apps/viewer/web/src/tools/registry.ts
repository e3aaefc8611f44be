// SPDX-License-Identifier: Apache-2.0
import { editTool } from "./edit_tool";
import { freehandTool } from "./freehand_tool";
import { measureTool } from "./measure_tool";
import { moveTool } from "./move_tool";
import { pointTool } from "./point_tool";
import { pushTool } from "./push_tool";
import { redrawTool } from "./redraw_tool";
import { splineTool } from "./spline_tool";
import type { Tool } from "./tool";
import { wireTool } from "./wire_tool";

const ALL = [editTool, wireTool, freehandTool, splineTool, redrawTool, moveTool, pushTool, pointTool, measureTool] as const;

export type ToolName = (typeof ALL)[number]["id"];

/** All tools, as the toolbar shows them. Toolbar, keys, hints and the `?` sheet know no others. */
export const TOOLS: readonly Tool<ToolName>[] = ALL;

export const toolNamed = (id: ToolName): Tool<ToolName> => TOOLS.find((tool) => tool.id === id)!;
