// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { boxSection, coincide, commonDirection, heightOver, rotatedAxes } from "../../src/geometry/plane";
import { scaleBar } from "../../src/geometry/scale_bar";
import { clippedLine, narrowWidth, nearestOnLine, slicePlane, sliceOnScreen, toScreen, toWorld, type Screen } from "../../src/geometry/screen";
import { add, cross, dot, length, rotated, scale, type Vec3 } from "../../src/geometry/vec";
import { AXIAL, CORONAL, near, session, SKEW } from "./support";

const screen: Screen = { axes: SKEW, center: [10, -20, 30], mm_per_pixel: 0.4, width: 640, height: 480 };

test("a rotation keeps lengths and the axis, and four quarter turns are none", () => {
  const axis = SKEW.normal;
  near(rotated(axis, axis, 1.234), axis, 1e-12);
  near([length(rotated([3, -4, 12], axis, 0.7))], [13], 1e-12);
  const quarter = (p: Vec3) => rotated(p, axis, Math.PI / 2);
  near(quarter(quarter(quarter(quarter([1, 2, -5])))), [1, 2, -5], 1e-12);
});

test("a rotation is right-handed", () => near(rotated([1, 0, 0], [0, 0, 1], Math.PI / 2), [0, 1, 0], 1e-12));

test("turned axes stay orthonormal and right-handed after a thousand turns", () => {
  let axes = SKEW;
  for (let i = 0; i < 1000; ++i) axes = rotatedAxes(axes, AXIAL.normal, 0.013);
  near([length(axes.u), length(axes.v), length(axes.normal), dot(axes.u, axes.v), dot(axes.u, axes.normal)], [1, 1, 1, 0, 0], 1e-12);
  near(cross(axes.u, axes.v), axes.normal, 1e-12);
});

test("screen and world are inverse on an oblique plane", () => {
  near(toScreen(screen, toWorld(screen, [17.5, 300.25])), [17.5, 300.25], 1e-9);
  near(toScreen(screen, screen.center), [320, 240]);
  near([heightOver({ ...SKEW, origin: screen.center }, toWorld(screen, [1, 2]))], [0], 1e-9);
});

test("the middle of the slice's first pixel lies half a device pixel into the screen", () => {
  for (const ratio of [1, 2, 1.5]) {
    const slice = slicePlane(screen, ratio);
    near(toScreen(screen, slice.origin), [0.5 / ratio, 0.5 / ratio], 1e-9);
    const pixel = add(slice.origin, scale(slice.u, 10 * slice.mm_per_pixel));
    near(toScreen(screen, pixel), [10.5 / ratio, 0.5 / ratio], 1e-9);
  }
});

test("a slice asked before a pan and a zoom is drawn where its image content is now", () => {
  const slice = slicePlane(screen, 2);
  const now: Screen = { ...screen, center: add(screen.center, scale(SKEW.u, 7)), mm_per_pixel: 0.25 };
  const { a, dx, dy } = sliceOnScreen(now, slice);
  const p = add(slice.origin, add(scale(slice.u, 33 * slice.mm_per_pixel), scale(slice.v, 44 * slice.mm_per_pixel)));
  near(toScreen(now, p), [33 * a + dx, 44 * a + dy], 1e-9);
});

test("planes coincide by distance and direction, whichever way they face", () => {
  const plane = { ...AXIAL, origin: [0, 0, 5] as Vec3 };
  const flipped = { u: AXIAL.v, v: AXIAL.u, normal: scale(AXIAL.normal, -1), origin: [50, 9, 5.4] as Vec3 };
  assert.ok(coincide(flipped, plane, 0.5));
  assert.ok(!coincide({ ...flipped, origin: [0, 0, 5.6] }, plane, 0.5));
  assert.ok(!coincide({ ...SKEW, origin: [0, 0, 5] }, plane, 0.5));
});

test("planes share the line along both; parallel ones share none", () => {
  near(commonDirection(AXIAL, CORONAL)!.map(Math.abs), [1, 0, 0], 1e-12);
  assert.equal(commonDirection(AXIAL, AXIAL), null);
});

test("a plane through a box's middle cuts it in a polygon on the plane and on the box", () => {
  const corners = session().image.corners;
  assert.equal(boxSection(corners, { ...AXIAL, origin: [0, 0, 0] }).length, 4);
  const plane = { ...SKEW, origin: [0, 0, 0] as Vec3 };
  const section = boxSection(corners, plane);
  assert.ok(section.length >= 4);
  for (const p of section) {
    near([heightOver(plane, p)], [0], 1e-9);
    assert.ok(Math.abs(p[0]) < 100.001 && Math.abs(p[1]) < 80.001 && Math.abs(p[2]) < 50.501);
  }
  assert.equal(boxSection(corners, { ...AXIAL, origin: [0, 0, 51] }).length, 0);
});

test("the nearest point of a line is its end where the pointer is beyond it", () => {
  near(Object.values(nearestOnLine([3, 4], [0, 0], [10, 0])), [4, 0.3]);
  near(Object.values(nearestOnLine([13, 4], [0, 0], [10, 0])), [5, 1]);
  near(Object.values(nearestOnLine([3, 4], [0, 0], [0, 0])), [5, 0]);
});

test("the narrow width of points is that of the rectangle they lie in, however it is turned", () => {
  const corners: [number, number][] = [
    [0, 0],
    [80, 0],
    [80, 3],
    [0, 3],
    [40, 1],
  ];
  for (let angle = 0; angle < 3.2; angle += 0.1)
    near([narrowWidth(corners.map(([x, y]) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)]))], [3], 0.05);
  near(
    [
      narrowWidth([
        [1, 2],
        [4, 6],
        [7, 10],
      ]),
    ],
    [0],
    1e-9,
  );
  const ring = Array.from({ length: 40 }, (_, i): [number, number] => [10 * Math.cos(i), 10 * Math.sin(i)]);
  assert.ok(narrowWidth(ring) > 19);
});

test("a line is clipped to the view, and gone when it passes by", () => {
  const [a, b] = clippedLine([50, 50], [1, 0], 100, 80)!;
  near([...a, ...b], [0, 50, 100, 50]);
  assert.equal(clippedLine([50, 90], [1, 0], 100, 80), null);
  const [c, d] = clippedLine([-50, -50], [Math.SQRT1_2, Math.SQRT1_2], 100, 80)!;
  near([...c, ...d], [0, 0, 80, 80], 1e-9);
});

test("the scale bar is the longest round length that fits, at every zoom", () => {
  for (let mm = 0.01; mm < 10; mm *= 1.17) {
    const bar = scaleBar(mm, 120);
    assert.ok(bar.pixels <= 120.001 && bar.pixels > 120 / 2.6, `${bar.pixels} at ${mm}`);
    assert.ok(["1", "2", "5"].includes(bar.mm.toExponential(0)[0]!));
    near([bar.pixels * mm], [bar.mm], 1e-9);
  }
  assert.equal(scaleBar(1, 120).label, "10 cm");
  assert.equal(scaleBar(0.05, 120).label, "5 mm");
});
