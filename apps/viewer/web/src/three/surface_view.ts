// SPDX-License-Identifier: Apache-2.0
import { markedPlaces } from "../model/marks";
import type { Navigation } from "../model/navigation";
import type { Opacities } from "../model/opacities";
import type { Project } from "../model/project";
import type { Theme } from "../model/theme";
import type { Http } from "../net/http";
import { ServerError, type MeshHeader } from "../net/http";
import type { BinaryReply } from "../net/binary";
import { Latest } from "../net/latest";
import { distancesOf, normalsOf, positionsOf, trianglesOf, widthsOf } from "../net/mesh_code";
import { VIEW_NAMES, type ImageInfo } from "../net/protocol";
import { scaleBar } from "../geometry/scale_bar";
import type { Vec3 } from "../geometry/vec";
import { button, buttonPiece, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, render } from "../dom/pieces";
import { PLANE_COLORS } from "../model/palette";
import type { Editor } from "../tools/editor";
import type { SinglePoint } from "../tools/single_points";
import { BAND_STOPS, bandColors, bandScale, DISTANCE_STOPS, distanceColors, ORIGIN_COLORS, originColors } from "./band";
import { OrientationCube, SIDES, type ViewAxes } from "./cube";
import { MeshFrames } from "./mesh_frames";
import type { Scene, MeshData, ScenePoint } from "./scene";
import { SurfaceInput } from "./surface_input";

export interface SurfaceViewServices {
  navigation: Navigation;
  project: Project;
  theme: Theme;
  opacities: Opacities;
  editor: Editor;
  http: Http;
  failed(error: unknown): void;
  goTo(p: Vec3): void;
  /** One more of this project, for a second screen. */
  openWindow(): void;
}

const COMPARED_WITH_OPACITY = 0.2; // it may lie around the one that is looked at

/** The pane of the 3D view. Without WebGL it says so, and the rest of the page works on. */
export class SurfaceView {
  readonly element: HTMLElement;
  readonly header = el("div", { class: "pane-header" });
  private readonly canvas = el("canvas", { class: "surface-canvas" });
  /** Listens before the controls of the scene, which turn the view. */
  private readonly input: SurfaceInput;
  private readonly message = el("div", { class: "pane-message" });
  private readonly fetches = new Map<number, Latest<void>>();
  private readonly shownRevisions = new Map<number, number>();
  private readonly frames = new MeshFrames();
  private readonly ahead = new Latest<void>(() => this.fetchAhead());
  private scene: Scene | null = null;
  private showsBand = false;
  private showsOrigins = false;
  /** One structure coloured by how far it is from another one, in its state `revision`. */
  private compared: { structure: number; other: number; revision: number } | null = null;
  private readonly band = button({
    icon: ICONS.statistics,
    title: "Colour the surface by how sure it is",
    class: "icon-button small",
    test: "band",
    click: () => this.paintBy(!this.showsBand),
  });
  private readonly who = button({
    icon: ICONS.who,
    title: "Colour corrected masks by who made what: as it was, drawn, carried on, by the image",
    class: "icon-button small",
    test: "who",
    click: () => this.paintBy(false, null, !this.showsOrigins),
  });
  private readonly ramp = el("span", { class: "band-ramp" });
  private readonly scale = el("div", { class: "band-scale", hidden: true, "data-test": "band-scale" });
  private readonly cube = new OrientationCube(({ from }) => this.scene?.viewFrom(from));
  private readonly bar = el("div", { class: "surface-scale", hidden: true });
  private opacity = 1;

  constructor(private readonly services: SurfaceViewServices) {
    this.input = new SurfaceInput(this.canvas, services, () => this.scene);
    const look = el(
      "div",
      { class: "look-from" },
      ...SIDES.map(({ letter, title, from }) => button({ label: letter, title, class: "letter-button", click: () => this.scene?.viewFrom(from) })),
    );
    const glass = button({ icon: ICONS.surface, title: "See through the surface", class: "icon-button small", click: () => this.toggleGlass() });
    const frame = button({ icon: ICONS.reset, title: "Show the whole surface", class: "icon-button small", click: () => this.scene?.frame() });
    const another = button({
      icon: ICONS.window,
      title: "Open a second window of this project, for another screen; both look at the same place",
      class: "icon-button small",
      test: "second-window",
      click: services.openWindow,
    });
    const enlarge = button({
      icon: ICONS.enlarge,
      title: "Show the 3D view alone, or go back (double click on its title)",
      class: "icon-button small",
      click: () => void this.header.dispatchEvent(new MouseEvent("dblclick")),
    });
    this.header.append(el("span", { class: "pane-title" }, "3D"), el("span", { class: "spring" }), look, this.band, this.who, glass, frame, another, enlarge);
    this.band.setAttribute("aria-pressed", "false");
    this.band.hidden = this.who.hidden = true;
    this.who.setAttribute("aria-pressed", "false");
    this.element = el(
      "section",
      { class: "pane surface", "data-view": "surface", "aria-label": "3D view" },
      this.canvas,
      this.message,
      this.header,
      this.bar,
      this.scale,
      this.cube.element,
    );
    this.cube.element.hidden = true;
    new ResizeObserver(() => this.resized()).observe(this.element);
  }

  /** How the cube lies, and where; null where there is no 3D view. */
  cubePlace(): { axes: ViewAxes; box: DOMRect } | null {
    return this.scene && !this.cube.element.hidden ? { axes: this.scene.axes, box: this.cube.element.getBoundingClientRect() } : null;
  }

  /** For a picture that is taken in this very task. */
  redraw(): void {
    this.scene?.redraw();
  }

  async start(image: ImageInfo): Promise<void> {
    if (!this.scene) {
      try {
        if (!hasWebGl()) throw new Error("no WebGL");
        const { Scene } = await import("./scene");
        this.scene ??= new Scene(this.canvas, image.corners, () => this.frameBegins());
        this.element.dataset["webgl"] = "yes";
      } catch {
        this.element.dataset["webgl"] = "no";
        this.showMessage(
          "No 3D view: this browser has no WebGL",
          "Slices, drawing, outlines and export all work without it. To see the surface in 3D, switch on hardware acceleration in the browser's settings, or use another browser.",
        );
        return;
      }
    }
    this.resized();
    this.themeChanged();
    this.surfacesChanged();
  }

  /** Lines are seen before what lies behind them. */
  themeChanged(): void {
    this.scene?.setGround(this.services.theme.scheme);
    this.planesChanged();
    this.contoursChanged();
  }

  planesChanged(): void {
    const { navigation } = this.services;
    this.scene?.setPlanes(VIEW_NAMES.map((view) => ({ plane: navigation.plane(view), color: PLANE_COLORS[view] })));
  }

  contoursChanged(): void {
    const { project } = this.services;
    this.scene?.setContours(
      project.shownContours().map((contour) => ({
        points: contour.points,
        closed: contour.closed,
        color: project.structures.get(contour.structure)!.color,
        selected: project.selection?.contour === contour.id,
      })),
    );
    this.pointsChanged();
    this.showHint();
  }

  pointsChanged(): void {
    const { editor, project } = this.services;
    const seen = (point: SinglePoint): ScenePoint => ({
      at: point.at,
      color: project.structures.get(point.structure)!.color,
      selected: editor.points.isSelected(point),
      isOnSurface: point.kind === "surface",
    });
    this.scene?.setPoints(editor.points.shown().map(seen));
  }

  /** Fetches meshes that are newer than those shown. */
  surfacesChanged(): void {
    const { project } = this.services;
    if (!this.scene) return;
    for (const id of this.scene.meshes) if (!this.hasSurface(id)) this.remove(id);
    this.compareAgain();
    for (const { structure } of project.surfaces.values()) {
      const revision = project.revisionAt(structure);
      if (!this.hasSurface(structure) || this.shownRevisions.get(structure) === revision) continue;
      const kept = this.showsBand ? null : this.frames.get(structure, project.time, revision);
      if (kept) this.show(structure, revision, kept);
      else this.fetchesOf(structure).send();
    }
    this.who.hidden = ![...project.surfaces.values()].some(({ correction }) => correction);
    this.band.hidden = !this.isSomethingSure();
    this.scene.setMarks(markedPlaces(project.seenSurfaces()));
    this.restyle();
    this.showHint();
  }

  /** Fetches the surfaces of other times, the next ones first, one after the other. */
  motionsChanged(): void {
    if (!this.scene) return;
    this.ahead.send();
    this.band.hidden = !this.isSomethingSure();
    const { motions } = this.services.project;
    const finished = [...motions.values()].filter((motion) => motion.finished);
    if (!this.showsBand || finished.length === 0) return;
    for (const { structure } of finished) this.shownRevisions.delete(structure); // how sure they are is known only now
    this.surfacesChanged();
  }

  /** Whether it is known of a surface how sure it is. */
  private isSomethingSure(): boolean {
    const { surfaces, motions } = this.services.project;
    return [...surfaces.values()].some(({ uncertainty }) => uncertainty?.known) || [...motions.values()].some(({ curve }) => curve?.intervals_ml);
  }

  /** Settles when the surfaces that are seen have come. */
  async idle(): Promise<void> {
    await Promise.all([...this.fetches.values()].map((fetches) => fetches.idle()));
  }

  private async fetchAhead(): Promise<void> {
    for (let next = this.nextAhead(); next; next = this.nextAhead()) {
      await this.idle();
      try {
        const reply = await this.services.http.mesh(next.structure, { time: next.time });
        if (reply.header.stage === "none") return;
        this.frames.keep(next.structure, next.time, reply.header.revision, meshOf(reply));
        if (reply.header.revision !== next.revision) return; // news of it are on their way
      } catch {
        return; // it is asked for when it is to be seen
      }
    }
  }

  private nextAhead(): { structure: number; time: number; revision: number } | null {
    const { project } = this.services;
    if (!this.frames.hasRoom) return null;
    for (const { structure, revisions, finished } of project.motions.values()) {
      if (!finished || !project.structures.get(structure)?.visible) continue;
      for (let n = 0; n < revisions.length; ++n) {
        const time = (project.time + n) % revisions.length;
        const revision = project.revisionAt(structure, time);
        if (revisions[time]! > 0 && !this.frames.has(structure, time, revision)) return { structure, time, revision };
      }
    }
    return null;
  }

  /** Of a server that has started anew, and counts revisions from 1. */
  forgetRevisions(): void {
    this.frames.clear();
    this.shownRevisions.clear();
  }

  restyle(): void {
    const { project, opacities } = this.services;
    for (const { id, color, visible } of project.structures.values())
      this.scene?.style(id, color, visible, id === this.compared?.other ? COMPARED_WITH_OPACITY : this.opacity * opacities.of(id));
  }

  private hasSurface(structure: number): boolean {
    const { project } = this.services;
    return project.motions.has(structure) || (project.surfaces.get(structure)?.stage ?? "none") !== "none";
  }

  private remove(id: number): void {
    this.scene?.removeMesh(id);
    this.shownRevisions.delete(id);
  }

  private fetchesOf(structure: number): Latest<void> {
    let fetches = this.fetches.get(structure);
    if (!fetches) this.fetches.set(structure, (fetches = new Latest(() => this.fetchMesh(structure))));
    return fetches;
  }

  private async fetchMesh(structure: number): Promise<void> {
    if (!this.hasSurface(structure)) return; // it went while another mesh was on its way
    try {
      const farFrom = this.compared?.structure === structure ? this.compared.other : undefined;
      const { project } = this.services;
      const { time } = project;
      const at = project.motions.has(structure) ? { time } : {};
      const reply = await this.services.http.mesh(structure, { widths: this.showsBand, origins: this.showsOrigins, farFrom, ...at });
      if (reply.header.stage === "none" || !this.hasSurface(structure)) return; // it went meanwhile
      const colors = this.compared ? this.distanceColorsOf(reply) : (this.originColorsOf(reply) ?? this.bandColorsOf(reply));
      const mesh = { ...meshOf(reply), colors };
      if (project.motions.has(structure) && !colors) this.frames.keep(structure, time, reply.header.revision, mesh);
      if (time === project.time) this.show(structure, reply.header.revision, mesh);
      else this.surfacesChanged();
    } catch (error) {
      if (!(error instanceof ServerError && error.kind === "cancelled")) this.services.failed(error);
    }
  }

  private show(structure: number, revision: number, mesh: MeshData): void {
    this.scene?.setMesh(structure, mesh);
    this.shownRevisions.set(structure, revision);
    this.restyle();
  }

  /** Of how sure the surface is, where that is wanted and known; a preview has none. */
  private bandColorsOf(reply: BinaryReply<MeshHeader>): Float32Array | undefined {
    const half_widths_mm = widthsOf(reply.header.half_width_step_mm, reply.u8("half_widths"));
    if (!this.showsBand || half_widths_mm.length === 0) return undefined;
    const most_mm = bandScale(half_widths_mm);
    this.showScale("90 % band: 0", BAND_STOPS, `± ${most_mm} mm`);
    return bandColors(half_widths_mm, most_mm);
  }

  /** Of who made what of a corrected mask, where that is wanted. */
  private originColorsOf(reply: BinaryReply<MeshHeader>): Float32Array | undefined {
    const origins = reply.u8("origins");
    if (!this.showsOrigins || origins.length === 0) return undefined;
    const steps = ORIGIN_COLORS.flatMap((color, n) => [`${color} ${(100 * n) / ORIGIN_COLORS.length}%`, `${color} ${(100 * (n + 1)) / ORIGIN_COLORS.length}%`]);
    this.showScale("as it was", steps, "drawn, carried, image");
    return originColors(origins);
  }

  /** Of how far the surface that is compared is from the other one; all others have their own colour. */
  private distanceColorsOf(reply: BinaryReply<MeshHeader>): Float32Array | undefined {
    const distances_mm = distancesOf(reply.header.distance_step_mm, reply.u8("distances"));
    if (distances_mm.length === 0) return undefined;
    const most_mm = bandScale(distances_mm.map(Math.abs));
    const name = this.services.project.structures.get(this.compared!.other)?.name ?? "the other";
    this.showScale(`${most_mm} mm inside ${name}`, DISTANCE_STOPS, `${most_mm} mm outside`);
    return distanceColors(distances_mm, most_mm);
  }

  private showScale(from: string, stops: readonly string[], to: string): void {
    this.ramp.style.background = `linear-gradient(to right, ${stops.join()})`;
    const end = buttonPiece({ icon: ICONS.close, title: "One colour again", class: "icon-button small", test: "scale-end", click: () => this.paintBy(false) });
    render(this.scale, [piece("span", {}, from), this.ramp, piece("span", {}, to), end]);
    this.scale.hidden = false;
  }

  /** Colours a structure's surface by how far it is from another one's, as long as both are there. */
  compare(structure: number, other: number): void {
    this.paintBy(false, { structure, other, revision: 0 });
  }

  private paintBy(band: boolean, compared: typeof this.compared = null, origins = false): void {
    this.showsBand = band;
    this.showsOrigins = origins;
    this.who.setAttribute("aria-pressed", String(origins));
    this.compared = compared;
    this.band.setAttribute("aria-pressed", String(band));
    this.scale.hidden = true;
    this.frames.clear();
    this.shownRevisions.clear();
    this.surfacesChanged();
  }

  /** What the other structure's surface has become changes the colours of the one that is compared with it. */
  private compareAgain(): void {
    const { compared } = this;
    if (!compared) return;
    if (!this.hasSurface(compared.structure) || !this.hasSurface(compared.other)) return this.paintBy(false);
    const { revision } = this.services.project.surfaces.get(compared.other)!;
    if (revision !== compared.revision) this.shownRevisions.delete(compared.structure);
    compared.revision = revision;
  }

  /** Tests and measurements wait for what the finished frame shows. */
  private frameBegins(): () => void {
    this.showBearings();
    const revisions = [...this.shownRevisions].map(([id, revision]) => `${id}:${revision}`).join(" ");
    return () => void (this.element.dataset["revisions"] = revisions);
  }

  /** Which way the camera looks, and how large things are. */
  private showBearings(): void {
    if (!this.scene) return;
    this.cube.element.hidden = this.bar.hidden = false;
    this.cube.turn(this.scene.axes);
    const { label, pixels } = scaleBar(this.scene.mm_per_pixel, Math.min(120, this.canvas.clientWidth / 3));
    this.bar.textContent = label;
    this.bar.style.width = `${pixels}px`;
  }

  private showHint(): void {
    if (!this.scene) return;
    const hasSurface = [...this.services.project.surfaces.values()].some((surface) => surface.stage !== "none");
    if (hasSurface || this.services.project.contours.size > 1) this.message.hidden = true;
    else this.showMessage("", "The surface appears here as soon as there is a contour.");
  }

  private showMessage(title: string, text: string): void {
    render(this.message, [title ? piece("strong", {}, title) : null, piece("p", {}, text)]);
    this.message.hidden = false;
  }

  private toggleGlass(): void {
    this.opacity = this.opacity === 1 ? 0.45 : 1;
    this.restyle();
  }

  /** Leaves what the pointer is doing; false when it is doing nothing. */
  cancel(): boolean {
    return this.input.cancel();
  }

  private resized(): void {
    const box = this.element.getBoundingClientRect();
    this.scene?.resize(box.width, box.height);
  }
}

function meshOf(reply: BinaryReply<MeshHeader>): MeshData {
  const { header } = reply;
  return {
    positions: positionsOf(header, reply.u8("positions")),
    normals: normalsOf(header, reply.u8("normals")),
    triangles: trianglesOf(header, reply.u8("triangles")),
  };
}

function hasWebGl(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}
