// SPDX-License-Identifier: Apache-2.0
import { coincide } from "../geometry/plane";
import type { Vec3 } from "../geometry/vec";
import { lengthText } from "../model/lengths";
import { volumeText } from "../model/volumes";
import type { Navigation } from "../model/navigation";
import type { Maker } from "../net/calls";
import type { Conflict, Contour, NearLines, Structure, Surface } from "../net/protocol";
import { distinct, settled } from "../tools/settling";
import { contourName } from "./contour_names";
import { correctionEntries } from "./corrections";
import { faultEntries } from "./faults";
import { buttonPiece } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, type Piece } from "../dom/pieces";

const SAME_PLANE_MM = 0.01;
const RIGHT_LINES = "The band and the expected Dice are of what lies between the lines. Lines that miss the border are not found out by them.";

/** What is done about what is seen. */
export interface QualityServices {
  navigation: Navigation;
  goTo(p: Vec3): void;
  /** Selects a contour and shows it. */
  show(contour: Contour): void;
  /** Shows where to draw next. */
  suggest(): void;
  /** What is proposed is empty; null while nothing is. */
  nothingHere: (() => void) | null;
  /** Another line is proposed; null where there is none. */
  otherProposal: (() => void) | null;
  call: Maker;
}

/** How well the surface fits its contours: figures, and places to go to where it does not. */
export function qualityOf(surface: Surface | undefined, contours: Contour[], services: QualityServices, structure?: Structure): Piece[] {
  if (structure?.mask && surface) return ofMask(surface, structure, contours, services);
  return [...figures(surface, contours, services), ...selfCrossings(contours, services)];
}

function figures(surface: Surface | undefined, contours: Contour[], services: QualityServices): Piece[] {
  if (!surface || surface.stage === "none") {
    const found = surface ? troubles(surface, contours, services) : [];
    return found.length > 0 ? found : [piece("p", { class: "empty" }, "No surface yet.")];
  }
  const entries: Piece[] = [];
  const guess = depthGuess(contours);
  if (surface.volume_ml !== undefined) entries.push(figure(guess ? "Volume (a guess)" : "Volume", volumeText(surface.volume_ml), guess !== null));
  if (guess) entries.push(piece("p", { class: "warning-text", "data-test": "depth-guess" }, guess));
  entries.push(...troubles(surface, contours, services));
  if (surface.uncertainty) {
    entries.push(piece("p", { class: "certainty", "data-test": "certainty", title: RIGHT_LINES }, certaintyText(surface.uncertainty)));
    entries.push(
      buttonPiece({
        label: "Where to draw next",
        title: "Go to where a contour tells most, with the expected outline as a proposal (G)",
        class: "choice",
        test: "suggest",
        click: services.suggest,
      }),
    );
    if (services.nothingHere)
      entries.push(
        buttonPiece({
          label: "Nothing here",
          title: "The plane of the proposal shows nothing of the structure (E)",
          class: "choice",
          test: "nothing-here",
          click: services.nothingHere,
        }),
      );
    if (services.otherProposal)
      entries.push(
        buttonPiece({
          label: "Other proposal",
          title: "The neighbouring slice's contour as it is, and back (W)",
          class: "choice",
          test: "other-proposal",
          click: services.otherProposal,
        }),
      );
  }
  entries.push(...edgesBeside(surface, contours, services));
  if (surface.stage === "asking") entries.push(piece("p", { class: "image-sentence", "data-test": "image-sentence" }, "The image is being asked …"));
  else if (surface.image) entries.push(piece("p", { class: "image-sentence", "data-test": "image-sentence" }, asSentence(surface.image.text)));
  const { residual } = surface;
  if (residual) {
    entries.push(figure("Residual (rms)", lengthText(residual.rms_mm, 2)));
    entries.push(
      place(`largest residual ${lengthText(residual.max_mm, 2)}`, "Go to where the surface is farthest from a contour", "residual", () =>
        services.goTo(residual.at),
      ),
    );
  }
  return entries;
}

/** Of a mask to be corrected: lines are followed exactly, and what changed counts. */
function ofMask(surface: Surface, structure: Structure, contours: Contour[], services: QualityServices): Piece[] {
  const volume = surface.volume_ml === undefined ? [] : [figure("Volume", volumeText(surface.volume_ml))];
  const asking = surface.stage === "asking" ? [piece("p", { class: "image-sentence" }, "The image is being asked …")] : [];
  const corrected = surface.correction ? correctionEntries(surface.correction, structure, services) : [];
  return [...volume, ...troubles(surface, contours, services), ...corrected, ...asking, ...selfCrossings(contours, services)];
}

function troubles(
  { conflicts = [], faults = [], warnings = [], sides = [], near_lines = [] }: Surface,
  contours: Contour[],
  services: QualityServices,
): Piece[] {
  return [
    ...warnings.map((text) => piece("p", { class: "warning-text" }, text)),
    ...sides.flatMap(({ contour, sure }) => (sure ? [] : doubtfulSides(contour, contours, services))),
    ...near_lines.flatMap((pair) => nearLines(pair, contours, services)),
    ...faultEntries(faults, contours, services),
    ...distinct(conflicts).map((conflict) => conflictEntry(conflict, contours, services)),
  ];
}

/** The image may show that lines are not on the border, which nothing else here can. */
function edgesBeside({ edges_beside: found = [] }: Surface, contours: Contour[], { navigation, show }: QualityServices): Piece[] {
  const [farthest] = found;
  const line = contours.find(({ id }) => id === farthest?.contour);
  if (!farthest || !line) return [];
  const where = `${lengthText(Math.abs(farthest.offset_mm))} ${farthest.offset_mm < 0 ? "inside" : "outside"} of ${contourName(line, navigation)}`;
  const others = found.length > 1 ? `, and beside ${found.length - 1} more` : "";
  const title = "Show the line: if the strong edge is the border, the line is beside it, and volume and expected Dice are too";
  return [place(`Strong edges run ${where}${others}`, title, "edges-beside", () => show(line))];
}

/** Two lines of one plane that may be one, drawn twice, or the two sides of a thin wall: how they were read. */
function nearLines({ contours: ids, apart_mm, one }: NearLines, contours: Contour[], { navigation, show }: QualityServices): Piece[] {
  const [inner, outer] = ids.map((id) => contours.find((contour) => contour.id === id));
  if (!inner || !outer) return [];
  const where = `Two lines of ${contourName(inner, navigation)}, ${lengthText(apart_mm)} apart,`;
  return one
    ? [place(`${where} count as one drawn twice`, "Show one of them: delete it, or mark it as a hole if the two bound a wall", "near-lines", () => show(inner))]
    : [
        place(`${where} bound a thin wall`, "Show the hole: delete it if it is the other line drawn again, or mark it as a hole", "near-lines", () =>
          show(inner),
        ),
      ];
}

/** An open line of which nothing else that is drawn says on which side the structure lies. */
function doubtfulSides(id: number, contours: Contour[], { navigation, show }: QualityServices): Piece[] {
  const line = contours.find((contour) => contour.id === id && !contour.closed && !contour.inside);
  if (!line) return [];
  const label = `${contourName(line, navigation)} is open, and its side is doubtful`;
  return [place(label, "Show the line: its ticks point to where the structure was taken to lie, and Other side turns them", "side", () => show(line))];
}

/** Which two contradict each other, by how much, and a button for each to bend the other one to it. */
function conflictEntry(conflict: Conflict, contours: Contour[], { navigation, goTo, call }: QualityServices): Piece {
  const { at, distance_mm } = conflict;
  const [a, b] = conflict.contours.map((id) => contours.find((contour) => contour.id === id));
  const by = lengthText(distance_mm);
  const title = "Go to where two contours contradict each other";
  if (!a || !b) return place(`contours disagree by ${by}`, title, "conflict", () => goTo(at));
  const keep = (kept: Contour, yielding: Contour) => {
    const pull = settled(conflict, kept, yielding);
    const name = contourName(kept, navigation);
    return (
      pull &&
      buttonPiece({
        label: `Keep ${name}`,
        title: `Keep ${name}: bend ${contourName(yielding, navigation)} to where it crosses`,
        class: "choice",
        click: () => call("contour.pull", { ...pull }),
      })
    );
  };
  const go = place(`${contourName(a, navigation)} and ${contourName(b, navigation)} disagree by ${by}`, title, "conflict", () => goTo(at));
  return piece("div", { class: "conflict" }, go, keep(a, b), keep(b, a));
}

function selfCrossings(contours: Contour[], services: QualityServices): Piece[] {
  const places = contours.flatMap((contour) => contour.self_crossings.slice(0, 1));
  return places.map((at) => place("a contour crosses itself", "Go to where it crosses itself", "self-crossing", () => services.goTo(at)));
}

function place(
  label: string,
  title: string,
  kind: "residual" | "conflict" | "near-lines" | "self-crossing" | "side" | "edges-beside",
  click: () => void,
): Piece {
  return buttonPiece({
    label,
    icon: kind === "residual" ? ICONS.lines : ICONS.warning,
    title,
    class: kind === "residual" ? "place" : "place warning",
    test: kind,
    click,
  });
}

const asSentence = (text: string): string => `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;

/** What no line says of the object that these contours make; null where they say enough. */
function depthGuess(contours: readonly Contour[]): string | null {
  const [first] = contours;
  if (!first || !contours.every(({ plane }) => coincide(plane, first.plane, SAME_PLANE_MM))) return null;
  return `${contours.length === 1 ? "One contour" : "All contours lie in one plane"}: the depth is a guess. Draw another one across, or on another slice.`;
}

/** It says how well lines are followed, not whether they are on the border. */
const certaintyText = ({ known, text }: { known: boolean; text: string }): string => (known ? `If the lines are right: ${text}` : text);

const figure = (label: string, value: string, isGuess = false): Piece =>
  piece("div", { class: isGuess ? "figure guess" : "figure" }, piece("span", {}, label), piece("strong", {}, value));
