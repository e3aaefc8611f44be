// SPDX-License-Identifier: Apache-2.0
import { usualCursor, type Tool } from "./tool";

export const pointTool: Tool<"point"> = {
  id: "point",
  key: "q",
  label: "Point",
  title: "Click where the surface has to pass, on a slice or on the surface in 3D; points can be dragged, Del removes",
  icon: "M10 10.500v.01M3 15c2-7 4-9 7-4.500S15 8 17 4M7 10.500a3 3 0 1 0 6 0 3 3 0 1 0-6 0",
  isMinor: true,
  grabsPoints: true,
  help: {
    Edit: [["Q, click", "set a point that the surface passes; drag it, Del removes it; in the list: whether it lies inside or outside instead"]],
    "3D": [
      ["Q, click on the surface", "keep the surface here: set a point that it passes"],
      ["Drag a point", "move it along the surface"],
    ],
  },
  hint: ({ points, project }, hover) => {
    if (hover && "point" in hover) return "Drag the point to where the surface belongs, on this slice";
    const name = project.activeStructure?.name ?? "the structure";
    if (project.activeStructure?.mask) return `Click where ${name} is wrong: inside of it, what does not belong, outside, what is missing`;
    return `Click where the surface of ${name} has to pass, here or on a surface in 3D` + (points.selected ? " · Del removes the selected point" : "");
  },
  press: ({ points }, place) => points.press(place),
  hover: ({ points }, place) => {
    const point = points.at(place);
    return point && { point, view: place.view };
  },
  clickSurface: ({ points }, place) => points.clickSurface(place),
  remove: ({ points }) => points.removeSelected(),
  leave: ({ points }) => points.deselect(),
  cursor: (hover) => (hover ? usualCursor(hover) : "crosshair"),
};
