// SPDX-License-Identifier: Apache-2.0
import { areParallel, coincide, type PixelPlane } from "../geometry/plane";
import { depthBelow, planeOf, toScreen, type Screen } from "../geometry/screen";
import type { Vec3 } from "../geometry/vec";
import type { SavedAppearance } from "../model/appearance";
import { markedPlaces } from "../model/marks";
import { measured } from "../model/measurements";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { SliceHeader, ViewName } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { inView } from "../tools/hit";
import type { Outlines } from "./outlines";
import type { OverlayPainter } from "./overlay";
import { replacedPiece } from "./replaced_piece";

/** What came with a slice's pixels, or after them, and lies on its plane. */
export interface ShownSlice {
  plane: PixelPlane;
  header: SliceHeader;
  outlines: Outlines;
  /** Of the image. */
  time: number;
  crossingPoints: Float32Array;
}

export interface SliceVectorsServices {
  navigation: Navigation;
  project: Project;
  editor: Editor;
  appearance: SavedAppearance;
}

const MOST_ZONE_POINTS = 60;
const MOST_APART_MM = 0.01; // of planes that are one

/** So many of them that circles around them make one shape. */
function thinned(points: readonly Vec3[]): readonly Vec3[] {
  const step = Math.ceil(points.length / MOST_ZONE_POINTS);
  return points.filter((_, n) => n % step === 0);
}

/** Which lines and marks are seen over a view's slice. */
export class SliceVectors {
  constructor(
    private readonly name: ViewName,
    private readonly services: SliceVectorsServices,
  ) {}

  paint(painter: OverlayPainter, screen: Screen, slice: ShownSlice | null): void {
    if (!this.services.editor.isBare) this.paintDrawn(painter, screen, slice);
    if (slice) painter.letters(slice.header.letters);
    painter.scaleBar();
  }

  private paintDrawn(painter: OverlayPainter, screen: Screen, slice: ShownSlice | null): void {
    if (slice && areParallel(slice.plane, screen.axes)) this.paintSurfaces(painter, screen, slice);
    this.paintLines(painter, screen);
    this.paintZone(painter);
    if (slice) this.paintReplaced(painter, screen, slice);
    this.paintContours(painter, screen);
    this.paintPoints(painter, screen);
    this.paintRings(painter, screen);
    this.paintProposal(painter, screen);
    this.paintRule(painter, screen);
    this.paintSketch(painter, screen);
    this.paintMeasurements(painter, screen);
    this.services.editor.paint(painter, this.name);
  }

  private paintSurfaces(painter: OverlayPainter, screen: Screen, { header, outlines, crossingPoints, plane }: ShownSlice): void {
    const { project } = this.services;
    const shown = [...outlines.values()].filter(({ structure }) => project.structures.get(structure)?.visible);
    painter.outlines(shown, plane, (id) => project.structures.get(id)?.color ?? "#888888");
    painter.crossings(header, crossingPoints, plane, (id) => this.crossingColor(id, screen));
  }

  /** Of a mask while the hand corrects it: what will change, if anything does. */
  private paintZone(painter: OverlayPainter): void {
    const { project, editor } = this.services;
    const { handLine, movedPoints } = editor.drawing;
    const draft = project.draft;
    const active = draft ? project.structures.get(draft.structure) : project.activeStructure;
    const correction = active?.mask && project.surfaces.get(active.id)?.correction;
    const points = handLine.length > 0 ? (movedPoints ?? handLine) : (draft?.points ?? []);
    if (active && correction && points.length > 0) painter.zone(thinned(points), correction.reach_mm, active.color);
  }

  /** Of a mask while the hand draws a stroke: which piece of its outline that replaces. */
  private paintReplaced(painter: OverlayPainter, screen: Screen, { outlines, plane }: ShownSlice): void {
    const { project, editor } = this.services;
    const { handLine, movedPoints, pointerCloses } = editor.drawing;
    const active = project.activeStructure;
    const outline = active?.mask && outlines.get(active.id);
    if (!outline || movedPoints || pointerCloses || !coincide(plane, planeOf(screen), MOST_APART_MM)) return;
    if (!handLine.every((p) => Math.abs(depthBelow(screen, p)) < MOST_APART_MM)) return;
    const piece = replacedPiece(
      painter.onScreen(outline, plane),
      handLine.map((p) => toScreen(screen, p)),
    );
    if (piece) painter.replaced(piece, active.color);
  }

  private paintRings(painter: OverlayPainter, screen: Screen): void {
    const { project, navigation } = this.services;
    const crossings = project.shownContours().flatMap((contour) => contour.self_crossings);
    for (const at of [...crossings, ...markedPlaces(project.seenSurfaces())])
      if (Math.abs(depthBelow(screen, at)) < navigation.step(this.name)) painter.conflict(at);
  }

  private crossingColor(contour: number, screen: Screen): string | null {
    const { project, navigation } = this.services;
    const found = project.contour(contour);
    if (!found || !project.isShown(found) || inView(found, screen, navigation.step(this.name))) return null;
    return project.structures.get(found.structure)?.color ?? null;
  }

  private paintLines(painter: OverlayPainter, screen: Screen): void {
    const { editor, navigation } = this.services;
    const { movesPlanes = false } = editor.tool;
    const crosshair = toScreen(screen, navigation.crosshair);
    const hover = editor.hover && "line" in editor.hover && editor.hover.view === this.name ? editor.hover.line : null;
    for (const line of editor.planeLines.seenIn(this.name, screen)) {
      const strong = hover !== null && (hover.on === "crosshair" || hover.view === line.view);
      painter.planeLine(line, crosshair, { strong, handles: movesPlanes && Math.min(screen.width, screen.height) > 230, faint: !movesPlanes });
    }
  }

  private paintContours(painter: OverlayPainter, screen: Screen): void {
    const { project, editor, navigation } = this.services;
    const hover = editor.hover && "contour" in editor.hover ? editor.hover.contour : null;
    for (const contour of project.faintContours())
      if (inView(contour, screen, navigation.step(this.name))) painter.faintContour(contour, project.structures.get(contour.structure)!.color);
    for (const contour of project.shownContours()) {
      if (!inView(contour, screen, navigation.step(this.name))) continue;
      const selected = project.selection?.contour === contour.id;
      const hovered = hover?.contour === contour.id;
      painter.contour(contour, project.sideOf(contour), project.structures.get(contour.structure)!.color, {
        selected,
        hovered,
        point: selected ? (project.selection?.point ?? null) : null,
        hoveredPoint: hovered && hover.on === "point" ? hover.index : null,
      });
    }
  }

  private paintPoints(painter: OverlayPainter, screen: Screen): void {
    const { editor, navigation, project } = this.services;
    const hover = editor.hover && "point" in editor.hover && editor.hover.view === this.name ? editor.hover.point : null;
    for (const point of editor.points.lyingIn(screen, navigation.step(this.name)))
      painter.singlePoint(point, project.structures.get(point.structure)?.color ?? "#888888", {
        selected: editor.points.isSelected(point),
        hovered: hover?.at === point.at,
      });
  }

  private paintMeasurements(painter: OverlayPainter, screen: Screen): void {
    const { navigation, editor } = this.services;
    const { measurements, begun } = editor.measuring;
    const step = navigation.step(this.name);
    for (const one of measurements.lyingIn(planeOf(screen), step)) painter.measurement(one.points, measured(one), one === measurements.selected);
    if (begun && coincide(begun.plane, planeOf(screen), step / 2)) painter.measurement(begun.points, measured(begun), true);
  }

  private paintRule(painter: OverlayPainter, screen: Screen): void {
    const { editor } = this.services;
    for (const { plane, lines } of editor.rulePreview.shown) if (coincide(plane, planeOf(screen), MOST_APART_MM)) painter.rule(lines);
  }

  private paintProposal(painter: OverlayPainter, screen: Screen): void {
    const { editor, project, navigation } = this.services;
    const proposal = editor.proposals.shown;
    if (!proposal || !coincide(proposal.plane, planeOf(screen), navigation.step(this.name) / 2)) return;
    painter.proposal(proposal.lines, project.structures.get(proposal.structure)?.color ?? "#888888", proposal.isOpen);
  }

  private paintSketch(painter: OverlayPainter, screen: Screen): void {
    const { project, navigation } = this.services;
    const { drawing } = this.services.editor;
    const color = project.activeStructure?.color ?? "#e8b04a";
    const near = (p: Vec3 | undefined) => p !== undefined && Math.abs(depthBelow(screen, p)) < navigation.step(this.name) / 2;
    const { sketch } = drawing;
    if (sketch && project.isOfTime(sketch) && areParallel(sketch.plane, screen.axes) && near(sketch.first)) {
      const placed = drawing.placedLine.length > 1 ? drawing.placedLine : sketch.line();
      painter.sketch(
        placed,
        drawing.rubberLine,
        sketch.points.map((point) => point.at),
        color,
        drawing.pointerCloses,
      );
    }
    for (const { sketch: closed, line } of drawing.outbox.lines())
      if (project.isOfTime(closed) && areParallel(closed.plane, screen.axes) && near(line[0]))
        painter.hand(line, project.structures.get(closed.structure)?.color ?? color);
    if (near(drawing.handLine[0]) && near(drawing.handLine.at(-1))) painter.hand(drawing.handLine, color);
  }
}
