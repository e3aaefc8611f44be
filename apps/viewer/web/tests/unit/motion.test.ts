// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { drawnTimes } from "../../src/model/drawn_times";
import { Project } from "../../src/model/project";
import type { Motion } from "../../src/net/protocol";
import { MeshFrames } from "../../src/three/mesh_frames";
import { session, square } from "./support";

const motion = (revisions: number[], finished = true): Motion => ({
  structure: 1,
  finished,
  warnings: [],
  revisions,
  curve: { volumes_ml: [30, 20, 10, 20], largest: 0, smallest: 2, stroke_ml: 20, ejection_fraction: 2 / 3 },
});

/** An image of 4 frames that was opened at the second, with one contour there and one in the fourth. */
function beating(): Project {
  const project = new Project();
  const plain = session();
  const contours = [square(5), { ...square(6), time: 3 }];
  project.start({
    ...plain,
    image: { ...plain.image, times: 4, time: 1 },
    contours,
    surfaces: [{ structure: 1, revision: 7, stage: "finished", triangles: 1, volume_ml: 19, time: 1, warnings: ["hm"] }],
    motions: [motion([3, 4, 5, 6])],
  });
  project.setTime(1, 1);
  return project;
}

test("contours are of the frame in which they were drawn, and faint in others", () => {
  const project = beating();
  const ids = (contours: { id: number }[]) => contours.map(({ id }) => id);
  assert.deepEqual([ids(project.shownContours()), ids(project.faintContours())], [[5], [6]]);
  assert.equal(project.timeOfNew, null);
  project.setTime(3, 1);
  assert.deepEqual([ids(project.shownContours()), ids(project.faintContours())], [[6], [5]]);
  assert.equal(project.timeOfNew, 3);
  assert.deepEqual(
    drawnTimes(project).map(({ time, contours, ofActive }) => [time, contours, ofActive]),
    [
      [1, 1, 1],
      [3, 1, 1],
    ],
  );
});

test("of a frame the newer of two surfaces is seen: the hand's, of its frame alone, and the motion's", () => {
  const project = beating();
  assert.deepEqual(
    [0, 1, 2, 3].map((time) => project.revisionAt(1, time)),
    [3, 7, 5, 6],
  );
  project.setMotion(motion([8, 9, 10, 0]));
  assert.deepEqual(
    [0, 1, 2, 3].map((time) => project.revisionAt(1, time)),
    [8, 9, 10, 7],
    "where there is none yet the hand's is better than nothing",
  );
});

test("figures are those of the frame that is seen", () => {
  const project = beating();
  assert.deepEqual([project.seenSurface(1)!.volume_ml, project.seenSurface(1)!.warnings], [20, ["hm"]]);
  project.setTime(2, 1);
  assert.deepEqual([project.seenSurface(1)!.volume_ml, project.seenSurface(1)!.warnings], [10, []]);
});

test("a motion without revisions is none any more", () => {
  const project = beating();
  let told = 0;
  project.on(["motions"], () => ++told);
  project.setMotion({ ...motion([]), finished: false });
  assert.deepEqual([project.motions.size, told], [0, 1]);
});

test("surfaces that are kept for playing are bounded, and the ones used last stay", () => {
  const frames = new MeshFrames();
  const mesh = () => ({ positions: new Float32Array(15 << 20), normals: new Float32Array(0), triangles: new Uint32Array(0) });
  for (let time = 0; time < 4; ++time) frames.keep(1, time, 1, mesh());
  assert.equal(frames.size, 4);
  frames.get(1, 0, 1);
  frames.keep(1, 4, 1, mesh());
  assert.deepEqual([frames.has(1, 0, 1), frames.has(1, 1, 1), frames.has(1, 4, 1)], [true, false, true]);
  assert.equal(frames.get(1, 0, 2), null, "another revision is another surface");
});
