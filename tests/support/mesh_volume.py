# SPDX-License-Identifier: Apache-2.0
"""mesh_volume.py MESH: reads kontur's STL, PLY or OBJ by the formats' definitions alone; prints the number of triangles, the
enclosed volume and the smallest cosine between a stored normal and its triangle's own."""

import sys

import numpy as np


def read_stl(data):
    facets = np.frombuffer(data[84:], np.dtype([("n", "<3f4"), ("p", "<9f4"), ("a", "<u2")]))
    assert len(facets) == int.from_bytes(data[80:84], "little")
    return facets["p"].reshape(-1, 3, 3).astype(float), np.repeat(facets["n"][:, None, :], 3, axis=1)


def read_ply(data):
    header, body = data.split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in header.splitlines() if line.startswith(b"element")]
    points = np.frombuffer(body, np.dtype([("p", "<3f8"), ("n", "<3f4")]), counts[0])
    faces = np.frombuffer(body[points.nbytes :], np.dtype([("count", "u1"), ("i", "<3u4")]))
    assert len(faces) == counts[1] and (faces["count"] == 3).all()
    return points["p"][faces["i"]], points["n"][faces["i"]]


def read_obj(data):
    rows = [line.split() for line in data.decode().splitlines()]
    points, normals = (np.array([row[1:] for row in rows if row[0] == key], float) for key in ("v", "vn"))
    corners = np.array([[word.split("//") for word in row[1:]] for row in rows if row[0] == "f"], int) - 1
    return points[corners[:, :, 0]], normals[corners[:, :, 1]]


readers = {"stl": read_stl, "ply": read_ply, "obj": read_obj}
triangles, normals = readers[sys.argv[1][-3:]](open(sys.argv[1], "rb").read())
own = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
shifted = triangles - triangles.mean(axis=(0, 1))
volume = np.einsum("ij,ij->", shifted[:, 0], np.cross(shifted[:, 1], shifted[:, 2])) / 6
own /= np.linalg.norm(own, axis=1, keepdims=True)
print(len(triangles), volume, np.einsum("tcj,tj->tc", normals, own).min())
