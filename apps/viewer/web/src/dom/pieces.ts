// SPDX-License-Identifier: Apache-2.0
// A panel, a list or a dialog is described anew whenever something changes, and shown by the elements that are there already: what
// the user has at hand (the keyboard's place, a name half typed, an open menu, a list scrolled, a button held down) is theirs.

type Tag = keyof HTMLElementTagNameMap;

/** What is done at an event. Unlike a property `onclick`, a listener cannot cancel the event by what it returns. */
export type Listeners<T extends Tag> = {
  [Type in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[Type] & { currentTarget: HTMLElementTagNameMap[T] }) => void;
};

export interface Properties<T extends Tag> {
  /** Tells it from its siblings of the same tag; without one, its place among them does. */
  key?: string | number | undefined;
  on?: Listeners<T>;
  style?: Record<string, string>;
  [name: string]: unknown;
}

/** An element as it is to be. */
// Pieces of all tags are children, whatever their listeners expect.
export class Piece<T extends Tag = any> {
  constructor(
    readonly tag: T | "svg" | "path",
    readonly properties: Properties<T>,
    readonly children: readonly Child[],
  ) {}
}

/** An element that is kept elsewhere is shown as it is. */
export type Child = Piece | Node | string | null | undefined;

/** Properties ("class" and "data-..." as attributes; what is undefined or null is left out), listeners and children. */
export function piece<T extends Tag>(tag: T, properties: Properties<T> = {}, ...children: Child[]): Piece<T> {
  return new Piece(tag, properties, children);
}

/** A line icon of 20 x 20. */
export function iconPiece(path: string): Piece {
  return new Piece("svg", { viewBox: "0 0 20 20", "aria-hidden": "true" }, [new Piece("path", { d: path }, [])]);
}

/** What an element shows now. */
const shown = new WeakMap<Element, Piece>();
const heard = new WeakMap<Element, Set<string>>();
/** The children that `render` put there, by their names. */
const placed = new WeakMap<Element, Map<unknown, ChildNode>>();

export function make<T extends Tag>(wanted: Piece<T>): HTMLElementTagNameMap[T] {
  const { tag } = wanted;
  const element = tag === "svg" || tag === "path" ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  patch(element, wanted);
  return element as HTMLElementTagNameMap[T];
}

/** Shows these and nothing else in `place`. An element stays as long as there is a piece of its tag and key. */
export function render(place: Element, children: readonly Child[]): void {
  const before = placed.get(place) ?? new Map<unknown, ChildNode>();
  const after = new Map<unknown, ChildNode>();
  for (const child of children) {
    if (child === null || child === undefined) continue;
    const name = nameOf(child, after);
    after.set(name, nodeOf(child, before.get(name)));
  }
  for (const [name, node] of before) if (after.get(name) !== node) node.remove();
  putInOrder(place, [...after.values()]);
  placed.set(place, after);
}

/** No two siblings are called the same: of those with one key the second is another one. */
function nameOf(child: Exclude<Child, null | undefined>, taken: ReadonlyMap<unknown, unknown>): unknown {
  if (child instanceof Node) return child;
  const name = typeof child === "string" ? "text" : `${child.tag} ${child.properties.key ?? ""}`;
  for (let number = 0; ; ++number) if (!taken.has(`${name} ${number}`)) return `${name} ${number}`;
}

function nodeOf(child: Exclude<Child, null | undefined>, kept: ChildNode | undefined): ChildNode {
  if (child instanceof Node) return child as ChildNode;
  if (typeof child === "string") {
    if (!kept) return document.createTextNode(child);
    if (kept.nodeValue !== child) kept.nodeValue = child;
    return kept;
  }
  if (!kept) return make(child);
  patch(kept as Element, child);
  return kept;
}

/** An element that has the keyboard would lose it by being moved: the others go around it. */
function putInOrder(place: Element, nodes: readonly ChildNode[]): void {
  const held = nodes.find((node) => node.contains(document.activeElement));
  let next = place.firstChild;
  for (const node of nodes) {
    if (node === held)
      while (next !== node && held.parentNode === place) {
        const passed: ChildNode = next!;
        next = passed.nextSibling;
        place.append(passed);
      }
    if (node === next) next = node.nextSibling;
    else place.insertBefore(node, next);
  }
}

function patch(element: Element, wanted: Piece): void {
  const old: Properties<Tag> = shown.get(element)?.properties ?? {};
  const { key: _key, on = {}, style = {}, value, ...properties } = wanted.properties;
  shown.set(element, wanted);
  for (const type of Object.keys(on)) listenAsShown(element, type);
  for (const [name, one] of Object.entries(style)) if (old.style?.[name] !== one) (element as HTMLElement).style.setProperty(name, one);
  for (const name of new Set([...Object.keys(old), ...Object.keys(properties)]))
    if (!["key", "on", "style", "value"].includes(name)) setProperty(element, name, old[name], properties[name]);
  if (wanted.children.length > 0 || placed.has(element)) render(element, wanted.children);
  if (value !== undefined && value !== null) setValue(element as HTMLInputElement, String(value)); // a select's is one of its children's
}

/** The listener of what the element shows when the event comes. */
function listenAsShown(element: Element, type: string): void {
  const types = heard.get(element) ?? new Set();
  if (types.has(type)) return;
  heard.set(element, types.add(type));
  element.addEventListener(type, (event) => {
    const on = shown.get(element)!.properties.on as Record<string, ((event: Event) => void) | undefined> | undefined;
    on?.[type]?.(event);
  });
}

function setProperty(element: Element, name: string, old: unknown, wanted: unknown): void {
  const target = element as unknown as Record<string, unknown>;
  const isOfUser = name === "checked" || name === "selected"; // who may have changed it, and have been refused
  if (wanted === old && !(isOfUser && target[name] !== wanted)) return;
  const isThere = wanted !== undefined && wanted !== null;
  if (name === "class" || name.includes("-") || element instanceof SVGElement) {
    if (isThere) element.setAttribute(name, String(wanted));
    else element.removeAttribute(name);
  } else if (isThere) target[name] = wanted;
  else if (old !== undefined && old !== null) target[name] = typeof old === "boolean" ? false : "";
}

/** A field that has the keyboard keeps what is typed in it. */
export function setValue(field: HTMLInputElement | HTMLSelectElement, value: string): void {
  const isTyped = field instanceof HTMLInputElement && field === document.activeElement;
  if (field.value !== value && !isTyped) field.value = value;
}
