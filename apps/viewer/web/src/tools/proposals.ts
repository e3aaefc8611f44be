// SPDX-License-Identifier: Apache-2.0
import { areParallel, coincide, heightOver, projected, type Plane } from "../geometry/plane";
import { add, dot, scale, type Vec3 } from "../geometry/vec";
import { Emitter } from "../model/emitter";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import { VIEW_NAMES, type Contour, type Hand, type ViewName } from "../net/protocol";
import { stretchAlong } from "./alongside";
import type { Drawing } from "./drawing";
import { isHoleOf } from "./free_outlines";
import type { EditorServices } from "./services";
import { isContourHidden, isHidden } from "./sight";
import { Sketch } from "./sketch";

const SAME_PLANE_MM = 0.01;

/** Lines of a structure on a plane that are not contours before the user says so. */
export interface Proposal {
  structure: number;
  plane: Plane;
  lines: readonly (readonly Vec3[])[];
  /** Its one line is an open one; and where the structure lies of it, if that is known. */
  isOpen?: boolean;
  inside?: Hand | undefined;
  /** What else the lines may be, the next one first: the neighbouring slice's contours as they are. */
  others?: readonly Lines[];
}

type Lines = readonly (readonly Vec3[])[];

/** Offers what is fitted on another slice: Enter makes contours of it, Esc drops it. */
export class Proposals extends Emitter<"proposal"> {
  shown: Proposal | null = null;
  private asked: Plane | null = null; // what is shown, or on its way
  private suggestions = 0; // asked for, or of no use any more
  private skipped: { structure: number; planes: Plane[] } = { structure: 0, planes: [] }; // suggested since contours have changed

  constructor(
    private readonly navigation: Navigation,
    private readonly project: Project,
    private readonly drawing: Drawing,
    private readonly services: EditorServices,
  ) {
    super();
    project.on(["contours"], () => {
      this.skipped.planes = [];
      ++this.suggestions;
      this.drop();
    });
    project.on(["time"], () => {
      this.drop();
    });
    navigation.on(["planes"], () => this.dropOutOfSight());
  }

  /** Goes `steps` slices on, from what is proposed, or the selected contour, or else the view's slice, and offers the outline there. */
  async next(view: ViewName, steps: number): Promise<void> {
    const { project, navigation, services, drawing } = this;
    if (drawing.sketch) return services.tell("Close the contour that you are drawing first (Enter), or leave it (Esc).");
    const selected = project.selectedContour;
    const structure = selected ? project.structures.get(selected.structure) : project.activeStructure;
    if (!structure) return services.tell("Draw a contour first; then its surface is proposed on other slices.");
    if (selected ? isContourHidden(selected, project, services) : isHidden(structure.id, project, services)) return;
    const from = this.asked ?? selected?.plane ?? navigation.plane(view);
    const onward = Math.sign(dot(from.normal, navigation.direction(view))) || 1;
    const step_mm = navigation.step(view);
    const plane = { ...from, origin: add(from.origin, scale(from.normal, steps * onward * step_mm)) };
    if (!this.goTo(plane, step_mm)) return services.tell("There is no slice further on in this direction.");
    const drawn = this.drawnIn(structure.id, plane, step_mm);
    if (drawn) return this.pass(drawn, structure.name);
    await this.propose(structure.id, plane, selected);
  }

  /** Offers the outline on the view's slice at the time that is seen. */
  async here(view: ViewName): Promise<void> {
    const { project, navigation, services, drawing } = this;
    if (drawing.sketch) return services.tell("Close the contour that you are drawing first (Enter), or leave it (Esc).");
    const structure = project.activeStructure;
    if (!structure || isHidden(structure.id, project, services)) return;
    const { origin, u, v, normal } = navigation.plane(view);
    const drawn = this.drawnIn(structure.id, { origin, u, v, normal }, navigation.step(view));
    if (drawn) return this.pass(drawn, structure.name);
    this.drop();
    await this.propose(structure.id, { origin, u, v, normal });
  }

  private drawnIn(structure: number, plane: Plane, step_mm: number): Contour | undefined {
    const { project } = this;
    return project.contoursOf(structure).find((contour) => project.isOfTime(contour) && coincide(contour.plane, plane, step_mm / 2));
  }

  /**
   * Turns a view to the plane on which a contour would tell most, of what moves in the frame that is least sure, and offers the expected
   * outline there; once more: the next best. Returns the view.
   */
  async suggest(): Promise<ViewName | null> {
    const { project, navigation, services, drawing } = this;
    const structure = project.activeStructure;
    if (drawing.sketch) return (services.tell("Close the contour that you are drawing first (Enter), or leave it (Esc)."), null);
    if (!structure || isHidden(structure.id, project, services)) return null;
    if (structure.mask)
      return (services.tell(`${structure.name} is a mask: look through its slices, and correct it where it is wrong. A says that one is right.`), null);
    const motion = project.motions.get(structure.id);
    if (motion ? !motion.finished : !project.surfaces.get(structure.id)?.uncertainty)
      return (services.tell(`Nothing is suggested before the surface of ${structure.name} is finished.`), null);
    if (this.skipped.structure !== structure.id) this.skipped = { structure: structure.id, planes: [] };
    const number = ++this.suggestions;
    try {
      const { planes } = await services.call("suggest", { structure: structure.id, skip: this.skipped.planes });
      if (number !== this.suggestions) return null; // it was asked of other contours, or once more
      const [best] = planes;
      if (!best)
        return (services.tell(`No other plane is suggested for ${structure.name}: it needs a finished surface, and planes that are not drawn yet.`), null);
      this.skipped.planes.push(best.plane);
      if (best.time !== undefined) navigation.setTime(best.time);
      const view = VIEW_NAMES.find((name) => areParallel(navigation.cameras[name].axes, best.plane)) ?? "oblique";
      this.drop();
      if (!areParallel(navigation.cameras[view].axes, best.plane)) navigation.turnTo(view, best.plane);
      this.asked = best.plane;
      navigation.setCrosshair(best.plane.origin);
      this.shown = { structure: structure.id, plane: best.plane, lines: best.lines.filter((line) => line.length >= 3) };
      this.emit("proposal");
      return view;
    } catch (error) {
      services.failed(error);
      return null;
    }
  }

  /** Shows what of the structure's surface lies on the plane; or else, if there is one, the contour laid there. */
  async propose(structure: number, plane: Plane, instead?: Contour): Promise<void> {
    this.asked = plane;
    try {
      const { lines } = await this.services.call("outline", { structure, plane, snap: true, ...this.atTime() });
      if (this.asked !== plane) return; // another one was asked for, or none is wanted any more
      const there = lines.filter((line) => line.length >= 3);
      const laid = instead?.points.map((p) => projected(plane, p));
      if (laid && !instead!.closed) return this.offerOpen(structure, plane, stretchAlong(there, laid) ?? laid, instead!.inside);
      if (there.length === 0 && laid) there.push(laid);
      if (there.length === 0) return this.tellNone(structure);
      const copied = laid && there.includes(laid) ? [] : this.copied(structure, plane);
      this.shown = { structure, plane, lines: there, others: copied.length > 0 ? [copied] : [] };
      this.emit("proposal");
    } catch (error) {
      this.services.failed(error);
    }
  }

  private atTime(): { time?: number } {
    const time = this.project.timeOfNew;
    return time === null ? {} : { time };
  }

  /** The contours of the nearest parallel slice, laid into the plane. */
  private copied(structure: number, plane: Plane): Lines {
    const { project } = this;
    const parallel = project.contoursOf(structure).filter((contour) => project.isOfTime(contour) && contour.closed && areParallel(contour.plane, plane));
    const away = (contour: Contour) => Math.abs(heightOver(plane, contour.plane.origin));
    const nearest = parallel.reduce<Contour | null>((best, one) => (best && away(best) <= away(one) ? best : one), null);
    if (!nearest) return [];
    const together = parallel.filter((contour) => coincide(contour.plane, nearest.plane, SAME_PLANE_MM));
    return together.map((contour) => contour.points.map((p) => projected(plane, p)));
  }

  /** Shows the next of what the lines may be. False where nothing is proposed, or nothing else. */
  other(): boolean {
    const [next, ...rest] = this.shown?.others ?? [];
    if (!this.shown || !next) return false;
    this.shown = { ...this.shown, lines: next, others: [...rest, this.shown.lines] };
    this.emit("proposal");
    return true;
  }

  /** Of an open line's neighbour only what runs along it: of the rest the user said nothing. */
  private offerOpen(structure: number, plane: Plane, line: readonly Vec3[], inside: Hand | undefined): void {
    this.shown = { structure, plane, lines: [line], isOpen: true, inside };
    this.emit("proposal");
  }

  /** False where nothing is proposed. */
  accept(): boolean {
    if (!this.shown || this.drawing.holdsUnsaved()) return false;
    const { structure, plane, lines, isOpen, inside } = this.shown;
    const sketches = lines.map((line) =>
      isOpen
        ? Sketch.openFree(plane, structure, line, { inside, origin: "proposed" })
        : Sketch.closedFree(plane, structure, line, { hole: isHoleOf(line, lines, plane), origin: "proposed" }),
    );
    this.drop();
    if (this.project.activeStructure?.id !== structure) this.project.activate(structure);
    for (const sketch of sketches) this.drawing.send(sketch);
    return true;
  }

  /** The plane of the proposal shows nothing of the structure: the surface keeps out of it. False where nothing is proposed. */
  nothingHere(): boolean {
    if (!this.shown || this.drawing.holdsUnsaved()) return false;
    const { project, services } = this;
    const { plane, structure } = this.shown;
    const own = project.structures.get(structure);
    this.drop();
    if (!own) return false;
    services.call("structure.set", { id: structure, empty_planes: [...(own.empty_planes ?? []), plane] }).catch(services.failed);
    services.tell(`Nothing of ${own.name} in this plane. Ctrl + Z takes it back; G goes on.`);
    return true;
  }

  /** False where nothing is proposed. */
  drop(): boolean {
    const was = this.shown;
    this.asked = this.shown = null;
    if (was) this.emit("proposal");
    return was !== null;
  }

  /** What is not seen any more is not accepted by mistake. */
  private dropOutOfSight(): void {
    const { asked, navigation } = this;
    if (asked && !VIEW_NAMES.some((view) => coincide(asked, navigation.plane(view), navigation.step(view) / 2))) this.drop();
  }

  /** Moves the crosshair onto the plane; false where the image ends before it. */
  private goTo(plane: Plane, step_mm: number): boolean {
    const { navigation } = this;
    const before = navigation.crosshair;
    this.drop(); // Enter accepts no outline of the slice that one has left
    this.asked = plane;
    navigation.setCrosshair(projected(plane, before));
    if (Math.abs(heightOver(plane, navigation.crosshair)) < step_mm / 4) return true;
    this.drop();
    navigation.setCrosshair(before);
    return false;
  }

  private pass(drawn: Contour, name: string): void {
    this.drop();
    this.project.select({ contour: drawn.id, point: null });
    this.services.tell(`This slice has a contour of ${name} already.`);
  }

  private tellNone(structure: number): void {
    this.drop();
    this.services.tell(`${this.project.structures.get(structure)?.name ?? "The structure"} has no outline on this slice.`);
  }
}
