# SPDX-License-Identifier: Apache-2.0
"""From contours to a figure: the phantom's kidney from six contours, on a slice of its CT, and how far it is from the truth.

Usage: kidney_figure.py FIGURE.png [needs matplotlib]
"""
import sys

import kontur
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

case = kontur.phantom_case("kidney_radial6_hand")
image = kontur.make_phantom_image(case.grid)
kidney = kontur.segment(case.contours, case.grid, mesh=True)
truth = kontur.make_truth_mask(case.body, case.grid)
agreement = kontur.compare(kidney.mask, truth)

# The slice through the middle of the contours, as the radiologist sees it: patient's right on the left, front on top.
centre = case.contours.bounding_box.mean(axis=0)
plane = kontur.Plane(centre, [0, 0, 1], u=[1, 0, 0], v=[0, 1, 0])
pixels, half_mm = 300, 50
slice_hu = kontur.reslice(image, plane, pixels, pixels, 2 * half_mm / pixels, outside=-1000)
extent = (-half_mm, half_mm, half_mm, -half_mm)

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.5))
level, width = kontur.suggest_window(image)
left.imshow(slice_hu, cmap="gray", vmin=level - width / 2, vmax=level + width / 2, extent=extent)
for points, closed in kontur.outline(kidney.mesh, plane):
    line = plane.to_uv(np.concatenate([points, points[:1]]) if closed else points)
    left.plot(line[:, 0], line[:, 1], color="tab:orange")
for contour in case.contours:
    marks = plane.to_uv(kontur.crossings(contour, plane))
    left.plot(marks[:, 0], marks[:, 1], "o", color="tab:blue", markersize=4)
left.set(title=f"Kidney from {len(case.contours)} contours, Dice {agreement.dice:.3f}", xlabel="mm", ylabel="mm")

depth = -case.body.values(kidney.mesh.points)
right.hist(depth, bins=60, color="tab:orange")
right.set(title=f"Surface: {agreement.surface.mean_surface_distance_mm:.2f} mm from the truth on average",
          xlabel="outside of the true surface (mm)", ylabel="points of the mesh")
figure.tight_layout()
figure.savefig(sys.argv[1], dpi=120)
print(f"{sys.argv[1]}: {kidney.report.mask_volume_ml:.1f} ml, Dice {agreement.dice:.4f}")
