// SPDX-License-Identifier: Apache-2.0
import { TOOLS } from "../tools/registry";
import { HELP_SECTIONS, type Help, type HelpRow, type HelpSection } from "../tools/tool";
import { COMMANDS, HELD_KEYS } from "./commands";
import { openDialog } from "./dialogs";
import { el } from "../dom/dom";

/** What the mouse does with every tool. */
const GESTURES: Help = {
  "Look around": [
    ["Wheel, ↑ ↓", "scroll through slices (Page keys: ten at a time)"],
    ["Ctrl + wheel, + −", "zoom"],
    ["Right drag", "window: width to the right, centre up and down; with Shift of the second image"],
    ["Shift + move", "all views jump to the point under the pointer"],
  ],
  Draw: [["Left clicks, left drag", "place points, draw by hand; change the tool in mid-contour"]],
  "3D": [
    ["Left, middle, right drag", "turn, zoom, shift"],
    ["Double click on the surface", "show that place in the slices"],
  ],
  Touch: [
    ["One finger", "what the mouse does with the tool; a tap is a click"],
    ["Two fingers up, down", "scroll through slices"],
    ["Two fingers apart, together, sideways", "zoom, shift; a line that one of them has just begun is dropped"],
    ["One finger rests, then drags", "window: width to the right, centre up and down"],
  ],
};

/** The rows of a section of the sheet: of the mouse, of tools, of keys. */
export function helpRows(section: HelpSection): HelpRow[] {
  const keys = [...HELD_KEYS, ...COMMANDS].flatMap(({ help }): HelpRow[] => (help?.[0] === section ? [[help[1], help[2]]] : []));
  return [...[GESTURES, ...TOOLS.map((tool) => tool.help)].flatMap((help) => help[section] ?? []), ...keys];
}

export function openHelp(version: string): void {
  const columns = HELP_SECTIONS.map((section) =>
    el("section", {}, el("h3", {}, section), el("dl", {}, ...helpRows(section).flatMap(([keys, what]) => [el("dt", {}, keys), el("dd", {}, what)]))),
  );
  openDialog(
    "Mouse and keyboard",
    "help-dialog",
    el("div", { class: "help-columns" }, ...columns),
    el("p", { class: "fine" }, `kontur ${version}. Research software, not a medical device.`),
  );
}
