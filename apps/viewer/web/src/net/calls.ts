// SPDX-License-Identifier: Apache-2.0
import type { Calls, Edited } from "./protocol";

/** Calls and what goes with them, as apps/viewer/protocol has them. */
export type CallName = keyof Calls;
export type Arguments<Name extends CallName> = Calls[Name]["arguments"];
export type Result<Name extends CallName> = Calls[Name]["result"];

/** Asks the server, and gets its answer. */
export type Caller = <Name extends CallName>(name: Name, args: Arguments<Name>) => Promise<Result<Name>>;
/** Has the server do something. What comes of it is told by events. */
export type Maker = <Name extends CallName>(name: Name, args: Arguments<Name>) => void;

const OF_LOOKS = ["id", "ids", "name", "color", "visible", "label_value"];

/** Whether a call changes what is drawn, and not only how it is called, coloured and seen. */
export function changesDrawing<Name extends CallName>(name: Name, args: Arguments<Name>): boolean {
  if (name === "structure.add" || name === "structure.show_only" || name === "structure.review") return false;
  const isSetting = name === "contour.set" || name === "structure.set";
  return !isSetting || Object.keys(args).some((key) => !OF_LOOKS.includes(key));
}

/** Those that change a contour, or add one, and can be drafts. */
export type EditName = { [Name in CallName]: Result<Name> extends Edited ? Name : never }[CallName];
export type Edit = { [Name in EditName]: { name: Name; args: Arguments<Name> } }[EditName];
