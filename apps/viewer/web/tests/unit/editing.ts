// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import type { Plane } from "../../src/geometry/plane";
import type { Point2, Screen } from "../../src/geometry/screen";
import type { Vec3 } from "../../src/geometry/vec";
import { Project } from "../../src/model/project";
import type { ServerError } from "../../src/net/http";
import type { SketchPoint, Suggestion } from "../../src/net/protocol";
import { Editor } from "../../src/tools/editor";
import type { ShownOutlines } from "../../src/tools/free_outlines";
import type { Gesture } from "../../src/tools/gesture";
import type { ToolName } from "../../src/tools/registry";
import type { Remedy } from "../../src/tools/services";
import { AXIAL, session, square, started } from "./support";

export const screen: Screen = { axes: AXIAL, center: [0, 0, 0], mm_per_pixel: 0.5, width: 400, height: 400 };

export interface Call {
  name: string;
  args: Record<string, unknown>;
}

/** An editor whose server answers every call with what it was told, but for those that it is told to refuse. */
export function editing(tool: ToolName, contours = [square(5)], snap = (p: Vec3): Vec3 => p) {
  const calls: Call[] = [];
  const complaints: string[] = [];
  const remedies: Remedy[] = [];
  const server: { refusal: ServerError | null; outlines: ShownOutlines | null; lines: (plane: Plane) => Vec3[][]; planes: Suggestion[] } = {
    refusal: null,
    outlines: null,
    lines: () => [],
    planes: [],
  };
  const project = new Project();
  project.start(session({ contours }));
  const navigation = started();
  const editor = new Editor(navigation, project, {
    call: (name, given) => {
      const args = given as Record<string, unknown>;
      calls.push({ name, args: structuredClone(args) }); // the sketch goes on
      if (server.refusal) return Promise.reject(server.refusal);
      const control = ((args["control"] ?? []) as SketchPoint[]).map((point, index) => ({ ...point, at: name === "path" ? snap(point.at) : point.at, index }));
      return Promise.resolve({
        control,
        points: control.map((point) => point.at),
        lines: name === "outline" ? server.lines(args["plane"] as Plane) : [],
        planes: server.planes,
        contour: square((args["id"] as number) ?? 9),
      } as never);
    },
    screenOf: () => screen,
    outlinesOf: () => server.outlines,
    failed: (error) => (server.refusal ? complaints.push(String(error)) : assert.fail(String(error))),
    tell: (text, remedy) => {
      complaints.push(text);
      if (remedy) remedies.push(remedy);
    },
    made: () => undefined,
    notSaved: (_, why) => complaints.push(why),
  });
  editor.choose(tool);
  const press = (p: Point2, modifiers = {}): Gesture | null => editor.press("axial", screen, p, { ctrl: false, shift: false, ...modifiers });
  const drag = (...points: Point2[]) => {
    const gesture = press(points[0]!);
    for (const p of points.slice(1)) gesture?.move(p);
    gesture?.end(points.at(-1)!);
  };
  const settled = () => new Promise((resolve) => setImmediate(resolve));
  const edits = () => calls.filter(({ name, args }) => name !== "path" && args["draft"] !== true);
  const { drawing } = editor;
  /** The server takes edits again: trying again sends the one that it had refused as it was, and nothing waits any more. */
  const savedByTryingAgain = async (tryAgain = () => drawing.close()) => {
    server.refusal = null;
    tryAgain();
    await settled();
    assert.equal(drawing.sketch, null);
    assert.ok(!drawing.outbox.hasUnsaved);
    const [first, second] = edits();
    assert.equal(edits().length, 2);
    assert.deepEqual(first!.args, second!.args);
  };
  return { editor, drawing, outbox: drawing.outbox, project, navigation, calls, press, drag, settled, edits, server, complaints, remedies, savedByTryingAgain };
}

export const round = (count: number, radius: number): Point2[] =>
  Array.from({ length: count }, (_, i) => [200 + radius * Math.cos((6.2 * i) / count), 200 + radius * Math.sin((6.2 * i) / count)]);
