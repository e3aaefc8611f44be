// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import * as THREE from "three";
import { Materials } from "../../src/three/materials";

test("without a graphics processor a surface has no inside, unless one sees through it", () => {
  const materials = new Materials(true);
  const surface = materials.surface();
  const look = (opacity: number): THREE.Side => {
    materials.look(surface, "#ff0000", opacity, false);
    return surface.side;
  };
  assert.equal(look(1), THREE.FrontSide);
  assert.equal(look(0.4), THREE.DoubleSide);
  assert.equal(look(1), THREE.FrontSide);
});

test("with one it has both sides", () => {
  const surface = new Materials(false).surface();
  new Materials(false).look(surface, "#ff0000", 1, false);
  assert.equal(surface.side, THREE.DoubleSide);
});

test("a surface is compiled anew where what it is made of changes, and not for another colour", () => {
  const materials = new Materials(true);
  const surface = materials.surface();
  materials.look(surface, "#ff0000", 1, false);
  const { version } = surface;
  materials.look(surface, "#00ff00", 1, false);
  assert.equal(surface.version, version);
  assert.equal(surface.color.getHexString(), "00ff00");
  materials.look(surface, "#00ff00", 1, true);
  assert.equal(surface.version, version + 1);
  assert.equal(surface.color.getHexString(), "ffffff", "the points' colours are multiplied by it");
  materials.look(surface, "#00ff00", 0.4, true);
  assert.equal(surface.version, version + 2);
});

test("lines on larger pixels have less of their colour, and all of it again on the screen's", () => {
  const materials = new Materials(true);
  const [strong, faint] = [materials.line("#ffffff", 1), materials.line("#ffffff", 0.4)];
  materials.drawOn(0.5);
  assert.deepEqual([strong.opacity, faint.opacity], [0.5, 0.2]);
  materials.drawOn(1);
  assert.deepEqual([strong.opacity, faint.opacity], [1, 0.4]);
});
