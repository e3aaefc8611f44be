// SPDX-License-Identifier: Apache-2.0
import type { Maker } from "../net/calls";
import type { Project } from "../model/project";
import { el } from "../dom/dom";

export interface UseImageServices {
  project: Project;
  call: Maker;
}

/** Whether the image is asked between the contours; hidden where it cannot tell borders, and before anything is drawn. */
export class UseImageSwitch {
  private readonly box = el("input", {
    type: "checkbox",
    "data-test": "use-image",
    on: { change: () => this.services.call("image.set", { use: this.box.checked }) },
  });
  readonly element = el(
    "label",
    {
      class: "check use-image",
      hidden: true,
      title:
        "Use the image: where it has shown, at contours left out, that it knows better, the surface follows it between the contours; the dotted line is what the contours alone make",
    },
    this.box,
    "Use the image",
  );

  constructor(private readonly services: UseImageServices) {
    services.project.on(["contours", "image", "stages", "refused"], () => this.update());
  }

  private update(): void {
    const { useImage, contours } = this.services.project;
    this.element.hidden = useImage === null || contours.size === 0;
    this.box.checked = useImage === true;
  }
}
