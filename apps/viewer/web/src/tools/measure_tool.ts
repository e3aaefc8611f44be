// SPDX-License-Identifier: Apache-2.0
import type { Tool } from "./tool";

export const measureTool: Tool<"measure"> = {
  id: "measure",
  key: "d",
  label: "Measure",
  title: "Drag: a distance. Click three points: the angle at the second. Ends can be dragged; Del removes",
  icon: "M3 14L14 3l3 3L6 17zM6 11l1.500 1.500M8.500 8.500L11 11M11.500 6L13 7.500",
  isMinor: true,
  looksAround: true,
  help: { "Look around": [["D", "measure: drag a distance, click the three points of an angle; Del removes"]] },
  hint: ({ measuring }) =>
    measuring.begun
      ? "Click the angle's vertex, then its other leg · Esc leaves"
      : "Drag: a distance · click three points: an angle · drag an end · Del removes the last",
  press: ({ measuring }, place) => measuring.press(place),
  hover: ({ measuring }, { view, screen, step_mm, pointer }) => {
    measuring.follow(screen, pointer);
    return { measure: measuring.pointAt(screen, step_mm, pointer) !== null && !measuring.begun, at: pointer, view };
  },
  remove: ({ measuring }) => measuring.leave() || measuring.measurements.remove(),
  leave: ({ measuring }) => measuring.leave(),
  cursor: (hover) => (hover && "measure" in hover && hover.measure ? "grab" : "crosshair"),
};
