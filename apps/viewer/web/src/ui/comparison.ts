// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { Comparison } from "../net/protocol";
import { lengthText } from "../model/lengths";
import { button, el } from "../dom/dom";
import { piece, render } from "../dom/pieces";

interface Named {
  structure: number;
  name: string;
}

const mm = (value: number | null): string => (value === null ? "not known" : lengthText(value, 2));

/** What is told of two structures, and in which words. */
export function rowsOf(found: Comparison, [first, second]: readonly [string, string]): [string, string][] {
  const [a, b] = found.volumes_ml;
  return [
    ["Dice", found.dice.toFixed(4)],
    ["Jaccard", found.jaccard.toFixed(4)],
    ["Mean distance of the surfaces", mm(found.mean_mm)],
    ["95 % of the distances are within", mm(found.percentile_95_mm)],
    ["Largest distance", mm(found.largest_mm)],
    [`Volume of ${first}`, `${a.toFixed(2)} ml`],
    [`Volume of ${second}`, `${b.toFixed(2)} ml`],
  ];
}

/** What can be seen of two structures in the views. */
export interface ComparedViews {
  showDistances(first: number, second: number): void;
  goThrough(first: number, second: number): void;
}

/** Two structures to choose, such as two readers' drawings of one organ, and how they agree. */
export function comparison(http: Http, structures: readonly Named[], signal: AbortSignal, views: ComparedViews): HTMLElement {
  const choice = (chosen: number, title: string, test: string) => {
    const select = el("select", { "aria-label": title, "data-test": test });
    select.append(...structures.map(({ structure, name }, i) => el("option", { value: String(structure), selected: i === chosen }, name)));
    return select;
  };
  const first = choice(0, "The first to compare", "compare-first");
  const second = choice(1, "The second to compare", "compare-second");
  const status = el("p", { class: "dialog-status", role: "status" });
  const table = el("table", { "data-test": "comparison" });
  let asked = 0;
  const compare = async () => {
    const number = ++asked;
    status.textContent = "Comparing …";
    render(table, []);
    try {
      const found = await http.compare(Number(first.value), Number(second.value), signal);
      if (number !== asked) return; // others have been chosen meanwhile
      const names = [first, second].map((select) => select.selectedOptions[0]!.text) as [string, string];
      render(
        table,
        rowsOf(found, names).map(([head, text]) => piece("tr", {}, piece("th", { scope: "row" }, head), piece("td", {}, text))),
      );
      status.textContent =
        "Of the masks on the image's grid, each fitted by itself; distances between the centres of their outermost voxels, in both directions.";
    } catch (error) {
      if (number === asked) status.textContent = error instanceof Error ? error.message : String(error);
    }
  };
  const go = button({ label: "Compare", title: "Fit both and compare their masks", class: "choice", test: "compare", click: () => void compare() });
  const map = button({
    label: "Show distances in 3D",
    title: "Colour the first one's surface by how far it is from the second's",
    class: "choice",
    test: "compare-map",
    click: () => views.showDistances(Number(first.value), Number(second.value)),
  });
  const walk = button({
    label: "Go through differences",
    title: "All views go to where they differ most, and on to the next place",
    class: "choice",
    test: "compare-walk",
    click: () => views.goThrough(Number(first.value), Number(second.value)),
  });
  const same = () => void (map.disabled = walk.disabled = first.value === second.value);
  for (const select of [first, second]) select.addEventListener("change", same);
  return el(
    "section",
    { class: "comparison", "aria-label": "Compare two structures" },
    el("div", { class: "field" }, "Compare", first, "with", second, go, map, walk),
    table,
    status,
  );
}
