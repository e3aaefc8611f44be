# SPDX-License-Identifier: Apache-2.0
"""Prints a line for each contour file, read without kontur: planes, contours, holes, points, sum of the coordinates."""

import json
import sys
from math import fsum

for name in sys.argv[1:]:
    with open(name) as file:
        planes = json.load(file)["planes"]
    contours = [contour for plane in planes for contour in plane["contours"]]
    points = [point for contour in contours for point in contour["points"]]
    total = fsum(value for point in points for value in point)
    print(len(planes), len(contours), sum(contour["hole"] for contour in contours), len(points), repr(total))
