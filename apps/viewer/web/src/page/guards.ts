// SPDX-License-Identifier: Apache-2.0

/** Files may be dropped anywhere; the browser would show them in place of the page. */
export function acceptDrops(take: (file: File) => void): void {
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) take(file);
  });
}

/** Asks before work is left that no next visit would bring back. What is saved as late as "pagehide" Firefox no longer sends. */
export function guardClosing(isLost: () => boolean, save: () => void): void {
  window.addEventListener("beforeunload", (event) => {
    save();
    if (isLost()) event.preventDefault();
  });
  window.addEventListener("pagehide", save);
}
