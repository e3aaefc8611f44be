// SPDX-License-Identifier: Apache-2.0
import type { Project } from "../model/project";
import type { Maker } from "../net/calls";
import type { Approval, Structure } from "../net/protocol";
import { button, buttonPiece, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { iconPiece, piece, type Piece } from "../dom/pieces";
import { openDialog } from "./dialogs";

const MOST_NAME = 64; // characters, of DICOM's names of persons
const MOST_COMMENT = 1024; // and of its texts

export interface ReviewServices {
  call: Maker;
  project: Project;
}

/** "Doe, 2026-11-30 21:02". */
const words = ({ by, at }: Approval): string => [by || "somebody", at.replace("T", " ").slice(0, 16)].filter((word) => word !== "").join(", ");

const mark = (which: "approved" | "locked", icon: string, title: string): Piece =>
  piece("span", { key: which, class: `review-mark ${which}`, role: "img", "data-test": `is-${which}`, title, "aria-label": title }, iconPiece(icon));

/** Beside the name of a structure: that it is locked, and that somebody approved it. */
export function reviewMarks({ review }: Structure): Piece[] {
  const marks: Piece[] = [];
  if (review?.approved) marks.push(mark("approved", ICONS.approved, `Approved by ${words(review.approved)}`));
  if (review?.locked) marks.push(mark("locked", ICONS.locked, "Locked: nothing changes it"));
  return marks;
}

/** What reviewers can say of the active structure, and have said. */
export function reviewRows(structure: Structure, services: ReviewServices): Piece[] {
  const { id, name, review = {} } = structure;
  const { approved, comment = "", locked = false } = review;
  const { call } = services;
  const lock = buttonPiece({
    label: locked ? "Unlock" : "Lock",
    title: locked ? `Let ${name} be changed again` : `Nothing is to change ${name} any more`,
    class: "choice",
    test: "lock",
    more: { "aria-pressed": locked },
    click: () => call("structure.review", { id, locked: !locked }),
  });
  const approve = buttonPiece({
    label: approved ? "Revoke" : "Approve",
    title: approved ? `Take the approval by ${words(approved)} back` : `Say that ${name} is right as it is`,
    class: "choice",
    test: "approve",
    click: () => (approved ? call("structure.review", { id, approved_by: "" }) : askWho(structure, services)),
  });
  const say = buttonPiece({
    label: "Comment",
    title: `Say something about ${name}`,
    class: "choice",
    test: "comment",
    click: () => askComment(structure, services),
  });
  const rows: Piece[] = [piece("div", { key: "review", class: "structure-look review-buttons" }, lock, approve, say)];
  if (approved) rows.push(piece("p", { key: "approval", class: "review-text", "data-test": "approval" }, `Approved by ${words(approved)}`));
  if (comment !== "") rows.push(piece("p", { key: "comment", class: "review-text", "data-test": "comment-text" }, comment));
  return rows;
}

/** Who approved something last. */
function lastReviewer(project: Project): string {
  const approvals = [...project.structures.values()].flatMap(({ review }) => review?.approved ?? []);
  return approvals.sort((a, b) => a.at.localeCompare(b.at)).at(-1)?.by ?? known;
}
let known = ""; // who approved in this page

function askWho({ id, name }: Structure, { call, project }: ReviewServices): void {
  const field = el("input", {
    type: "text",
    value: lastReviewer(project),
    maxLength: MOST_NAME,
    required: true,
    autocomplete: "name",
    "data-test": "reviewer",
  });
  ask(`Approve ${name}`, "Who approves it?", field, "Approve", () => {
    known = field.value.trim();
    if (known !== "") call("structure.review", { id, approved_by: known });
  });
}

function askComment({ id, name, review }: Structure, { call }: ReviewServices): void {
  const field = el("textarea", { maxLength: MOST_COMMENT, rows: 4, "data-test": "comment-field" }, review?.comment ?? "");
  ask(`Comment on ${name}`, "What is to be known of it?", field, "Keep", () => call("structure.review", { id, comment: field.value.trim() }));
}

/** A dialog with one field. Enter takes what is in it, in a text of several lines Ctrl + Enter. */
function ask(title: string, label: string, field: HTMLInputElement | HTMLTextAreaElement, word: string, take: () => void): void {
  const submit = () => {
    if (!field.reportValidity()) return;
    take();
    dialog.close();
  };
  field.addEventListener("keydown", (event) => {
    event.stopPropagation(); // letters are no tools here
    if ((event as KeyboardEvent).key !== "Enter" || !(field instanceof HTMLInputElement || (event as KeyboardEvent).ctrlKey)) return;
    event.preventDefault();
    submit();
  });
  const dialog = openDialog(
    title,
    "review-dialog",
    el("label", { class: "review-field" }, label, field),
    el(
      "div",
      { class: "choices" },
      button({
        label: word,
        title: `${word} (${field instanceof HTMLInputElement ? "" : "Ctrl + "}Enter)`,
        class: "primary",
        test: "review-take",
        click: submit,
      }),
    ),
  );
  field.focus();
  field.select();
}
