// SPDX-License-Identifier: Apache-2.0
import { nearestOnPath, type NearPlace } from "../geometry/loop";
import { gap, type Point2 } from "../geometry/screen";

const lengthOf = (line: readonly Point2[]): number => line.slice(1).reduce((sum, p, i) => sum + gap(line[i]!, p), 0);

/** The points of a closed line from one place of it to another, in its direction. */
function between(loop: readonly Point2[], from: NearPlace, to: NearPlace): Point2[] {
  const isAhead = from.index === to.index && gap(loop[from.index]!, from.at) <= gap(loop[to.index]!, to.at);
  const steps = isAhead ? 0 : (to.index - from.index + loop.length) % loop.length || loop.length;
  const passed = Array.from({ length: steps }, (_, n) => loop[(from.index + 1 + n) % loop.length]!);
  return [from.at, ...passed, to.at];
}

/**
 * What a stroke across a mask's outline replaces, as the server does: the piece between the places that are nearest to its ends, the
 * shorter way round. Null where these lie on two outlines, or farther away than half of the stroke's length.
 */
export function replacedPiece(outlines: readonly (readonly Point2[])[], stroke: readonly Point2[]): Point2[] | null {
  if (stroke.length < 2) return null;
  const nearest = (p: Point2) =>
    outlines
      .filter((loop) => loop.length > 2)
      .map((loop) => ({ loop, place: nearestOnPath(loop, p) }))
      .reduce<{ loop: readonly Point2[]; place: NearPlace } | null>((best, one) => (best && best.place.distance <= one.place.distance ? best : one), null);
  const from = nearest(stroke[0]!);
  const to = nearest(stroke.at(-1)!);
  if (!from || !to || from.loop !== to.loop) return null;
  if (Math.max(from.place.distance, to.place.distance) > lengthOf(stroke) / 2) return null;
  const ahead = between(from.loop, from.place, to.place);
  const back = between(from.loop, to.place, from.place);
  return lengthOf(ahead) <= lengthOf(back) ? ahead : back;
}
