# SPDX-License-Identifier: Apache-2.0
"""How fast masks of others come right, plane by plane, by a simulated corrector: the plane with the largest wrong area is
redrawn as the truth has it. Beside `kontur.correct`: slices replaced, and changes of slices blended to their neighbours.

python3 bench/correct.py MASKS [-o results.csv] [--planes N] [--only PART] [--methods a,b] [--drop-loose]
       [--steps | --suggest]
MASKS: a folder with one folder for each mask, with mask.nii.gz, truth.nii.gz and, if there is one, image.nii.gz.
Methods: slices, blended, axial, free (13 directions), image (axial, with the image where there is one).
--drop-loose: the corrector takes away pieces that hang loose, as kontur offers.
--suggest: wrong area in the plane that `kontur.suggest_to_look_at` names, over that of the worst parallel one; then the same
of a random parallel plane through the object, and of that with the largest section.
--steps: how many voxels change where an outline moves by 0.1 mm, how many it sweeps itself, how far from the drawn planes, and
none where it repeats the mask.
"""
import argparse
import csv
import pathlib
import statistics

import numpy as np
from scipy import ndimage

import kontur

BLEND_MM = 10
CARRIED = 4 / 3 ** .5  # lengths of g's kernel: what a change in a plane is of that on both sides of it, all in all
DIRECTIONS = [np.array(d, float) for d in (
    (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1), (1, 1, 1),
    (1, 1, -1), (1, -1, 1), (-1, 1, 1))]


class Case:
    """A mask and its truth."""

    def __init__(self, folder):
        self.name = folder.name
        self.mask = kontur.read_mask(folder / "mask.nii.gz")
        self.truth = kontur.read_mask(folder / "truth.nii.gz")
        self.image = folder / "image.nii.gz"
        self.image = kontur.read_image(self.image) if self.image.exists() else None
        self.grid = self.mask.grid
        self.m = np.asarray(self.mask.values) != 0
        self.t = np.asarray(self.truth.values) != 0
        self.spacing = np.asarray(self.grid.spacing_mm)  # x, y, z

    def slice_plane(self, k):
        step = np.asarray(self.grid.index_to_mm)[:3, :3]
        u = step[:, 0] / np.linalg.norm(step[:, 0])
        normal = np.cross(u, step[:, 1])
        return kontur.Plane(self.point((0, 0, k)), normal / np.linalg.norm(normal))

    def point(self, index):
        return (np.asarray(self.grid.index_to_mm) @ [*index, 1])[:3]


def dice(a, b):
    return 2 * (a & b).sum() / max(1, a.sum() + b.sum())


def worst_slice(case, now, done):
    wrong = (now != case.t).sum((1, 2)).astype(float)
    wrong[list(done)] = -1
    return int(wrong.argmax())


def worst_plane(case, now, done):
    """The plane of 13 directions, as thick as the largest voxel side, with most wrong voxels."""
    k, j, i = np.nonzero(now != case.t)
    if not len(i):
        return None
    p = np.stack([i, j, k, np.ones_like(i)]).astype(float)
    p = (np.asarray(case.grid.index_to_mm) @ p)[:3].T
    width, best = case.spacing.max(), (0, None)
    for normal in DIRECTIONS:
        normal = normal / np.linalg.norm(normal)
        x = p @ normal
        counts, edges = np.histogram(x, bins=np.arange(x.min() - width, x.max() + 2 * width, width))
        for plane in done:
            if abs(np.asarray(plane.normal) @ normal) > 0.999:
                counts[np.abs((edges[:-1] + edges[1:]) / 2 - np.asarray(plane.origin) @ normal) < 0.8 * width] = 0
        n = counts.argmax()
        if counts[n] > best[0]:
            there = (x >= edges[n]) & (x < edges[n + 1])
            best = (counts[n], kontur.Plane(p.mean(0) + (x[there].mean() - p.mean(0) @ normal) * normal, normal))
    return best[1]


def corrections(case, planes):
    drawn = kontur.trace(case.truth, planes)
    empty = [p for p in planes if not len(kontur.trace(case.truth, [p]).contours)]
    return kontur.ContourSet(drawn.contours, empty_planes=empty)


def by_kontur(case, planes, drawn=None, **options):
    drawn = drawn or corrections(case, planes)
    return np.asarray(kontur.correct(case.mask, drawn, **options).mask.values) != 0


def slices_replaced(case, ks):
    now = case.m.copy()
    now[ks] = case.t[ks]
    return now


def depth(mask, spacing):
    inside = ndimage.distance_transform_edt(mask, sampling=spacing)
    outside = ndimage.distance_transform_edt(~mask, sampling=spacing)
    half = min(spacing) / 2
    return np.where(mask, inside - half, half - outside)


def blended(case, ks):
    """The change of a slice's signed distance fades linearly to BLEND_MM away, or to the next corrected slice."""
    now, sampling, gap = slices_replaced(case, ks), case.spacing[1::-1], case.spacing[2]
    body = depth(case.m, case.spacing[::-1])
    old = lambda k: depth(case.m[k], sampling) if case.m[k].any() else np.minimum(body[k], -min(sampling) / 2)
    changes = {}
    for k in ks:
        if case.t[k].any():
            changes[k] = depth(case.t[k], sampling) - old(k)
        elif case.m[k].any():
            changes[k] = -np.maximum(np.abs(old(k)), min(sampling)) - old(k)
    for k in range(len(now)):
        if k in ks:
            continue
        below, above = [c for c in ks if c < k][-1:], [c for c in ks if c > k][:1]
        reach = min(BLEND_MM / gap, above[0] - below[0] if below and above else np.inf)
        change = sum(max(0, 1 - abs(k - c) / reach) * changes.get(c, 0) for c in below + above)
        if np.any(change):
            now[k] = np.where(np.abs(change) > 0.02 * min(sampling), old(k) + change > 0, now[k])
    return now


def run(case, method, planes, options):
    """One row for each number of planes."""
    now, done, rows = case.m, [], []
    for count in range(planes + 1):
        right = case.m == case.t
        rows.append({"mask": case.name, "method": method, "planes": count, "dice": round(float(dice(now, case.t)), 5),
                     "harmed": round(float((right & (now != case.t)).sum() / case.t.sum()), 5)})
        if count == planes:
            return rows
        if method == "free":
            plane = worst_plane(case, now, done)
            if plane is not None:
                done.append(plane)
                now = by_kontur(case, done, **options)
            continue
        done.append(worst_slice(case, now, done))
        now = {"slices": lambda: slices_replaced(case, sorted(done)), "blended": lambda: blended(case, sorted(done)),
               "axial": lambda: by_kontur(case, [case.slice_plane(k) for k in done], **options),
               "image": lambda: by_kontur(case, [case.slice_plane(k) for k in done], image=case.image, **options)}[method]()


def steps(case):
    """Of a mask: the largest share of its voxels that change when its first outline grows by 0.1 mm, ten times over; what share
    that outline sweeps, carried on; the farthest change from three drawn planes, in reaches; and whether outlines that repeat the
    mask change nothing."""
    planes = [case.slice_plane(worst_slice(case, case.m, []))]
    drawn = corrections(case, planes)
    last, largest = None, 0
    for tenth in range(11 if len(drawn.contours) else 0):
        now = by_kontur(case, planes, drawn=moved(drawn, 0.1 * tenth))
        largest = max(largest, 0 if last is None else (now != last).sum() / case.m.sum())
        last = now
    carried_mm = CARRIED * kontur.correct(case.mask, drawn).report.length_mm if len(drawn.contours) else 0
    swept = 0.1 * sum(map(length_mm, drawn.contours)) * carried_mm / (case.m.sum() * case.grid.voxel_volume_mm3)
    done = []
    for _ in range(3):
        done.append(worst_slice(case, case.m, done))
    planes = [case.slice_plane(k) for k in done]
    corrected = kontur.correct(case.mask, corrections(case, planes))
    k, j, i = np.nonzero((np.asarray(corrected.mask.values) != 0) != case.m)
    at = (np.asarray(case.grid.index_to_mm) @ np.stack([i, j, k, np.ones_like(i)]).astype(float))[:3].T
    away = np.min([np.abs((at - plane.origin) @ np.asarray(plane.normal)) for plane in planes], axis=0)
    same = by_kontur(case, planes, drawn=kontur.trace(case.mask, planes))
    return {"mask": case.name, "largest_step": round(float(largest), 5), "swept": round(float(swept), 5),
            "farthest": round(float(away.max() / corrected.report.reach_mm), 3), "repeated": int((same != case.m).sum())}


def length_mm(contour):
    points = np.asarray(contour.points)
    return np.linalg.norm(np.roll(points, 1, axis=0) - points, axis=1).sum()


def moved(drawn, mm):
    """Outlines whose points all lie `mm` farther from their middle."""
    contours = []
    for contour in drawn.contours:
        points = np.asarray(contour.points)
        out = points - points.mean(0)
        out = points + mm * out / np.linalg.norm(out, axis=1, keepdims=True)
        contours.append(kontur.Contour(out, plane=contour.plane))
    return kontur.ContourSet(contours)


def suggested(case, among):
    """Of a mask with an image: wrong voxels in the plane to look at, in a random one and in that with most voxels of the mask;
    each over those of the worst plane. All are parallel, and as thick as the largest voxel side."""
    [found] = kontur.suggest_to_look_at(case.mask, case.image, among=among)
    normal, width = np.asarray(found.plane.normal), case.spacing.max()
    if found.slice:
        normal, width = np.asarray(found.plane.normal), case.spacing[found.slice[0]]
    offset = np.asarray(found.plane.origin) @ normal
    k, j, i = np.nonzero(case.m | case.t)
    at = (np.asarray(case.grid.index_to_mm) @ np.stack([i, j, k, np.ones_like(i)]).astype(float))[:3].T @ normal
    layer = np.round((at - offset) / width).astype(int)
    first = layer.min()
    wrong = np.bincount(layer - first, weights=(case.m != case.t)[k, j, i])
    inside = np.bincount(layer - first, weights=case.m[k, j, i])
    worst = wrong.max()
    there = -first if 0 <= -first < len(wrong) else 0
    return wrong[there] / worst, wrong[inside > 0].mean() / worst, wrong[inside.argmax()] / worst


def planes_to(rows, method, dice):
    """Means over the masks that begin below `dice` and get there by slices replaced, and how many these are."""
    first = {}
    for row in rows:
        if row["dice"] >= dice:
            first.setdefault((row["method"], row["mask"]), row["planes"])
    masks = [m for m in {r["mask"] for r in rows} if first.get(("slices", m), 0) > 0]
    reached = [first.get((method, m)) for m in masks]
    return statistics.fmean(reached) if masks and None not in reached else None, len(masks)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("masks", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    parser.add_argument("--planes", type=int, default=5)
    parser.add_argument("--only", default="")
    parser.add_argument("--methods", default="slices,blended,axial,free")
    parser.add_argument("--reach", type=float, default=1)
    parser.add_argument("--drop-loose", action="store_true")
    parser.add_argument("--steps", action="store_true")
    parser.add_argument("--suggest", action="store_true")
    given = parser.parse_args()
    folders = sorted(p for p in given.masks.iterdir() if (p / "mask.nii.gz").exists() and given.only in p.name)
    if given.suggest:
        for among in ("image-slices", "any"):
            rows = []
            for case in map(Case, folders):
                if case.image:
                    rows.append(suggested(case, among))
                    print(f"{case.name:36} {among:12}", *(f"{share:.2f}" for share in rows[-1]))
            print(f"{'mean':36} {among:12}", *(f"{m:.3f}" for m in np.mean(rows, axis=0)),
                  f" better than random: {sum(a > b for a, b, _ in rows)} of {len(rows)}")
        return
    if given.steps:
        for folder in folders:
            print(*steps(Case(folder)).values(), flush=True)
        return
    rows = []
    for folder in folders:
        case = Case(folder)
        for method in given.methods.split(","):
            some = run(case, method, given.planes, {"reach": given.reach, "drop_loose": given.drop_loose})
            rows += some
            print(f"{case.name:36} {method:8}", *(f"{r['dice']:.3f}" for r in some),
                  f"  harmed {some[min(3, given.planes)]['harmed']:.3f}", flush=True)
    for method in given.methods.split(","):
        means = [statistics.fmean(r["dice"] for r in rows if r["method"] == method and r["planes"] == n)
                 for n in range(given.planes + 1)]
        harmed = statistics.fmean(r["harmed"] for r in rows if r["method"] == method and r["planes"] == min(3, given.planes))
        print(f"{'mean':36} {method:8}", *(f"{m:.4f}" for m in means), f" harmed {harmed:.4f}")
        for dice_ in (0.95, 0.98):
            mean, masks = planes_to(rows, method, dice_)
            print(f"{'':36} {method:8} planes to {dice_}: {mean or float('nan'):.2f}, {masks} masks")
    if given.output:
        with given.output.open("w", newline="", encoding="utf-8") as out:
            writer = csv.DictWriter(out, ["mask", "method", "planes", "dice", "harmed"])
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
