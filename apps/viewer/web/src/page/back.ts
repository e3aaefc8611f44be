// SPDX-License-Identifier: Apache-2.0

const OPEN = "kontur-open";

/** The browser's Back goes from an open image to the start page, as the button of the toolbar does, and not out of kontur. */
export class BackToStart {
  private isHeard = false;

  /** `leave` is false where the image stays open. */
  constructor(private readonly leave: () => Promise<boolean>) {}

  /** An image is open, and there is a start page behind it. */
  start(): void {
    this.enter();
    if (this.isHeard) return;
    this.isHeard = true;
    window.addEventListener("popstate", () => void this.back());
  }

  private enter(): void {
    if (history.state !== OPEN) history.pushState(OPEN, "");
  }

  private async back(): Promise<void> {
    if (history.state !== OPEN && !(await this.leave())) this.enter();
  }
}
