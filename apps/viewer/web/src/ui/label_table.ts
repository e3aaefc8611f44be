// SPDX-License-Identifier: Apache-2.0
import { button, el } from "../dom/dom";
import { piece, render, type Piece } from "../dom/pieces";
import { labelValues } from "../model/label_values";
import type { Project } from "../model/project";
import type { Structure } from "../net/protocol";
import { csv } from "./csv";
import { download } from "./download";

const LARGEST = 65535;

export interface LabelTableServices {
  project: Project;
  /** Throws where the server refuses. */
  setLabel(structure: number, value: number | "automatic"): Promise<void>;
  /** Says what went wrong. */
  failed(sentence: string): void;
}

/** What a label map will hold, and a field for each value. */
export class LabelTable {
  private readonly body = el("tbody", {});
  readonly element: HTMLElement;
  private readonly stop: () => void;

  constructor(private readonly services: LabelTableServices) {
    const save = button({
      label: "Table of labels",
      title: "Save values, names and colours as CSV",
      class: "choice",
      test: "export-labels.csv",
      click: () => download(new Blob([this.asCsv()], { type: "text/csv" }), "labels.csv"),
    });
    save.append(el("small", {}, ".csv"));
    const head = el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Value in label maps"), el("th", { scope: "col" }, "Structure")));
    this.element = el(
      "details",
      { class: "export-group label-table", "data-test": "label-table" },
      el("summary", {}, "Values in label maps"),
      el("div", { class: "label-values" }, el("table", {}, head, this.body)),
      el("div", { class: "choices" }, save),
    );
    this.stop = services.project.on(["structures"], () => this.update());
    this.update();
  }

  close(): void {
    this.stop();
  }

  private get rows(): [Structure, number][] {
    const { project } = this.services;
    const drawn = [...project.structures.values()].filter((one) => project.hasContent(one));
    const values = labelValues(drawn);
    return drawn.map((structure, n) => [structure, values[n]!]);
  }

  private update(): void {
    render(
      this.body,
      this.rows.map(([structure, value]) => this.row(structure, value)),
    );
  }

  private row({ id, name }: Structure, value: number): Piece {
    const field = piece("input", {
      type: "number",
      class: "number",
      min: "1",
      max: String(LARGEST),
      step: "1",
      value: String(value),
      "aria-label": `Label value of ${name}`,
      "data-test": "label-value",
      on: { change: ({ currentTarget }) => void this.change(id, currentTarget) },
    });
    return piece("tr", { key: id }, piece("td", {}, field), piece("th", { scope: "row" }, name));
  }

  /** An emptied field leaves the choice to kontur. */
  private async change(id: number, field: HTMLInputElement): Promise<void> {
    if (!field.reportValidity()) return;
    try {
      await this.services.setLabel(id, field.value === "" ? "automatic" : field.valueAsNumber);
    } catch (error) {
      this.services.failed(error instanceof Error ? error.message : String(error));
    }
    field.blur(); // it shows what counts, whatever was typed
    this.update();
  }

  private asCsv(): string {
    return csv([["label", "name", "color"], ...this.rows.map(([{ name, color }, value]) => [value, name, color])]);
  }
}
