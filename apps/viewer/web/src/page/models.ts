// SPDX-License-Identifier: Apache-2.0
import { Appearance } from "../model/appearance";
import { Navigation } from "../model/navigation";
import { Opacities } from "../model/opacities";
import { PaneSizes } from "../model/pane_sizes";
import { Project } from "../model/project";
import { SecondImage } from "../model/second_image";
import type { Theme } from "../model/theme";

/** What the page shows, and how: none of it knows of elements, or of the server. */
export class Models {
  readonly navigation = new Navigation();
  readonly project = new Project();
  readonly appearance = new Appearance();
  readonly opacities = new Opacities();
  readonly sizes = new PaneSizes();
  readonly second = new SecondImage();

  constructor(readonly theme: Theme) {}
}
