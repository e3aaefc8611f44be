// SPDX-License-Identifier: Apache-2.0
import { depthBelow, gap, leftOnScreen, sliceOnScreen, toScreen, type Point2, type Screen } from "../geometry/screen";
import { scaleBar } from "../geometry/scale_bar";
import { alongLine } from "../geometry/loop";
import type { PixelPlane } from "../geometry/plane";
import type { Vec3 } from "../geometry/vec";
import type { SavedAppearance } from "../model/appearance";
import type { Contour, Hand, LineRun, PointKind, SliceHeader } from "../net/protocol";
import { hasHandles, type PlaneLine } from "../tools/hit";
import type { Outline } from "../tools/free_outlines";
import type { SinglePoint } from "../tools/single_points";
import type { ToolPainter } from "../tools/painter";
import { PLANE_COLORS, tinted, withAlpha } from "../model/palette";

const SHADE = "rgba(8, 10, 13, 0.8)";
const INK = "#e8edf2";
const MEASURED = "#f0e442";

const USUAL_FONT_PIXELS = 13;

const ZONE_ALPHA = 0.16;
const TICK_PIXELS = 7;
const TICK_STEP_PIXELS = 18;

/** How a drawn contour is seen. */
export interface ContourState {
  selected: boolean;
  hovered: boolean;
  point: number | null;
  hoveredPoint: number | null;
}

/** A quarter of a plus, which is turned for the others. */
const QUARTER: readonly Point2[] = [
  [0.5, 0.5],
  [0.5, 1.6],
  [-0.5, 1.6],
];
const turned = ([x, y]: Point2, quarters: number): Point2 => (quarters === 0 ? [x, y] : turned([-y, x], quarters - 1));
const POINT_SHAPES: Record<PointKind, readonly Point2[]> = {
  surface: [0, 1, 2, 3].map((quarters) => turned([1, 1], quarters)),
  interior: [0, 1, 2, 3].flatMap((quarters) => QUARTER.map((corner) => turned(corner, quarters))),
  exterior: [
    [-1.6, -0.5],
    [1.6, -0.5],
    [1.6, 0.5],
    [-1.6, 0.5],
  ],
};

/** Draws vectors over a slice, in CSS pixels of `screen`; lines and marks grow with the letters. */
export class OverlayPainter implements ToolPainter {
  private readonly scale: number;

  constructor(
    private readonly ctx: CanvasRenderingContext2D,
    private readonly screen: Screen,
    private readonly appearance: SavedAppearance,
    private readonly fontPixels = USUAL_FONT_PIXELS,
  ) {
    this.scale = fontPixels / USUAL_FONT_PIXELS;
  }

  /** Where the computed surfaces cut the plane: thin, filled. What contours alone would make of them: thinner, dotted, below. */
  outlines(outlines: Iterable<Outline>, slice: PixelPlane, colorOf: (structure: number) => string): void {
    for (const { structure, points, lines, without_image } of outlines) {
      const path = this.runs(points, lines, slice);
      const color = colorOf(structure);
      if (without_image) {
        const alone = this.runs(points, without_image, slice);
        this.stroke(alone, SHADE, 1.9 * this.appearance.width);
        this.ctx.setLineDash([3 * this.scale, 3 * this.scale]);
        this.stroke(alone, tinted(color, 0.45), 1.2 * this.appearance.width);
        this.ctx.setLineDash([]);
      }
      this.ctx.fillStyle = withAlpha(color, this.appearance.fill);
      this.ctx.fill(path, "evenodd");
      this.ctx.lineJoin = "round";
      this.stroke(path, withAlpha(color, 0.95), 1.4 * this.appearance.width);
    }
  }

  /** Contours of other planes, as the points where they cross this one. */
  crossings(header: SliceHeader, points: Float32Array, slice: PixelPlane, colorOf: (contour: number) => string | null): void {
    const { a, dx, dy } = sliceOnScreen(this.screen, slice);
    for (const { contour, first, count } of header.crossings) {
      const color = colorOf(contour);
      if (!color) continue;
      for (let i = first; i < first + count; ++i) this.diamond([a * points[2 * i]! + dx, a * points[2 * i + 1]! + dy], color);
    }
  }

  /** A drawn contour: light with a dark rim, unlike the computed outlines; holes dashed, open lines with ticks on the structure's side. */
  contour(contour: Contour, side: Hand | undefined, color: string, state: ContourState): void {
    const path = this.path(contour.points, contour.closed);
    if (!contour.closed && side) path.addPath(this.ticks(contour, side));
    const light = tinted(color, state.selected || state.hovered ? 0.82 : 0.55);
    this.ctx.lineJoin = "round";
    const width = (state.selected ? 2.4 : 1.9) * this.appearance.width;
    this.stroke(path, SHADE, width + 2);
    if (contour.hole) this.ctx.setLineDash([7, 4]);
    this.stroke(path, light, width);
    this.ctx.setLineDash([]);
    if (!hasHandles(contour) || !(state.selected || state.hovered)) return;
    contour.control.forEach(({ at }, i) => this.handle(toScreen(this.screen, at), i === state.point, i === state.hoveredPoint, color));
  }

  /** One of another time: it is not edited now. */
  faintContour({ points, closed }: Contour, color: string): void {
    this.ctx.globalAlpha = 0.4;
    this.ctx.setLineDash([2, 5]);
    this.stroke(this.path(points, closed), tinted(color, 0.55), 1.4 * this.appearance.width);
    this.ctx.setLineDash([]);
    this.ctx.globalAlpha = 1;
  }

  /** Short strokes off an open line, to where the structure lies. */
  private ticks({ points, plane }: Contour, side: Hand): Path2D {
    const path = new Path2D();
    const reach = TICK_PIXELS * this.scale;
    for (const { at, direction } of alongLine(
      points.map((p) => toScreen(this.screen, p)),
      TICK_STEP_PIXELS * this.scale,
    )) {
      const [x, y] = leftOnScreen(this.screen, plane, direction);
      const sign = side === "left" ? reach : -reach;
      path.moveTo(at[0], at[1]);
      path.lineTo(at[0] + sign * x, at[1] + sign * y);
    }
    return path;
  }

  /** A single point: a square where the surface passes it, unlike the points of lines; a plus inside, a minus outside. */
  singlePoint({ at, kind }: SinglePoint, color: string, state: { selected: boolean; hovered: boolean }): void {
    const [x, y] = toScreen(this.screen, at);
    const r = this.scale * (state.selected || state.hovered ? 5.2 : 4);
    const path = new Path2D();
    for (const [right, down] of POINT_SHAPES[kind]) path.lineTo(x + right * r, y + down * r);
    path.closePath();
    this.ctx.lineJoin = "miter";
    this.stroke(path, SHADE, 4.4);
    this.ctx.fillStyle = state.selected ? "#ffffff" : color;
    this.ctx.fill(path);
    this.stroke(path, state.selected ? color : "#ffffff", 1.6);
  }

  /** The contour that is being drawn. */
  sketch(placed: readonly Vec3[], rubber: readonly Vec3[], points: readonly Vec3[], color: string, closes: boolean): void {
    this.ctx.lineJoin = "round";
    this.line(placed, tinted(color, 0.75), 2.2);
    this.ctx.setLineDash([5, 4]);
    this.line(rubber, tinted(color, 0.75), 1.8);
    this.ctx.setLineDash([]);
    points.forEach((at, i) => {
      const p = toScreen(this.screen, at);
      this.handle(p, false, false, color);
      if (i === 0) this.ring(p, closes ? 9 : 7, closes ? "#ffffff" : withAlpha("#ffffff", 0.5), closes ? 2.2 : 1);
    });
  }

  /** A computed outline that the pointer would take. */
  outlineToTake(points: readonly Vec3[], color: string): void {
    this.ctx.lineJoin = "round";
    this.stroke(this.path(points, true), tinted(color, 0.5), 2.6 * this.appearance.width);
  }

  /** What Enter would make contours of, or an open line. */
  proposal(lines: readonly (readonly Vec3[])[], color: string, isOpen = false): void {
    const { ctx } = this;
    ctx.lineJoin = "round";
    for (const line of lines) {
      const path = this.path(line, !isOpen);
      this.stroke(path, SHADE, 2.4 * this.appearance.width + 2);
      ctx.setLineDash([8, 5]);
      this.stroke(path, tinted(color, 0.82), 2.4 * this.appearance.width);
      ctx.setLineDash([]);
    }
    const [x, y] = lines
      .flat()
      .map((p) => toScreen(this.screen, p))
      .reduce((top, p) => (p[1] < top[1] ? p : top));
    this.text("Enter accepts, Esc drops", [x, Math.max(y - 8, 52)], "center", "bottom", `${this.fontPixels}px system-ui, sans-serif`);
  }

  /** What a rule would make. */
  rule(lines: readonly (readonly Vec3[])[]): void {
    this.ctx.lineJoin = "round";
    for (const line of lines) {
      const path = this.path(line, true);
      this.stroke(path, SHADE, 1.6 * this.appearance.width + 2);
      this.ctx.setLineDash([3, 4]);
      this.stroke(path, INK, 1.6 * this.appearance.width);
      this.ctx.setLineDash([]);
    }
  }

  /** A distance, or the legs of an angle. */
  measurement(points: readonly Vec3[], text: string, selected: boolean): void {
    const seen = points.map((p) => toScreen(this.screen, p));
    this.ctx.lineJoin = "round";
    this.stroke(this.path(points, false), SHADE, 4);
    this.stroke(this.path(points, false), selected ? "#ffffff" : MEASURED, 1.6);
    for (const p of seen) this.ring(p, 3.5, selected ? "#ffffff" : MEASURED, 1.6);
    const [x, y] = seen[Math.min(1, seen.length - 1)]!;
    if (text) this.text(text, [x + 9, y - 9], "left", "bottom");
  }

  brush(at: Point2, radius: number): void {
    for (const [color, width] of [
      [SHADE, 3],
      [INK, 1.3],
    ] as const) {
      const path = new Path2D();
      path.arc(at[0], at[1], radius, 0, 2 * Math.PI);
      this.stroke(path, color, width);
    }
  }

  /** How far corrections at these points are carried on, where that meets the slice. */
  zone(points: readonly Vec3[], reach_mm: number, color: string): void {
    const path = new Path2D();
    for (const p of points) {
      const depth = depthBelow(this.screen, p);
      if (Math.abs(depth) >= reach_mm) continue;
      const [x, y] = toScreen(this.screen, p);
      const radius = Math.sqrt(reach_mm * reach_mm - depth * depth) / this.screen.mm_per_pixel;
      path.moveTo(x + radius, y);
      path.arc(x, y, radius, 0, 2 * Math.PI);
    }
    this.ctx.fillStyle = withAlpha(color, ZONE_ALPHA);
    this.ctx.fill(path, "nonzero");
  }

  /** Closed lines of a slice's outline, on the screen. */
  onScreen({ points, lines }: Outline, slice: PixelPlane): Point2[][] {
    const { a, dx, dy } = sliceOnScreen(this.screen, slice);
    return lines.map(({ first, count }) => Array.from({ length: count }, (_, n) => [a * points[2 * (first + n)]! + dx, a * points[2 * (first + n) + 1]! + dy]));
  }

  /** The piece of an outline that a stroke is about to replace: dotted, with a tick across each of its ends. */
  replaced(piece: readonly Point2[], color: string): void {
    const path = new Path2D();
    for (const [x, y] of piece) path.lineTo(x, y);
    this.stroke(path, SHADE, 3.4 * this.appearance.width);
    this.ctx.setLineDash([2 * this.scale, 4 * this.scale]);
    this.stroke(path, tinted(color, 0.82), 2 * this.appearance.width);
    this.ctx.setLineDash([]);
    const ends = new Path2D();
    for (const [end, next] of [piece.slice(0, 2), piece.slice(-2).reverse()]) {
      const long = gap(end!, next!) || 1;
      const [x, y] = [(TICK_PIXELS * this.scale * (next![1] - end![1])) / long, (TICK_PIXELS * this.scale * (end![0] - next![0])) / long];
      ends.moveTo(end![0] - x, end![1] - y);
      ends.lineTo(end![0] + x, end![1] + y);
    }
    this.stroke(ends, SHADE, 4.4 * this.appearance.width);
    this.stroke(ends, tinted(color, 0.82), 2.4 * this.appearance.width);
  }

  hand(points: readonly Vec3[], color: string): void {
    this.ctx.lineJoin = "round";
    this.line(points, tinted(color, 0.75), 2.2);
  }

  planeLine({ view, ends, handles }: PlaneLine, crosshair: Point2, state: { strong: boolean; handles: boolean; faint: boolean }): void {
    const { ctx } = this;
    const color = PLANE_COLORS[view];
    ctx.globalAlpha = state.faint ? 0.35 : state.strong ? 1 : 0.72;
    const free = 14 * this.scale; // around the crosshair, so that what lies under it can be seen
    for (const end of ends) {
      const size = Math.hypot(end[0] - crosshair[0], end[1] - crosshair[1]);
      if (size <= free) continue;
      const t = free / size;
      const path = new Path2D();
      path.moveTo(crosshair[0] + t * (end[0] - crosshair[0]), crosshair[1] + t * (end[1] - crosshair[1]));
      path.lineTo(end[0], end[1]);
      this.stroke(path, color, state.strong ? 2 : 1);
    }
    if (state.handles)
      for (const [x, y] of handles) {
        ctx.beginPath();
        ctx.arc(x, y, this.scale * (state.strong ? 5.5 : 4), 0, 2 * Math.PI);
        ctx.fillStyle = "#14181d";
        ctx.fill();
        ctx.lineWidth = 1.6 * this.scale;
        ctx.strokeStyle = color;
        ctx.stroke();
      }
    ctx.globalAlpha = 1;
  }

  /** A place where contours contradict each other. */
  conflict(at: Vec3): void {
    const p = toScreen(this.screen, at);
    this.ring(p, 9, SHADE, 4);
    this.ring(p, 9, "#ff8f3f", 2);
  }

  letters({ left, right, top, bottom }: SliceHeader["letters"]): void {
    const { width, height } = this.screen;
    this.text(left, [9, height / 2], "left", "middle");
    this.text(right, [width - 26, height / 2], "right", "middle");
    this.text(top, [width / 2, 30], "center", "top");
    this.text(bottom, [width / 2, height - 9], "center", "bottom");
  }

  scaleBar(): void {
    const { screen } = this;
    const bar = scaleBar(screen.mm_per_pixel, Math.min(140, screen.width / 3));
    const x = 12;
    const y = screen.height - 13;
    const path = new Path2D(`M${x} ${y - 4}V${y}H${x + bar.pixels}V${y - 4}`);
    this.stroke(path, SHADE, 4);
    this.stroke(path, INK, 1.5);
    this.text(bar.label, [x + 1, y - 7], "left", "bottom", `${0.85 * this.fontPixels}px system-ui, sans-serif`);
  }

  private text(
    text: string,
    [x, y]: Point2,
    align: CanvasTextAlign,
    baseline: CanvasTextBaseline,
    font = `600 ${this.fontPixels}px system-ui, sans-serif`,
  ): void {
    const { ctx } = this;
    ctx.font = font;
    ctx.textAlign = align;
    ctx.textBaseline = baseline;
    ctx.lineJoin = "round";
    ctx.lineWidth = 4;
    ctx.strokeStyle = SHADE;
    ctx.strokeText(text, x, y);
    ctx.fillStyle = INK;
    ctx.fillText(text, x, y);
  }

  private path(points: readonly Vec3[], closed: boolean): Path2D {
    const path = new Path2D();
    points.forEach((p, i) => {
      const [x, y] = toScreen(this.screen, p);
      if (i === 0) path.moveTo(x, y);
      else path.lineTo(x, y);
    });
    if (closed) path.closePath();
    return path;
  }

  private runs(points: ArrayLike<number>, runs: readonly LineRun[], slice: PixelPlane): Path2D {
    const { a, dx, dy } = sliceOnScreen(this.screen, slice);
    const path = new Path2D();
    for (const { first, count, closed } of runs) {
      for (let i = first; i < first + count; ++i) {
        const x = a * points[2 * i]! + dx;
        const y = a * points[2 * i + 1]! + dy;
        if (i === first) path.moveTo(x, y);
        else path.lineTo(x, y);
      }
      if (closed) path.closePath();
    }
    return path;
  }

  private line(points: readonly Vec3[], color: string, width: number): void {
    if (points.length < 2) return;
    const path = this.path(points, false);
    width *= this.appearance.width;
    const dash = this.ctx.getLineDash();
    this.ctx.setLineDash([]);
    this.stroke(path, SHADE, width + 1.8);
    this.ctx.setLineDash(dash);
    this.stroke(path, color, width);
  }

  private stroke(path: Path2D, color: string, width: number): void {
    this.ctx.strokeStyle = color;
    this.ctx.lineWidth = this.scale * width;
    this.ctx.stroke(path);
  }

  private handle([x, y]: Point2, selected: boolean, hovered: boolean, color: string): void {
    const { ctx } = this;
    ctx.beginPath();
    ctx.arc(x, y, this.scale * (selected || hovered ? 5.2 : 3.7), 0, 2 * Math.PI);
    ctx.fillStyle = selected ? color : "#ffffff";
    ctx.fill();
    ctx.lineWidth = 1.4 * this.scale;
    ctx.strokeStyle = selected ? "#ffffff" : "rgba(8, 10, 13, 0.9)";
    ctx.stroke();
  }

  private diamond([x, y]: Point2, color: string): void {
    const { ctx } = this;
    const r = 3.3 * this.scale;
    ctx.beginPath();
    ctx.moveTo(x, y - r);
    ctx.lineTo(x + r, y);
    ctx.lineTo(x, y + r);
    ctx.lineTo(x - r, y);
    ctx.closePath();
    ctx.lineWidth = 2 * this.scale;
    ctx.lineJoin = "miter";
    ctx.strokeStyle = SHADE;
    ctx.stroke();
    ctx.fillStyle = tinted(color, 0.55);
    ctx.fill();
  }

  private ring([x, y]: Point2, radius: number, color: string, width: number): void {
    const { ctx } = this;
    ctx.beginPath();
    ctx.arc(x, y, this.scale * radius, 0, 2 * Math.PI);
    ctx.lineWidth = this.scale * width;
    ctx.strokeStyle = color;
    ctx.stroke();
  }
}
