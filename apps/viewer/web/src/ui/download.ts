// SPDX-License-Identifier: Apache-2.0
import { el } from "../dom/dom";

/** Hands the bytes to the browser's downloads. */
export function download(blob: Blob, name: string): void {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
