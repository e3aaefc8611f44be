// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Vec3 } from "../../src/geometry/vec";
import { markedPlaces } from "../../src/model/marks";
import type { SectionFault, Surface } from "../../src/net/protocol";
import type { Piece } from "../../src/dom/pieces";
import { contourName } from "../../src/ui/contour_names";
import { faultEntries } from "../../src/ui/faults";
import { square, started } from "./support";

const fault = (kind: SectionFault["kind"], contours: number[], at: Vec3 = [1, 2, 3]): SectionFault => ({ kind, at, contours, share: 0.123, length_mm: 33 });
const texts = (piece: Piece): string =>
  piece.children.map((child) => (typeof child === "string" ? child : child && "children" in child ? texts(child as Piece) : "")).join("");

test("a fault names its contours, and a click goes there", () => {
  const navigation = started();
  const contours = [square(5), square(6)];
  const went: Vec3[] = [];
  const entries = faultEntries([fault("island", [5]), fault("between", [5, 6], [4, 5, 6]), fault("outside", []), fault("missing", [])], contours, {
    navigation,
    goTo: (p) => went.push(p),
  });
  const [island, between, outside, missing] = entries.map(texts);
  const name = contourName(contours[0]!, navigation);
  assert.equal(island, `In ${name} an island was not drawn: 12 % of the section`);
  assert.match(between!, new RegExp(`^Between ${name} and .*, 33(\\.0)? mm apart, 12 % is missing$`));
  assert.match(outside!, /^12 % of the structure lies far outside/);
  assert.match(missing!, /^In an empty plane/);
  entries[1]!.properties.on!.click!({} as never);
  assert.deepEqual(went, [[4, 5, 6]]);
});

test("conflicts and faults are marked, of every surface", () => {
  const surface = (more: Partial<Surface>): Surface => ({ structure: 1, revision: 1, stage: "finished", triangles: 0, ...more });
  const places = markedPlaces([
    surface({ conflicts: [{ at: [1, 0, 0], distance_mm: 2, contours: [1, 2] }], faults: [fault("beyond", [1], [2, 0, 0])] }),
    surface({}),
    surface({ faults: [fault("surplus", [1], [3, 0, 0])] }),
  ]);
  assert.deepEqual(places, [
    [1, 0, 0],
    [2, 0, 0],
    [3, 0, 0],
  ]);
});
