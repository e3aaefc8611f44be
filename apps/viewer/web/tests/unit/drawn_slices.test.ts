// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Vec3 } from "../../src/geometry/vec";
import { drawnSlices, nextDrawnSlice } from "../../src/model/drawn_slices";
import { Project } from "../../src/model/project";
import type { Contour } from "../../src/net/protocol";
import { AXIAL, CORONAL, session, square, started } from "./support";

const at = (id: number, z: number, changes: Partial<Contour> = {}): Contour => square(id, { plane: { ...AXIAL, origin: [3, 4, z] as Vec3 }, ...changes });

/** An image whose axial slices lie 2 mm apart, with these contours; structure 2 is hidden. */
function drawn(...contours: Contour[]) {
  const project = new Project();
  const structures = [1, 2, 3].map((id) => ({ id, name: `S${id}`, color: "#e8b04a", visible: id !== 2 }));
  project.start(session({ contours, structures }));
  return { navigation: started(), project };
}

test("the slices with contours come in the order in which they are scrolled, each once", () => {
  const { navigation, project } = drawn(
    at(1, -6),
    at(2, 10),
    at(3, -6, { structure: 3 }),
    at(4, 2.0004),
    at(5, 2),
    square(6, { plane: { ...CORONAL, origin: [0, 8, 0] } }),
  );
  const slices = drawnSlices("axial", navigation, project);
  assert.deepEqual(
    slices.map(({ depth_mm }) => depth_mm),
    [-10, -2, 6],
    "from the head to the feet",
  );
  assert.deepEqual(slices.at(-1)!.structures, [1, 3]);
  assert.deepEqual(
    drawnSlices("coronal", navigation, project).map(({ depth_mm }) => depth_mm),
    [8],
  );
  assert.deepEqual(drawnSlices("sagittal", navigation, project), []);
});

test("what is hidden has no tick, and turned views have those of contours in their own planes", () => {
  const { navigation, project } = drawn(at(1, -6, { visible: false }), at(2, 10, { structure: 2 }), at(3, 4));
  assert.deepEqual(
    drawnSlices("axial", navigation, project).map(({ depth_mm }) => depth_mm),
    [-4],
  );
  navigation.rotate("axial", "sagittal", 0.3);
  assert.deepEqual(drawnSlices("axial", navigation, project), []);
});

test("the next drawn slice is not one that is seen already, nor one outside of the image", () => {
  const { navigation, project } = drawn(at(1, 0.9), at(2, -4), at(3, -20), at(4, 30), at(5, -300));
  const next = (direction: 1 | -1) => nextDrawnSlice("axial", direction, navigation, project)?.depth_mm;
  assert.deepEqual([next(-1), next(1)], [-30, 4], "the crosshair at 0 shows what lies at 0.9");
  navigation.scrollTo("axial", 4);
  assert.deepEqual([next(-1), next(1)], [-0.9, 20]);
  navigation.scrollTo("axial", 20);
  assert.equal(next(1), undefined);
});

test("a contour's slice has the number that the view shows there, turned or not", () => {
  const { navigation } = drawn();
  for (const view of ["axial", "sagittal", "coronal"] as const) {
    navigation.setCrosshair([0, 0, 0]);
    navigation.scroll(view, 7);
    const { number } = navigation.slice(view);
    assert.equal(navigation.unturnedSliceOf(view, navigation.crosshair), number, view);
    navigation.rotate(view, view === "axial" ? "coronal" : "axial", 0.2);
    assert.equal(navigation.unturnedSliceOf(view, navigation.crosshair), number, `${view}, turned`);
  }
});
