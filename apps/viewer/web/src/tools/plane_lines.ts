// SPDX-License-Identifier: Apache-2.0
import { gap, toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import { add, dot, scale, sub } from "../geometry/vec";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import { VIEW_NAMES, type ViewName } from "../net/protocol";
import { DRAG_PIXELS, type Gesture } from "./gesture";
import { hitPlaneLines, planeLine, type LineHit, type PlaneLine } from "./hit";

/** The other views' planes as lines on a view, and the crosshair: the pointer moves and turns them. */
export class PlaneLines {
  areShown = true;

  constructor(
    private readonly navigation: Navigation,
    private readonly project: Project,
    private readonly screenOf: (view: ViewName) => Screen | null,
  ) {}

  seenIn(view: ViewName, screen: Screen): PlaneLine[] {
    if (!this.areShown) return [];
    return VIEW_NAMES.filter((other) => other !== view)
      .map((other) => planeLine(screen, this.navigation.crosshair, other, this.navigation.cameras[other].axes))
      .filter((line): line is PlaneLine => line !== null);
  }

  at(view: ViewName, screen: Screen, pointer: Point2): LineHit | null {
    return hitPlaneLines(this.seenIn(view, screen), toScreen(screen, this.navigation.crosshair), pointer, screen.reach);
  }

  press(view: ViewName, screen: Screen, pointer: Point2): Gesture {
    const hit = this.at(view, screen, pointer);
    if (hit?.on === "turn") return this.turn(view, hit.view, pointer);
    if (hit?.on === "move") return this.slide(screen, hit.view, pointer);
    const go = (at: Point2) => this.navigation.setCrosshair(toWorld(screen, at));
    if (hit?.on !== "crosshair") this.project.select(null);
    const before = this.navigation.crosshair;
    go(pointer);
    return { move: go, end: () => undefined, cancel: () => this.navigation.setCrosshair(before) };
  }

  private turn(view: ViewName, turned: ViewName, pointer: Point2): Gesture {
    const angleAt = (at: Point2): number => {
      const [x, y] = toScreen(this.screenOf(view)!, this.navigation.crosshair);
      return Math.atan2(at[1] - y, at[0] - x);
    };
    const before = this.navigation.cameras[turned].axes;
    let last = angleAt(pointer);
    return {
      move: (at) => {
        const angle = angleAt(at);
        this.navigation.rotate(turned, view, angle - last);
        last = angle;
      },
      end: () => undefined,
      cancel: () => this.navigation.turnTo(turned, before),
    };
  }

  /** Moves the crosshair across the other plane's line, and not off the slice that is seen. */
  private slide(screen: Screen, slid: ViewName, pointer: Point2): Gesture {
    const { normal } = this.navigation.cameras[slid].axes;
    const { u, v } = screen.axes;
    const across = add(scale(u, dot(normal, u)), scale(v, dot(normal, v)));
    const before = this.navigation.crosshair;
    let last = pointer;
    return {
      move: (at) => {
        const by = sub(toWorld(screen, at), toWorld(screen, last));
        last = at;
        this.navigation.setCrosshair(add(this.navigation.crosshair, scale(across, dot(by, normal) / dot(across, across))));
      },
      end: (at) => {
        if (gap(at, pointer) <= DRAG_PIXELS) this.navigation.setCrosshair(toWorld(screen, at)); // a click, not a drag
      },
      cancel: () => this.navigation.setCrosshair(before),
    };
  }
}
