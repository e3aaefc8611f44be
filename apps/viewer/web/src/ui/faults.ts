// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../geometry/vec";
import { lengthText } from "../model/lengths";
import type { Navigation } from "../model/navigation";
import type { Contour, SectionFault } from "../net/protocol";
import { buttonPiece } from "../dom/dom";
import { ICONS } from "../dom/icons";
import type { Piece } from "../dom/pieces";
import { contourName } from "./contour_names";

export interface FaultServices {
  navigation: Navigation;
  goTo(p: Vec3): void;
}

/** Where the surface is not as it was drawn: a button for each place. */
export function faultEntries(faults: readonly SectionFault[], contours: readonly Contour[], { navigation, goTo }: FaultServices): Piece[] {
  const nameOf = (id: number | undefined): string => {
    const contour = contours.find((one) => one.id === id);
    return contour ? contourName(contour, navigation) : "an empty plane";
  };
  return faults.map((fault) => {
    const { label, title } = sentence(fault, nameOf);
    return buttonPiece({ label, icon: ICONS.warning, title, class: "place warning", test: "fault", click: () => goTo(fault.at) });
  });
}

function sentence({ kind, contours, share, length_mm }: SectionFault, nameOf: (id: number | undefined) => string): { label: string; title: string } {
  const part = percent(share);
  const [first, second] = contours;
  switch (kind) {
    case "missing":
      return { label: `In ${nameOf(first)} ${part} of what is drawn is missing`, title: "Go to where the surface leaves out what is drawn" };
    case "surplus":
      return { label: `In ${nameOf(first)} ${part} of the section was not drawn`, title: "Go to where the surface has more than is drawn" };
    case "island":
      return { label: `In ${nameOf(first)} an island was not drawn: ${part} of the section`, title: "Go to the island" };
    case "between":
      return {
        label: `Between ${nameOf(first)} and ${nameOf(second)}, ${lengthText(length_mm)} apart, ${part} is missing`,
        title: "Go to the gap: a contour there carries the structure on",
      };
    case "beyond":
      return {
        label: `Beyond ${nameOf(first)} the structure goes on for ${lengthText(length_mm)}`,
        title: "Go to the end: an empty plane says where the structure ends",
      };
    case "outside":
      return { label: `${part} of the structure lies far outside of what is drawn`, title: "Go there: an empty plane says where the structure ends" };
  }
}

const percent = (share: number): string => `${(100 * share).toFixed(share < 0.0995 ? 1 : 0)} %`;
