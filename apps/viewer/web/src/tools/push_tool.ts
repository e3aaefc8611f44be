// SPDX-License-Identifier: Apache-2.0
import type { Tool } from "./tool";

export const pushTool: Tool<"push"> = {
  id: "push",
  key: "p",
  label: "Push",
  title: "Push the nearest line of the active structure by a round brush, from inside or outside; Ctrl + wheel: its size",
  icon: "M7 2c0 3-3 4-3 8s3 5 3 8M16.500 10a4.500 4.500 0 1 1-9 0 4.500 4.500 0 0 1 9 0z",
  isMinor: true,
  help: { Edit: [["P, Ctrl + wheel", "push lines by a round brush; its size"]] },
  hint: () => "Push the line from inside or from outside · Ctrl + wheel: size of the brush",
  press: ({ pushing }, place) => pushing.press(place),
  hover: ({ pushing }, { view, pointer }) => {
    pushing.place = { view, at: pointer };
    return { brush: pointer, view };
  },
  wheel: ({ pushing }, factor) => pushing.resize(factor),
  cursor: () => "none",
  paint: (painter, { pushing }, view) => {
    if (pushing.place?.view === view) painter.brush(pushing.place.at, pushing.radius);
  },
  left: ({ pushing }) => {
    pushing.place = null;
  },
};
