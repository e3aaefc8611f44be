// SPDX-License-Identifier: Apache-2.0
import { coincide, type Plane } from "../geometry/plane";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { Arguments } from "../net/calls";
import type { Structure, ViewName } from "../net/protocol";
import type { EditorServices } from "./services";
import { isHidden } from "./sight";

const SAME_PLANE_MM = 0.001;

/** What is said of a whole slice of a mask: that it is right there, or that nothing is. */
export class PlanesOfMask {
  constructor(
    private readonly navigation: Navigation,
    private readonly project: Project,
    private readonly services: EditorServices,
  ) {}

  confirm(view: ViewName): void {
    const found = this.find(view);
    if (!found) return;
    const { mask, plane, structure } = found;
    if (mask.confirmed_planes.some((other) => coincide(other, plane, SAME_PLANE_MM))) return this.services.tell(`${structure.name} is confirmed here already.`);
    const said = `${structure.name} is right in this slice: corrections of others leave it as it is. Ctrl + Z takes it back.`;
    void this.set({ id: structure.id, confirmed_planes: [...mask.confirmed_planes, plane] }, said);
  }

  empty(view: ViewName): void {
    const found = this.find(view);
    if (!found) return;
    const { plane, structure } = found;
    const planes = structure.empty_planes ?? [];
    if (planes.some((other) => coincide(other, plane, SAME_PLANE_MM))) return this.services.tell(`This slice of ${structure.name} is empty already.`);
    void this.set({ id: structure.id, empty_planes: [...planes, plane] }, `Nothing of ${structure.name} in this slice. Ctrl + Z takes it back.`);
  }

  private async set(args: Arguments<"structure.set">, said: string): Promise<void> {
    try {
      await this.services.call("structure.set", args);
      this.services.tell(said);
    } catch (error) {
      this.services.failed(error);
    }
  }

  private find(view: ViewName): { structure: Structure; mask: NonNullable<Structure["mask"]>; plane: Plane } | null {
    const structure = this.project.activeStructure;
    if (!structure?.mask || isHidden(structure.id, this.project, this.services)) return null;
    const { origin, u, v, normal } = this.navigation.plane(view);
    return { structure, mask: structure.mask, plane: { origin, u, v, normal } };
  }
}
