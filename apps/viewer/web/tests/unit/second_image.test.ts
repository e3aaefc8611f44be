// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { SecondImage } from "../../src/model/second_image";
import type { FurtherImage } from "../../src/net/protocol";
import { Sketch } from "../../src/tools/sketch";
import { valuesText } from "../../src/ui/values";
import { COLOR_MAPS, colorTable } from "../../src/model/color_maps";
import { colorsOfCodes } from "../../src/view/windowing";
import { AXIAL, session } from "./support";

function pet(changes: Partial<FurtherImage> = {}): FurtherImage {
  const identity = { ...session().identity, modality: "PT" };
  return {
    image: 1,
    key: "a",
    title: "pet",
    size: [30, 27, 48],
    spacing_mm: [5, 5, 3],
    unit: "SUV (g/ml)",
    range: [0, 20],
    notes: [],
    identity,
    emission: true,
    window: { center: 5, width: 10 },
    presets: [],
    times: 1,
    time: 0,
    ...changes,
  };
}

describe("a second image", () => {
  test("of a tracer begins in the colours of heat, another one in grey, each in its own window", () => {
    const second = new SecondImage();
    assert.equal(second.isSeen, false);
    second.set(pet());
    assert.deepEqual([second.shown, second.colors, second.window], ["both", "hot", { center: 5, width: 10 }]);
    second.set(pet({ key: "b", emission: false, window: { center: 1, width: 2 } }));
    assert.deepEqual([second.colors, second.window], ["gray", { center: 1, width: 2 }]);
  });

  test("is looked at as before while it is the same image, also at the next visit", () => {
    const second = new SecondImage();
    second.set(pet());
    second.setOpacity(0.3);
    second.setColors("cividis");
    second.setWindow({ center: 2, width: 4 });
    second.show("second");
    const saved = second.saved()!;
    second.set(pet()); // the page connects again
    assert.deepEqual(second.saved(), saved);
    const next = new SecondImage();
    next.set(pet(), JSON.parse(JSON.stringify(saved)));
    assert.deepEqual(next.saved(), saved);
    next.set(pet({ key: "b" }), saved);
    assert.deepEqual([next.opacity, next.colors], [0.7, "hot"]);
    next.set(null);
    assert.equal(next.saved(), null);
  });

  test("flips to it alone and back to what was seen before, and what is alone is drawn on", () => {
    const second = new SecondImage();
    second.set(pet());
    assert.equal(second.front, 0);
    second.flip();
    assert.deepEqual([second.shown, second.front, second.isAlone], ["second", 1, true]);
    second.flip();
    assert.deepEqual([second.shown, second.front], ["both", 0]);
    second.toggleOver();
    assert.deepEqual([second.shown, second.isSeen], ["first", false]);
    second.flip();
    second.flip();
    assert.equal(second.shown, "first");
    second.show("second");
    second.toggleOver();
    assert.equal(second.shown, "both");
    second.show("second");
    second.set(null);
    assert.equal(second.front, 0, "of one that was removed nothing is drawn on");
  });

  test("is never put into a window without width, nor out of sight by a slip", () => {
    const second = new SecondImage();
    second.set(pet());
    second.setWindow({ center: 3, width: -8 });
    assert.deepEqual(second.window, { center: 3, width: 0.02 });
    second.setOpacity(7);
    assert.equal(second.opacity, 1);
  });

  test("stands beside the first under the pointer, each with its modality and unit", () => {
    const first = session({ identity: { ...session().identity, modality: "CT" } });
    assert.equal(valuesText([-12.4], first, null), "-12 HU");
    assert.equal(valuesText([-12.4, 3.14159], first, pet()), "CT -12 HU  ·  PT 3.142 SUV (g/ml)");
    assert.equal(valuesText([null, 3], session(), pet({ unit: "", identity: session().identity })), "first outside  ·  second 3");
  });
});

describe("colours", () => {
  const part = (color: number) => [color & 255, (color >> 8) & 255, (color >> 16) & 255, color >>> 24];

  test("run from the first stop to the last; over another image what is low fades out, but not in grey", () => {
    for (const { name, stops, fades } of COLOR_MAPS) {
      const alone = colorTable(name, false);
      const over = colorTable(name, true);
      assert.deepEqual(part(alone[0]!), [...stops[0]!, 255], name);
      assert.deepEqual(part(alone[255]!), [...stops.at(-1)!, 255], name);
      assert.equal(part(over[0]!)[3], fades ? 0 : 255, name);
      assert.equal(part(over[255]!)[3], 255, name);
      const alphas = [...over].map((color) => part(color)[3]!);
      assert.deepEqual(
        alphas,
        [...alphas].sort((a, b) => a - b),
        name,
      );
    }
    assert.deepEqual(part(colorTable("gray", true)[77]!), [77, 77, 77, 255]);
  });

  test("of cividis grow lighter all along, so that they are read without seeing hue", () => {
    const light = [...colorTable("cividis", false)].map((color) => part(color)).map(([r, g, b]) => 0.2126 * r! + 0.7152 * g! + 0.0722 * b!);
    light.slice(1).forEach((value, i) => assert.ok(value >= light[i]! - 0.6, `shade ${i}`));
  });

  test("of values are those of their shades, and nothing outside of the image", () => {
    const coding = { first: -3, step: 0.25 };
    const window = { center: 4, width: 9 };
    const shades = colorsOfCodes(
      coding,
      window,
      Uint32Array.from({ length: 256 }, (_, shade) => shade),
      0,
    );
    const table = colorTable("hot", false);
    const colors = colorsOfCodes(coding, window, table, 0);
    assert.equal(colors[0], 0);
    for (let i = 1; i < 300; ++i) assert.equal(colors[i], table[shades[i]!], `code ${i}`);
  });
});

describe("a sketch of wires", () => {
  const images = (sketch: Sketch) => sketch.points.map(({ image }) => image);

  test("follows the image that was seen when each point was placed, from the point before on", () => {
    const sketch = new Sketch({ ...AXIAL, origin: [0, 0, 0] }, 1, "wire");
    sketch.place([0, 0, 0]);
    sketch.place([1, 0, 0]);
    sketch.setImage(1); // the line from the last point on follows the image that is seen now
    sketch.place([2, 0, 0]);
    assert.deepEqual(images(sketch), [undefined, 1, 1]);
    assert.equal(sketch.rubberBand([3, 0, 0]).at(-1)!.image, 1, "and the pointer's end of it snaps to that image");
    sketch.setImage(0);
    sketch.place([3, 0, 0]);
    assert.deepEqual(images(sketch), [undefined, 1, undefined, undefined]);
    assert.deepEqual(images(Sketch.from(JSON.parse(JSON.stringify(sketch.saved())))), images(sketch));
  });

  test("keeps what the hand has drawn", () => {
    const sketch = Sketch.closedFree({ ...AXIAL, origin: [0, 0, 0] }, 1, [
      [0, 0, 0],
      [1, 0, 0],
      [1, 1, 0],
    ]);
    sketch.setImage(1);
    assert.deepEqual(images(sketch), [undefined]);
  });
});
