// SPDX-License-Identifier: Apache-2.0
import type { ViewAxes } from "../three/cube";
import { identityLines } from "../ui/identity";
import { paintCube } from "./snapshot_cube";
import type { Project } from "../model/project";
import { volumeText } from "../model/volumes";
import type { Session, Structure } from "../net/protocol";

const LINE = 20; // pixels of the page
const FONT = "system-ui, sans-serif";

export interface SnapshotServices {
  /** The panes lie in it. */
  stage: HTMLElement;
  /** Draws the 3D view once more: a canvas of WebGL forgets its picture. */
  redraw3D(): void;
  /** How the cube of the 3D view lies, and where; null where there is none. */
  cube(): { axes: ViewAxes; box: DOMRect } | null;
  project: Project;
  session: Session;
}

/** One picture of all views as they are seen, with whose image it is and what its structures are called. */
export async function snapshot({ stage, redraw3D, cube, project, session }: SnapshotServices): Promise<Blob> {
  const area = stage.getBoundingClientRect();
  const structures = [...project.structures.values()].filter((one) => one.visible && project.hasContent(one));
  const lines = [identityLines(session).join("  ·  ")];
  const ratio = window.devicePixelRatio || 1;
  const canvas = document.createElement("canvas");
  const below = LINE * (lines.length + Math.max(1, structures.length)) + 16;
  canvas.width = Math.round(area.width * ratio);
  canvas.height = Math.round((area.height + below) * ratio);
  const context = canvas.getContext("2d")!;
  context.scale(ratio, ratio);
  context.fillStyle = "#000000";
  context.fillRect(0, 0, area.width, area.height + below);
  redraw3D();
  for (const pane of stage.querySelectorAll<HTMLElement>(".pane:not([hidden])")) paintPane(context, pane, area);
  const solid = cube();
  if (solid) paintCube(context, solid.axes, solid.box, area);
  const bar = stage.querySelector<HTMLElement>(".surface-scale:not([hidden])");
  if (bar) paintScale(context, bar, area);
  paintWords(context, { top: area.height, width: area.width }, lines, structures, project);
  return await new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The browser has no memory for a picture of this size.")))),
  );
}

function paintPane(context: CanvasRenderingContext2D, pane: HTMLElement, area: DOMRect): void {
  const box = pane.getBoundingClientRect();
  const [x, y] = [box.left - area.left, box.top - area.top];
  context.save();
  context.beginPath();
  context.rect(x, y, box.width, box.height);
  context.clip();
  const isSlice = pane.classList.contains("slice");
  context.fillStyle = isSlice ? "#000000" : groundOf(pane);
  context.fillRect(x, y, box.width, box.height);
  for (const layer of pane.querySelectorAll("canvas")) {
    const { display, visibility, opacity } = getComputedStyle(layer);
    const place = layer.getBoundingClientRect();
    if (display === "none" || visibility === "hidden" || place.width === 0 || layer.width === 0) continue;
    context.globalAlpha = Number(opacity);
    context.drawImage(layer, place.left - area.left, place.top - area.top, place.width, place.height);
  }
  context.globalAlpha = 1;
  const title = isSlice ? titleOf(pane) : "";
  word(context, title, [x + 10, y + 20], "#ffffff");
  context.restore();
}

/** The bar of the 3D view, with its length above it. */
function paintScale(context: CanvasRenderingContext2D, bar: HTMLElement, area: DOMRect): void {
  const box = bar.getBoundingClientRect();
  if (box.width === 0) return;
  const [x, y] = [box.left - area.left, box.bottom - area.top];
  context.strokeStyle = "#ffffff";
  context.lineWidth = 1.5;
  context.stroke(new Path2D(`M${x} ${y - 5}V${y}H${x + box.width}V${y - 5}`));
  word(context, bar.textContent ?? "", [x + 2, y - 7], "#ffffff");
}

/** The first colour of the gradient behind the 3D view. */
const groundOf = (pane: HTMLElement): string => /(?:rgba?|color)\([^()]*\)/.exec(getComputedStyle(pane).backgroundImage)?.[0] ?? "#20242b";

const titleOf = (pane: HTMLElement): string =>
  [...pane.querySelectorAll(".pane-header > span")]
    .map((one) => one.textContent)
    .filter(Boolean)
    .join("  ");

function paintWords(
  context: CanvasRenderingContext2D,
  { top, width }: { top: number; width: number },
  lines: readonly string[],
  structures: readonly Structure[],
  project: Project,
): void {
  let y = top + LINE;
  for (const line of lines) {
    word(context, line, [10, y], "#ffffff", width - 20);
    y += LINE;
  }
  for (const { id, name, color } of structures) {
    context.fillStyle = color;
    context.fillRect(10, y - 11, 12, 12);
    const volume = project.seenSurface(id)?.volume_ml;
    word(context, volume === undefined ? name : `${name}  ·  ${volumeText(volume)}`, [30, y], "#ffffff", width - 40);
    y += LINE;
  }
}

function word(context: CanvasRenderingContext2D, text: string, [x, y]: [number, number], color: string, width?: number): void {
  context.font = `13px ${FONT}`;
  context.fillStyle = color;
  context.fillText(text, x, y, width);
}
