// SPDX-License-Identifier: Apache-2.0
import { button, el } from "../dom/dom";
import { ICONS } from "../dom/icons";

/** Puts what does not fit into a bar into a menu at its end. */
export class Overflow {
  private readonly menu = el("div", { class: "popover more", popover: "auto", role: "group", "aria-label": "More", "data-test": "more-menu" });
  private readonly opener = button({ icon: ICONS.more, title: "More: what does not fit here", class: "icon-button", test: "more", click: () => undefined });
  private readonly places: HTMLElement[];
  private width = -1;

  /** `groups`: those that may go, the first one first; each has a place of its own in the bar. */
  constructor(
    private readonly bar: HTMLElement,
    private readonly groups: readonly HTMLElement[],
  ) {
    this.opener.popoverTargetElement = this.menu;
    this.menu.addEventListener("click", (event) => {
      const pressed = event.target instanceof Element ? event.target.closest("button") : null;
      if (pressed && pressed.popoverTargetElement === null) this.menu.hidePopover();
    });
    this.places = groups.map((group) => {
      const place = el("span", { hidden: true });
      group.before(place);
      return place;
    });
    bar.append(this.opener, this.menu);
    new ResizeObserver(() => this.fit()).observe(bar);
  }

  /** `changed`: what is in the bar has another width. */
  fit(changed = false): void {
    if (this.bar.clientWidth === this.width && !changed) return;
    this.width = this.bar.clientWidth;
    this.groups.forEach((group, i) => this.places[i]!.after(group));
    this.opener.hidden = true;
    for (const group of this.groups) {
      if (this.bar.scrollWidth <= this.bar.clientWidth) break;
      this.opener.hidden = false;
      this.menu.append(group);
    }
  }
}
