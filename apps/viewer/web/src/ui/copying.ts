// SPDX-License-Identifier: Apache-2.0

/** Puts the text where the user can paste it from; false where the browser does not let the page. */
export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}
