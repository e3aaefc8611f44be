// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../geometry/vec";
import { volumeText } from "../model/volumes";
import type { Maker } from "../net/calls";
import type { CorrectionState, CorrectionStep, Structure } from "../net/protocol";
import { PLANE_COLORS } from "../model/palette";
import { contourName, placeOf } from "./contour_names";
import type { RowServices } from "./contour_rows";
import { buttonPiece } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, type Piece } from "../dom/pieces";

/** What is done about what is seen. */
export interface CorrectionServices {
  goTo(p: Vec3): void;
  call: Maker;
}

/** The planes in which a mask is right: a row for each, to go there, and to take that back. */
export function confirmedPlaneRows({ id, mask }: Structure, { navigation, call, show }: RowServices): Piece[] {
  const planes = mask?.confirmed_planes ?? [];
  return planes.map((plane, i) => {
    const name = contourName({ plane }, navigation);
    const forget = () => call("structure.set", { id, confirmed_planes: planes.filter((other) => other !== plane) });
    return piece(
      "div",
      { key: `confirmed-${i}`, class: "contour-row", "data-test": "confirmed-plane" },
      piece("span", { class: "plane-dot", style: { background: PLANE_COLORS[placeOf({ plane }, navigation).view ?? "oblique"] } }),
      buttonPiece({
        label: name,
        title: "Go to this plane, in which the mask is right",
        class: "contour-plane",
        part: `confirmed-${i}`,
        click: () => show({ plane }),
      }),
      piece("span", { class: "contour-points" }, "right"),
      buttonPiece({ icon: ICONS.remove, title: "Forget that the mask is right here", class: "icon-button small", part: `unconfirm-${i}`, click: forget }),
    );
  });
}

const REACHES = [0.5, 1, 2] as const;

/** What the corrections of a mask come to, and what can be done about it. */
export function correctionEntries(correction: CorrectionState, { id, mask }: Structure, { goTo, call }: CorrectionServices): Piece[] {
  const entries: Piece[] = [piece("p", { class: "certainty", "data-test": "correction" }, asSentence(correctionText(correction)))];
  if (correction.step?.voxels) entries.unshift(piece("p", { class: "certainty", "data-test": "correction-step" }, asSentence(stepText(correction.step))));
  if (correction.followed)
    entries.push(
      piece("p", { class: "certainty", "data-test": "followed" }, asSentence(`with masks beside it ${voxelsText(correction.followed)} changed hands`)),
    );
  if (correction.image) entries.push(piece("p", { class: "image-sentence", "data-test": "image-sentence" }, asSentence(correction.image)));
  for (const { at, volume_ml } of correction.dropped ? [] : correction.loose)
    entries.push(
      buttonPiece({
        label: `A piece of ${volumeText(volume_ml)} hangs loose`,
        icon: ICONS.warning,
        title: "Go to the piece that a correction cut off",
        class: "place warning",
        test: "loose-piece",
        click: () => goTo(at),
      }),
    );
  if (correction.loose.length > 0) {
    const drop = !correction.dropped;
    entries.push(
      buttonPiece({
        label: drop ? "Take loose pieces away" : "Keep loose pieces",
        title: drop ? "Take away the pieces that corrections cut off" : "Keep the pieces that corrections cut off",
        class: "choice",
        test: "drop-loose",
        click: () => call("structure.set", { id, drop_loose: drop }),
      }),
    );
  }
  entries.push(
    piece(
      "label",
      { class: "field", title: "How far corrections are carried on to both sides of their planes" },
      "Reach",
      piece(
        "select",
        {
          key: "reach",
          "data-test": "reach",
          on: { change: ({ currentTarget }) => call("structure.set", { id, reach: Number(currentTarget.value) }) },
        },
        ...REACHES.map((reach) =>
          piece("option", { value: String(reach), selected: reach === (mask?.reach ?? 1) }, { 0.5: "half", 1: "usual", 2: "twice" }[reach]),
        ),
      ),
    ),
  );
  return entries;
}

function correctionText({ text, voxels, move_mm, followed }: CorrectionState): string {
  if (voxels === 0 && followed) return "no correction of its own";
  return voxels === 0 ? "nothing changed" : `all corrections: ${text}; up to ${move_mm.toFixed(1)} mm along the lines`;
}

const voxelsText = (voxels: number): string => (voxels === 1 ? "1 voxel" : `${voxels.toLocaleString("en")} voxels`);

/** What the last step changed. */
function stepText({ voxels, more_ml }: CorrectionStep): string {
  return `changed: ${voxelsText(voxels)}, ${volumeText(Math.abs(more_ml))} ${more_ml < 0 ? "less" : "more"}`;
}

const asSentence = (text: string): string => `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;
