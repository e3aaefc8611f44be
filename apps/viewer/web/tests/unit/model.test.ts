// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { toScreen, toWorld } from "../../src/geometry/screen";
import { dot } from "../../src/geometry/vec";
import { Navigation } from "../../src/model/navigation";
import { Project } from "../../src/model/project";
import { contourName } from "../../src/ui/contour_names";
import { near, session, SKEW, square, started } from "./support";

const history = { undo: null, redo: null };

test("the whole image fits into a view of any shape", () => {
  for (const [width, height] of [
    [300, 900],
    [900, 300],
  ] as const) {
    const screen = started().screen("axial", width, height);
    assert.ok(200 / screen.mm_per_pixel <= width && 100 / screen.mm_per_pixel <= height);
    assert.ok(200 / screen.mm_per_pixel > 0.9 * width || 100 / screen.mm_per_pixel > 0.9 * height);
  }
});

test("scrolling moves by whole slices and stops at the image's ends", () => {
  const navigation = started();
  navigation.scroll("axial", 3);
  near(navigation.crosshair, [0, 0, -6]);
  navigation.scroll("axial", 1000);
  near(navigation.crosshair, [0, 0, -50]);
  assert.deepEqual(navigation.slice("axial"), { number: 51, count: 51 });
  navigation.scroll("axial", -1000);
  assert.deepEqual(navigation.slice("axial"), { number: 1, count: 51 });
  near(navigation.crosshair, [0, 0, 50]);
  navigation.scroll("coronal", 1);
  near(navigation.crosshair, [0, 2, 50]); // away from the viewer, who stands in front
});

test("scrolling from between two slices arrives on a slice", () => {
  const navigation = started();
  navigation.setCrosshair([0, 0, -0.9]);
  navigation.scroll("axial", 1);
  near(navigation.crosshair, [0, 0, -2]);
});

test("scrolling an oblique view leaves the crosshair's place within it", () => {
  const navigation = started();
  const { u, v } = navigation.cameras.oblique.axes;
  navigation.scroll("oblique", 5);
  near([dot(navigation.crosshair, u), dot(navigation.crosshair, v)], [0, 0]);
  near([dot(navigation.crosshair, navigation.direction("oblique"))], [10]);
});

test("the crosshair cannot leave the image", () => {
  const navigation = started();
  navigation.setCrosshair([500, -500, 20]);
  near(navigation.crosshair, [100, -80, 20]);
});

test("zooming keeps the point under the pointer, within limits", () => {
  const navigation = started();
  const at = toWorld(navigation.screen("coronal", 400, 300), [310, 50]);
  for (let i = 0; i < 100; ++i) navigation.zoomAt("coronal", at, 1.3);
  assert.equal(navigation.cameras.coronal.zoom, 40);
  near(toScreen(navigation.screen("coronal", 400, 300), at), [310, 50], 1e-6);
});

test("a turned view still goes through the crosshair and scrolls to the image's corners", () => {
  const navigation = started();
  navigation.rotate("sagittal", "axial", 0.5);
  assert.ok(navigation.isTurned("sagittal"));
  navigation.scroll("sagittal", 1000);
  const { to, at } = navigation.depth("sagittal");
  assert.ok(to > 100);
  near([at], [to], 1e-9);
  navigation.resetView("sagittal");
  assert.ok(!navigation.isTurned("sagittal"));
});

test("linked slices zoom and shift together, others alone", () => {
  const navigation = started();
  navigation.zoomAt("axial", [10, 0, 0], 2);
  assert.equal(navigation.cameras.coronal.zoom, 1);
  navigation.toggleLinked();
  navigation.zoomAt("axial", [10, 0, 0], 2);
  assert.deepEqual([navigation.cameras.axial.zoom, navigation.cameras.coronal.zoom], [4, 2]);
  const before = navigation.cameras.coronal.center;
  navigation.pan("axial", [5, 6, 0]);
  near(navigation.cameras.coronal.center, [before[0] + 5, before[1] + 6, before[2]]);
  assert.equal(navigation.saved().linked, true);
});

test("going to a point moves views that are zoomed in elsewhere, and only those", () => {
  const navigation = started();
  navigation.zoomAt("axial", [-90, 0, 0], 10);
  const before = navigation.cameras.coronal;
  navigation.goTo([60, 0, 4], { axial: navigation.screen("axial", 300, 300), coronal: navigation.screen("coronal", 300, 300) });
  near(toScreen(navigation.screen("axial", 300, 300), [60, 0, 4]), [150, 150], 1e-6);
  assert.equal(navigation.cameras.coronal, before);
});

test("a contour drawn on a tilted image's axial slices belongs to the axial view", () => {
  const navigation = started();
  assert.equal(navigation.unturnedViewAlong([0, 0, -1]), "axial");
  assert.equal(navigation.unturnedViewAlong(SKEW.normal), "oblique");
  navigation.rotate("axial", "sagittal", 0.3);
  assert.equal(navigation.unturnedViewAlong(navigation.cameras.axial.axes.normal), null);
  assert.equal(navigation.unturnedViewAlong([0, 0, 1]), "axial");
});

test("what is saved brings every view back", () => {
  const navigation = started();
  navigation.rotate("oblique", "axial", 0.3);
  navigation.scroll("axial", 4);
  navigation.setLayout("single", "coronal");
  const copy = started();
  copy.start(session(), JSON.parse(JSON.stringify(navigation.saved())) as ReturnType<typeof navigation.saved>);
  assert.equal(JSON.stringify(copy.saved()), JSON.stringify(navigation.saved()));
});

test("a window keeps a positive width", () => {
  const navigation = started();
  navigation.setWindow({ center: 10, width: -50 });
  assert.ok(navigation.window.width > 0);
});

test("events set and remove structures and contours", () => {
  const project = new Project();
  project.start(session({ contours: [square(5), square(6)] }));
  project.apply({ event: "changed", contours: { set: [square(7)], removed: [5] }, history: { undo: "Draw", redo: null } });
  assert.deepEqual([...project.contours.keys()], [6, 7]);
  assert.equal(project.history.undo, "Draw");
  project.apply({ event: "changed", structures: { set: [], removed: [1] }, contours: { set: [], removed: [6, 7] }, history });
  assert.equal(project.activeStructure, undefined);
});

test("a draft stands for its contour until the server stores something", () => {
  const project = new Project();
  project.start(session({ contours: [square(5)] }));
  project.draft = square(5, { points: [] });
  assert.deepEqual(project.shownContours()[0]!.points, []);
  project.apply({ event: "changed", history });
  assert.equal(project.shownContours()[0]!.points.length, 4);
});

test("a selection ends with what it selects", () => {
  const project = new Project();
  project.start(session({ contours: [square(5)] }));
  project.select({ contour: 5, point: 3 });
  const three = square(5, { control: square(5).control.slice(0, 3) });
  project.apply({ event: "changed", contours: { set: [three], removed: [] }, history });
  assert.deepEqual(project.selection, { contour: 5, point: null });
  project.apply({ event: "changed", contours: { set: [], removed: [5] }, history });
  assert.equal(project.selection, null);
});

test("contours of hidden structures are not shown", () => {
  const project = new Project();
  project.start(session({ contours: [square(5), square(6, { visible: false })] }));
  assert.deepEqual(
    project.shownContours().map((contour) => contour.id),
    [5],
  );
  project.apply({ event: "changed", structures: { set: [{ id: 1, name: "Liver", color: "#ffffff", visible: false }], removed: [] }, history });
  assert.deepEqual(project.shownContours(), []);
});

test("a preview keeps the figures of the last finished surface; no surface has none", () => {
  const project = new Project();
  project.start(session());
  project.setSurface({ structure: 1, revision: 1, stage: "finished", triangles: 9, volume_ml: 12 });
  const heard: string[] = [];
  for (const topic of ["surfaces", "stages"] as const) project.on([topic], () => heard.push(topic));
  project.setSurface({ structure: 1, revision: 1, stage: "outdated", triangles: 9 });
  assert.equal(project.surfaces.get(1)!.volume_ml, 12);
  assert.deepEqual(heard, ["stages"], "it is the same surface: no slice is asked for");
  project.setSurface({ structure: 1, revision: 2, stage: "preview", triangles: 5 });
  assert.deepEqual(heard, ["stages", "surfaces"]);
  assert.equal(project.surfaces.get(1)!.volume_ml, 12);
  assert.equal(project.surfaces.get(1)!.stage, "preview");
  project.setSurface({ structure: 1, revision: 3, stage: "none", triangles: 0 });
  assert.equal(project.surfaces.get(1)!.volume_ml, undefined);
});

test("what is found while the image is asked counts until the image has answered", () => {
  const project = new Project();
  project.start(session());
  const heard: string[] = [];
  for (const topic of ["surfaces", "stages"] as const) project.on([topic], () => heard.push(topic));
  project.setSurface({ structure: 1, revision: 1, stage: "asking", triangles: 9, volume_ml: 12 });
  project.setSurface({ structure: 1, revision: 1, stage: "finished", triangles: 9, volume_ml: 12, image: { verdict: "no_help", text: "" } });
  assert.deepEqual(heard, ["surfaces", "stages"], "the surface is the same, and no mesh is asked for");
  project.setSurface({ structure: 1, revision: 2, stage: "asking", triangles: 9, volume_ml: 14 });
  assert.equal(project.surfaces.get(1)!.image, undefined, "of the contours before");
});

test("whether the image is used changes by events alone, and stays unknown where the image tells no borders", () => {
  const project = new Project();
  project.start(session());
  let heard = 0;
  project.on(["image"], () => ++heard);
  project.apply({ event: "changed", history, use_image: false });
  assert.equal(project.useImage, false);
  assert.equal(heard, 1);
  project.apply({ event: "changed", history });
  assert.equal(project.useImage, false);
  project.start(session({ use_image: null }));
  project.apply({ event: "changed", history, use_image: null });
  assert.equal(project.useImage, null);
});

test("the active structure is that of the selected contour, wherever it goes", () => {
  const project = new Project();
  project.start(session({ structures: [1, 2].map((id) => ({ id, name: `S${id}`, color: "#e8b04a", visible: true })), contours: [square(5)] }));
  project.select({ contour: 5, point: null });
  project.apply({ event: "changed", contours: { set: [square(5, { structure: 2 })] }, history });
  assert.equal(project.activeStructure?.id, 2);
  project.activate(1);
  project.apply({ event: "changed", contours: { set: [square(5, { structure: 2, hole: true })] }, history });
  assert.equal(project.activeStructure?.id, 1, "chosen by the user meanwhile");
});

test("of an oblique image the slices as they were taken come first, and begin on one of them", () => {
  const usual = session();
  const views = { ...usual.views, coronal: { ...usual.views.coronal, title: "Acquisition", step_mm: 10 } };
  const navigation = new Navigation();
  navigation.start({ ...usual, views, first_view: "coronal", image: { ...usual.image, center: [0, 3, 0] } }, null);
  assert.deepEqual(navigation.order, ["coronal", "axial", "sagittal", "oblique"]);
  assert.equal(navigation.big, "coronal");
  near(navigation.crosshair, [0, 0, 0]);
  assert.equal(contourName(square(1, { plane: { ...usual.views.coronal.plane, origin: [0, 20, 0] } }), navigation), "Acquisition 11");
});

test("at first all slices are whole ones, where their number is even, too", () => {
  const even = session();
  even.image.center = [1, 1, 0]; // between two sagittal and two coronal ones
  const navigation = new Navigation();
  navigation.start(even, null);
  const onSlices = () => {
    for (const view of ["axial", "sagittal", "coronal"] as const) {
      const { from, at } = navigation.depth(view);
      near([Math.abs(((at - from) / navigation.step(view)) % 1)], [0], 1e-9);
    }
  };
  onSlices();
  navigation.setCrosshair([7.3, 5.1, 3.3]);
  navigation.resetAll();
  onSlices();
});
