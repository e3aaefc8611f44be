// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../geometry/vec";
import type { Http } from "../net/http";
import type { SecondStatistics, Statistics, StructureStatistics } from "../net/protocol";
import { comparison, type ComparedViews } from "./comparison";
import { csv } from "./csv";
import { openDialog } from "./dialogs";
import { button, el } from "../dom/dom";
import { download } from "./download";

const rounded = (value: number, digits = 3): string => (Math.abs(value) >= 10 ** digits ? value.toFixed(0) : String(Number(value.toPrecision(digits))));

interface Column {
  head: string;
  value(row: StructureStatistics): number | string;
}

const withUnit = (head: string, unit: string): string => (unit === "" ? head : `${head}, ${unit}`);

/** Of the second image's values: empty where a structure lies beyond it. */
function secondColumns({ modality, unit }: NonNullable<Statistics["second"]>): Column[] {
  const name = modality || "Second image";
  const column = (head: string, of: (second: SecondStatistics) => number | undefined, unit_ = unit): Column => ({
    head: withUnit(`${name}: ${head}`, unit_),
    value: ({ second }) => (second && of(second)) ?? "",
  });
  return [
    column("mean", ({ mean }) => mean),
    column("deviation", ({ deviation }) => deviation),
    column("least", ({ range }) => range?.[0]),
    column("most", ({ range }) => range?.[1]),
    column("voxels", ({ voxels }) => voxels, ""),
  ];
}

/** The unit stands once, in the head. */
export function columns({ unit, second }: Pick<Statistics, "unit" | "second">): Column[] {
  return [
    { head: "Structure", value: ({ name }) => name },
    { head: "Contours", value: ({ contours }) => contours },
    { head: "Volume, ml", value: ({ volume_ml }) => volume_ml },
    { head: "Volume, 90 % from, ml", value: ({ volume_90_ml }) => volume_90_ml?.[0] ?? "" },
    { head: "Volume, 90 % to, ml", value: ({ volume_90_ml }) => volume_90_ml?.[1] ?? "" },
    { head: "Surface, cm²", value: ({ surface_cm2 }) => surface_cm2 },
    { head: "Largest diameter, mm", value: ({ diameter_mm }) => diameter_mm },
    { head: "Extent R-L, mm", value: ({ extent_mm }) => extent_mm[0] },
    { head: "Extent A-P, mm", value: ({ extent_mm }) => extent_mm[1] },
    { head: "Extent S-I, mm", value: ({ extent_mm }) => extent_mm[2] },
    { head: withUnit("Mean", unit), value: ({ mean }) => mean },
    { head: withUnit("Deviation", unit), value: ({ deviation }) => deviation },
    { head: withUnit("Least", unit), value: ({ range }) => range[0] },
    { head: withUnit("Most", unit), value: ({ range }) => range[1] },
    { head: "Voxels", value: ({ voxels }) => voxels },
    ...(second ? secondColumns(second) : []),
  ];
}

export function asCsv({ structures, ...images }: Statistics): string {
  const shown = columns(images);
  return csv([shown.map(({ head }) => head), ...structures.map((row) => shown.map(({ value }) => value(row)))]);
}

/** Measures all structures anew, as `kontur segment` makes them. */
export function openStatistics(http: Http, goTo: (p: Vec3) => void, views: ComparedViews): void {
  const abort = new AbortController();
  const status = el("p", { class: "dialog-status", role: "status" }, "Measuring …");
  const content = el("div", { class: "statistics" });
  const dialog = openDialog("Statistics", "statistics-dialog", content, status);
  dialog.addEventListener("close", () => abort.abort());
  http.statistics(abort.signal).then(
    (found) => {
      status.textContent =
        "Volume, area and lengths are the surface's; between the two volumes of 90 % the true one lies in nine cases of ten. Values those of the voxels whose centres lie inside. A click on a diameter shows where it ends.";
      content.append(
        table(found, (p) => (dialog.close(), goTo(p))),
        ...beyond(found.structures).map((text) => el("p", { class: "warning-text", "data-test": "beyond-second" }, text)),
      );
      const save = button({
        label: "Save as CSV",
        title: "Save the table as CSV",
        class: "choice",
        test: "statistics-csv",
        click: () => download(new Blob([asCsv(found)], { type: "text/csv" }), "statistics.csv"),
      });
      dialog.append(el("div", { class: "dialog-buttons" }, save));
      if (found.structures.length > 1)
        dialog.append(
          comparison(http, found.structures, abort.signal, {
            showDistances: (first, second) => (dialog.close(), views.showDistances(first, second)),
            goThrough: (first, second) => (dialog.close(), views.goThrough(first, second)),
          }),
        );
    },
    (error: unknown) => void (status.textContent = error instanceof Error ? error.message : String(error)),
  );
}

/** Which values of the second image are not all that the structure has, or none. */
export function beyond(structures: readonly StructureStatistics[]): string[] {
  return structures.flatMap(({ name, second }) => {
    if (!second) return [];
    if (second.voxels === 0) return [`${name} holds no voxel of the second image.`];
    return second.points_beyond ? [`${name} reaches beyond the second image, whose values are those of the part within.`] : [];
  });
}

/** Structures side by side: what is compared stands in one row. */
function table({ structures, ...images }: Statistics, goTo: (p: Vec3) => void): HTMLTableElement {
  const rows = columns(images).map(({ head, value }) => {
    const cells = structures.map((row) => {
      const shown = value(row);
      const text = typeof shown === "number" ? (Number.isInteger(shown) ? String(shown) : rounded(shown)) : shown;
      if (head === "Structure") return el("th", { scope: "col" }, text);
      const isDiameter = head.startsWith("Largest diameter");
      const content = isDiameter ? button({ label: text, title: "Go to one end of it", class: "place", click: () => goTo(row.diameter[0]) }) : text;
      return el("td", {}, content);
    });
    return el("tr", {}, el("th", { scope: "row" }, head), ...cells);
  });
  return el("table", { "data-test": "statistics" }, ...rows);
}
