// SPDX-License-Identifier: Apache-2.0
import type { Screen } from "../geometry/screen";
import type { Caller } from "../net/calls";
import type { Contour, ViewName } from "../net/protocol";
import type { ShownOutlines } from "./free_outlines";
import type { Sketch } from "./sketch";

/** What the user may do about what he is told. */
export interface Remedy {
  label: string;
  act: () => void;
}

/** What the tools need of the page around them. */
export interface EditorServices {
  call: Caller;
  screenOf(view: ViewName): Screen | null;
  /** What is shown of computed surfaces on the view's slice; null before that has come. */
  outlinesOf(view: ViewName): ShownOutlines | null;
  failed(error: unknown): void;
  tell(text: string, remedy?: Remedy): void;
  /** A contour as an edit of this page has left it. */
  made(contour: Contour): void;
  /** What the user has finished, and the server did not take: it stays. */
  notSaved(sketch: Sketch, why: string): void;
}
