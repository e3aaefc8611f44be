// SPDX-License-Identifier: Apache-2.0
import * as THREE from "three";
import { isSoftwareRenderer } from "./pace";

export type SurfaceMaterial = THREE.MeshStandardMaterial | THREE.MeshLambertMaterial;

/** What things in space are made of. Kept: with the last one of its kind a shader goes, and compiling it anew takes longer than a frame. */
export class Materials {
  private readonly kept = new Map<string, THREE.Material>();
  private readonly lines = new Map<THREE.Material, number>(); // with their opacity

  /** Without a graphics processor each pixel costs: surfaces do not shine then, and what is no glass has no inside. */
  constructor(private readonly isSoftware: boolean) {}

  /** Of one structure; not kept. */
  surface(): SurfaceMaterial {
    const options = { polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 8 }; // contours lie on the surface and must win
    if (this.isSoftware) return new THREE.MeshLambertMaterial(options);
    return new THREE.MeshStandardMaterial({ ...options, side: THREE.DoubleSide, roughness: 0.62, metalness: 0 });
  }

  /** One colour, or those of the points. */
  look(material: SurfaceMaterial, color: string, opacity: number, hasColors: boolean): void {
    const side = this.isSoftware && opacity >= 1 ? THREE.FrontSide : THREE.DoubleSide;
    if (material.vertexColors !== hasColors || material.side !== side) material.needsUpdate = true;
    material.color.set(hasColors ? "#ffffff" : color);
    Object.assign(material, { side, opacity, vertexColors: hasColors, transparent: opacity < 1, depthWrite: opacity >= 1 });
  }

  line(color: string, opacity: number): THREE.LineBasicMaterial {
    const made = this.keep(`line ${color} ${opacity}`, () => new THREE.LineBasicMaterial({ color, transparent: true, opacity }));
    this.lines.set(made, opacity);
    return made;
  }

  /** A line is as wide as a pixel, whatever that is worth: in larger ones it is seen as well with less of its colour. */
  drawOn(share: number): void {
    for (const [line, opacity] of this.lines) line.opacity = opacity * share;
  }

  glass(color: string): THREE.MeshBasicMaterial {
    const options = { color, transparent: true, opacity: 0.035, side: THREE.DoubleSide, depthWrite: false };
    return this.keep(`glass ${color}`, () => new THREE.MeshBasicMaterial(options));
  }

  mark(): THREE.MeshBasicMaterial {
    return this.keep("mark", () => new THREE.MeshBasicMaterial({ color: 0xff8f3f, depthTest: false, transparent: true, opacity: 0.85 }));
  }

  point(color: string, isOnSurface: boolean): THREE.MeshBasicMaterial {
    return this.keep(`point ${color} ${isOnSurface}`, () => new THREE.MeshBasicMaterial({ color, depthTest: isOnSurface, transparent: !isOnSurface }));
  }

  private keep<Kept extends THREE.Material>(key: string, make: () => Kept): Kept {
    if (!this.kept.has(key)) this.kept.set(key, make());
    return this.kept.get(key) as Kept;
  }
}

export function drawsInSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const named = gl?.getExtension("WEBGL_debug_renderer_info");
  const renderer = String(gl?.getParameter(named?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return isSoftwareRenderer(renderer);
}
