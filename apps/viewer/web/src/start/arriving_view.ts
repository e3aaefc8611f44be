// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import { el } from "../dom/dom";
import { paintThumbnail } from "./thumbnails";

/** What has come of a series that is being fetched: the slice that came last, or the one that was scrolled to. */
export class ArrivingView {
  readonly element = el("figure", { class: "arriving", "data-test": "arriving", hidden: true });
  private readonly canvas = el("canvas", { role: "img", "aria-label": "A slice that has come" });
  private readonly place = el("input", {
    type: "range",
    "aria-label": "Which of the slices that have come",
    "data-test": "arriving-place",
    on: { input: () => this.choose() },
  });
  private readonly text = el("figcaption", { "data-test": "arriving-text" });
  private at: number | null = null; // mm along the stack; null: whatever came last
  private request: AbortController | null = null;
  private again = false;

  constructor(private readonly http: Http) {
    this.element.append(this.canvas, this.place, this.text);
    this.element.addEventListener("wheel", (event) => this.scroll(event), { passive: false });
  }

  /** More may have come. */
  async update(): Promise<void> {
    this.again = this.request !== null;
    if (this.again) return;
    const own = (this.request = new AbortController());
    await paintThumbnail(this.canvas, async () => {
      const reply = await this.http.arriving(this.at, own.signal);
      if (own.signal.aborted) throw new Error("it is not seen any more");
      const { slices, at_mm, first_mm, last_mm } = reply.header;
      this.element.hidden = false;
      this.element.dataset["slices"] = String(slices);
      this.text.textContent = `${slices} ${slices === 1 ? "slice is" : "slices are"} here`;
      this.place.disabled = slices < 2;
      Object.assign(this.place, { min: String(first_mm), max: String(last_mm), step: String((last_mm - first_mm) / Math.max(1, slices - 1) || 1) });
      this.place.value = String(this.at ?? at_mm);
      return reply;
    });
    if (own.signal.aborted) return;
    this.request = null;
    if (this.again) void this.update();
  }

  stop(): void {
    this.request?.abort();
    this.request = this.at = null;
    this.again = false;
    this.element.hidden = true;
  }

  private choose(): void {
    this.at = Number(this.place.value);
    void this.update();
  }

  private scroll(event: WheelEvent): void {
    event.preventDefault();
    if (event.deltaY > 0) this.place.stepUp();
    else this.place.stepDown();
    this.choose();
  }
}
