// SPDX-License-Identifier: Apache-2.0
import { nextDrawnSlice } from "../model/drawn_slices";
import type { Navigation, PaneName } from "../model/navigation";
import type { Project } from "../model/project";
import type { Cine } from "../model/cine";
import type { SecondImage } from "../model/second_image";
import type { ViewName } from "../net/protocol";
import type { Editor } from "../tools/editor";
import type { KeyPointer } from "../tools/key_pointer";
import { TOOLS } from "../tools/registry";
import type { HelpRow, HelpSection } from "../tools/tool";

/** What keys do things to. */
export interface CommandServices {
  navigation: Navigation;
  project: Project;
  second: SecondImage;
  editor: Editor;
  cine: Cine;
  keyPointer: KeyPointer;
  /** The view that keys are for. */
  focused(): ViewName;
  toggleSingle(pane: PaneName): void;
  undo(): void;
  redo(): void;
  help(): void;
  leave(): void;
  /** Shows where to draw next. */
  suggest(): void;
  /** Of two structures that are compared, the next or the previous place where they differ. */
  nextDifference(by: 1 | -1): void;
  rename(): void;
  tell(text: string): void;
}

/** What a key does; keys as events name them, letters small, with "Control+" or, of arrows and Enter, "Alt+" before them where that is held. */
export interface Command {
  readonly keys: readonly string[];
  readonly help?: readonly [HelpSection, ...HelpRow];
  /** It changes what is drawn, and so does nothing where that belongs to another time than is seen. Del and Backspace leave that to the tool. */
  readonly edits?: boolean;
  run(page: CommandServices, isShifted: boolean): void;
}

/** What lasts for as long as a key is down. */
export interface HeldKey {
  readonly key: string;
  readonly help?: readonly [HelpSection, ...HelpRow];
  held?(page: CommandServices, isHeld: boolean): void;
}

export const PAN_KEY: HeldKey = { key: " ", help: ["Look around", "Middle drag, Space + drag", "pan"] };

export const HELD_KEYS: readonly HeldKey[] = [
  PAN_KEY,
  { key: "b", help: ["Look around", "B, held", "the bare image: all that is drawn is out of sight"], held: ({ editor }, isHeld) => editor.showBare(isHeld) },
];

const KEY_ZOOM = 1.2;
const POINTER_PIXELS = 2;
const POINTER_FAR = 8; // times as far with Shift
const NOTHING_PROPOSED = "Nothing is proposed; G and C propose an outline.";
const ONE_PROPOSAL = "There is no contour on a slice beside this one that could be copied.";
const ONE_FRAME = "The image has one frame.";

const scroll = (steps: number, ...keys: string[]): Command => ({ keys, run: ({ navigation, focused }) => navigation.scroll(focused(), steps) });
const zoom = (factor: number, ...keys: string[]): Command => ({
  keys,
  run: ({ navigation, focused }) => navigation.zoomAt(focused(), navigation.crosshair, factor),
});

const point = (key: string, right: number, down: number): Command => ({
  keys: [key],
  run: ({ keyPointer, focused }, isShifted) => {
    const pixels = POINTER_PIXELS * (isShifted ? POINTER_FAR : 1);
    keyPointer.move(focused(), [right * pixels, down * pixels]);
  },
});

/** All that keys do but those that are held. The `?` sheet shows the rows of `help` in this order. */
export const COMMANDS: readonly Command[] = [
  ...TOOLS.map(({ id, key }): Command => ({ keys: [key], run: ({ editor }) => editor.choose(id) })),
  scroll(-1, "ArrowUp", "ArrowLeft"),
  scroll(1, "ArrowDown", "ArrowRight"),
  scroll(-10, "PageUp"),
  scroll(10, "PageDown"),
  zoom(KEY_ZOOM, "+", "="),
  zoom(1 / KEY_ZOOM, "-"),
  ...[0, 1, 2, 3].map((i): Command => ({ keys: [String(i + 1)], run: ({ navigation, toggleSingle }) => toggleSingle(navigation.order[i]!) })),
  { keys: ["5"], run: ({ toggleSingle }) => toggleSingle("surface") },
  {
    keys: ["0"],
    help: ["Look around", "1 2 3 4 5", "axial, sagittal, coronal, oblique, 3D alone; 0 all"],
    run: ({ navigation }) => navigation.setLayout("overview"),
  },
  { keys: ["x"], help: ["Look around", "X, K", "plane lines on or off; all slices zoom and shift together"], run: ({ editor }) => editor.toggleLines() },
  {
    keys: ["o"],
    help: ["Look around", "O, I", "the second image over the first, or not; the second alone, and back"],
    run: (page) => ofSecond(page, (second) => second.toggleOver()),
  },
  { keys: ["i"], run: (page) => ofSecond(page, (second) => second.flip()) },
  { keys: ["k"], run: ({ navigation }) => navigation.toggleLinked() },
  {
    keys: ["n"],
    help: ["Look around", "N, Shift + N", "the next, the previous slice with a contour"],
    run: (page, isShifted) => goToDrawnSlice(page, isShifted ? -1 : 1),
  },
  {
    keys: ["j"],
    help: ["Look around", "J, Shift + J", "the next, the previous difference of two structures, the largest first"],
    run: ({ nextDifference }, isShifted) => nextDifference(isShifted ? -1 : 1),
  },
  {
    keys: ["t"],
    help: ["Look around", "T", "play an image of several frames, or pause"],
    run: ({ cine, tell }) => void (cine.toggle() || tell(ONE_FRAME)),
  },
  {
    keys: ["."],
    help: ["Look around", ". and ,", "the next frame, and the one before"],
    run: ({ cine, tell }) => void (cine.step(1) || tell(ONE_FRAME)),
  },
  { keys: [","], run: ({ cine, tell }) => void (cine.step(-1) || tell(ONE_FRAME)) },
  { keys: ["Home"], help: ["Look around", "Home", "all views back to where they began"], run: ({ navigation }) => navigation.resetAll() },
  {
    keys: ["Enter"],
    edits: true,
    help: ["Draw", "Click the first point, double click, Enter", "close the contour"],
    run: ({ editor: { drawing, proposals } }) => void (drawing.sketch ? drawing.finish() : proposals.accept()),
  },
  point("Alt+ArrowLeft", -1, 0),
  point("Alt+ArrowRight", 1, 0),
  point("Alt+ArrowUp", 0, -1),
  point("Alt+ArrowDown", 0, 1),
  {
    keys: ["Alt+Enter"],
    help: [
      "Draw",
      "Alt + arrows; Alt + Enter",
      "without a mouse: move a pointer over the slice (Shift: farther); click there (Shift: hold, until the next time)",
    ],
    run: ({ keyPointer, focused }, isShifted) => (isShifted ? keyPointer.hold(focused()) : keyPointer.click(focused())),
  },
  {
    keys: ["u"],
    help: ["Draw", "U; Shift + U", "end the line open, or open and close the selected contour; draw open lines from now on, or not"],
    run: ({ editor }, isShifted) => {
      if (isShifted) editor.drawing.setEndsOpen(!editor.drawing.endsOpen);
      else if (!editor.isAnotherTime()) editor.openOrClose();
    },
  },
  {
    keys: ["Backspace"],
    help: ["Draw", "Backspace", "remove the last point"],
    run: ({ editor }) => editor.removeLast(),
  },
  { keys: ["Escape"], help: ["Draw", "Esc", "leave the contour or the tool"], run: ({ leave }) => leave() },
  { keys: ["F2"], help: ["Edit", "F2, double click on a name", "rename the structure"], run: ({ rename }) => rename() },
  { keys: ["Delete"], help: ["Edit", "Del", "delete the selected point, or the contour"], run: ({ editor }) => editor.remove() },
  {
    keys: ["c"],
    edits: true,
    help: ["Edit", "C, Shift + C", "propose the outline on the next, previous slice; Enter accepts, Esc drops it"],
    run: ({ editor, focused }, isShifted) => void editor.proposals.next(focused(), isShifted ? -1 : 1),
  },
  {
    keys: ["y"],
    edits: true,
    help: ["Edit", "Y", "propose the outline on this slice, where nothing is drawn on it in this frame"],
    run: ({ editor, focused }) => void editor.proposals.here(focused()),
  },
  {
    keys: ["w"],
    edits: true,
    help: ["Edit", "W", "of a proposal: the neighbouring slice's contour as it is, and back"],
    run: ({ editor, tell }) => void (editor.proposals.other() || tell(editor.proposals.shown ? ONE_PROPOSAL : NOTHING_PROPOSED)),
  },
  {
    keys: ["a"],
    edits: true,
    help: ["Edit", "A", "make the computed outline under the pointer a contour, as it is; of a mask: it is right in this slice"],
    run: ({ editor, focused }) => editor.adoptOutline(focused()),
  },
  {
    keys: ["g"],
    edits: true,
    help: ["Draw", "G", "go to where a contour tells most, with the expected outline as a proposal; again: the next best place"],
    run: ({ suggest }) => suggest(),
  },
  {
    keys: ["e"],
    edits: true,
    help: ["Draw", "E", "what is proposed is empty: nothing of the structure is in this plane; of a mask: in this slice"],
    run: ({ editor, focused, tell }) => void (editor.nothingHere(focused()) || tell(NOTHING_PROPOSED)),
  },
  { keys: ["h"], edits: true, help: ["Edit", "H", "hole on or off"], run: toggleHole },
  {
    keys: ["Control+z"],
    edits: true,
    help: ["Edit", "Ctrl + Z, Ctrl + Shift + Z", "undo, redo: every action, also after a restart"],
    run: ({ undo, redo }, isShifted) => (isShifted ? redo() : undo()),
  },
  { keys: ["Control+y"], edits: true, run: ({ redo }) => redo() },
  { keys: ["?"], run: ({ help }) => help() },
];

function goToDrawnSlice({ navigation, project, focused, tell }: CommandServices, direction: 1 | -1): void {
  const slice = nextDrawnSlice(focused(), direction, navigation, project);
  if (slice) navigation.scrollTo(focused(), slice.depth_mm);
  else tell(`No slice with a contour lies ${direction > 0 ? "beyond" : "before"} this one in the ${navigation.title(focused())} view.`);
}

function ofSecond({ second, tell }: CommandServices, act: (second: SecondImage) => void): void {
  if (second.info) act(second);
  else tell("There is no second image; the toolbar adds one.");
}

function toggleHole({ editor, project, tell }: CommandServices): void {
  const contour = project.selectedContour;
  if (contour && !contour.closed) tell("An open line encloses nothing, so it can be no hole. U closes it.");
  else if (contour) editor.edits.make("contour.set", { id: contour.id, hole: !contour.hole });
}
