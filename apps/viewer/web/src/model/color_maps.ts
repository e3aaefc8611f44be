// SPDX-License-Identifier: Apache-2.0

export type ColorMapName = "gray" | "inverse" | "hot" | "cividis";

type Color = readonly [number, number, number];

interface ColorMap {
  name: ColorMapName;
  label: string;
  /** From the window's lower end to its upper one, at equal distances. */
  stops: readonly Color[];
  /** Over another image what is low is not seen: nothing of that image is lost where there is nothing to show. */
  fades: boolean;
}

const hex = (text: string): Color => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16)) as unknown as Color;

/** Cividis is read alike by people of any colour vision (Nunez, Anderton and Renslow 2018). */
export const COLOR_MAPS: readonly ColorMap[] = [
  { name: "gray", label: "Grey", stops: ["#000000", "#ffffff"].map(hex), fades: false },
  { name: "inverse", label: "Grey, inverted", stops: ["#ffffff", "#000000"].map(hex), fades: true },
  {
    name: "hot",
    label: "Hot",
    stops: ["#000000", "#550000", "#aa0000", "#ff0000", "#ff5500", "#ffaa00", "#ffff00", "#ffff80", "#ffffff"].map(hex),
    fades: true,
  },
  {
    name: "cividis",
    label: "Cividis",
    stops: ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"].map(hex),
    fades: true,
  },
];

const FADE_SHADES = 64; // of 256, from nothing to all

const mapNamed = (name: ColorMapName): ColorMap => COLOR_MAPS.find((map) => map.name === name)!;

function colorAt(stops: readonly Color[], t: number): Color {
  const at = t * (stops.length - 1);
  const low = Math.min(Math.floor(at), stops.length - 2);
  return stops[low]!.map((from, i) => Math.round(from + (at - low) * (stops[low + 1]![i]! - from))) as unknown as Color;
}

/** The colour of each shade as a canvas holds it (red in the lowest byte); `over`: as it lies over another image. */
export function colorTable(name: ColorMapName, over: boolean): Uint32Array {
  const { stops, fades } = mapNamed(name);
  return Uint32Array.from({ length: 256 }, (_, shade) => {
    const [r, g, b] = colorAt(stops, shade / 255);
    const alpha = over && fades ? Math.min(255, Math.round((255 * shade) / FADE_SHADES)) : 255;
    return ((alpha << 24) | (b << 16) | (g << 8) | r) >>> 0;
  });
}

/** For a bar that shows what colours mean, from left to right. */
export function gradientOf(name: ColorMapName): string {
  return `linear-gradient(to right, ${mapNamed(name)
    .stops.map(([r, g, b]) => `rgb(${r}, ${g}, ${b})`)
    .join(", ")})`;
}
