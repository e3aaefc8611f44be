// SPDX-License-Identifier: Apache-2.0
import type { Project } from "../model/project";
import type { Contour } from "../net/protocol";
import type { EditorServices } from "./services";

/** Whether what is drawn into the structure would not be seen. Says so, and offers to show it. */
export function isHidden(structure: number | undefined, project: Project, services: EditorServices): boolean {
  const hidden = structure === undefined ? undefined : project.structures.get(structure);
  if (!hidden || hidden.visible) return false;
  const show = () => services.call("structure.set", { id: hidden.id, visible: true }).catch(services.failed);
  services.tell(`${hidden.name} is hidden: what you draw into it would not be seen.`, { label: "Show it", act: () => void show() });
  return true;
}

/** The same of a contour, which can be hidden by itself. */
export function isContourHidden(contour: Contour, project: Project, services: EditorServices): boolean {
  if (isHidden(contour.structure, project, services)) return true;
  if (contour.visible) return false;
  const show = () => services.call("contour.set", { id: contour.id, visible: true }).catch(services.failed);
  services.tell("The selected contour is hidden: what you do to it would not be seen.", { label: "Show it", act: () => void show() });
  return true;
}
