# SPDX-License-Identifier: Apache-2.0
"""mesh_volume.py MESH: reads kontur's STL, PLY, OBJ, VTK or VTP by the formats' definitions alone; prints the number of triangles, the
enclosed volume and the smallest cosine between a stored normal and its triangle's own."""

import base64
import re
import sys
import xml.etree.ElementTree

import numpy as np


def read_stl(data):
    facets = np.frombuffer(data[84:], np.dtype([("n", "<3f4"), ("p", "<9f4"), ("a", "<u2")]))
    assert len(facets) == int.from_bytes(data[80:84], "little")
    return facets["p"].reshape(-1, 3, 3).astype(float), np.repeat(facets["n"][:, None, :], 3, axis=1)


PLY_TYPES = {"double": "<f8", "float": "<f4", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4"}


def read_ply(data):
    """Of every face and point all properties that the header names, whatever they are. Without normals those of the triangles."""
    header, body = data.split(b"end_header\n", 1)
    tables = []
    for line in header.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            tables.append((int(words[2]), []))
        elif words[0] == "property" and words[1] == "list":
            tables[-1][1].extend([("count", PLY_TYPES[words[2]]), (words[4], "3" + PLY_TYPES[words[3]])])
        elif words[0] == "property":
            tables[-1][1].append((words[2], PLY_TYPES[words[1]]))
    (points_count, of_points), (faces_count, of_faces) = tables[:2]
    points = np.frombuffer(body, np.dtype(of_points), points_count)
    faces = np.frombuffer(body[points.nbytes :], np.dtype(of_faces), faces_count)
    assert (faces["count"] == 3).all()
    corners = next(faces[name] for name, kind in of_faces if kind.startswith("3"))
    place = np.stack([points[name] for name in "xyz"], 1).astype(float)[corners]
    if "nx" not in points.dtype.names:
        return place, np.repeat(np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0])[:, None], 3, axis=1)
    return place, np.stack([points[name] for name in ("nx", "ny", "nz")], 1).astype(float)[corners]


def read_obj(data):
    rows = [line.split() for line in data.decode().splitlines()]
    points, normals = (np.array([row[1:] for row in rows if row[0] == key], float) for key in ("v", "vn"))
    corners = np.array([[word.split("//") for word in row[1:]] for row in rows if row[0] == "f"], int) - 1
    return points[corners[:, :, 0]], normals[corners[:, :, 1]]


def read_vtk(data):
    parts = re.fullmatch(rb"# vtk DataFile Version 3\.0\n[^\n]{1,255}\nBINARY\nDATASET POLYDATA\nPOINTS (\d+) double\n(.*)", data, re.DOTALL)
    count, body = int(parts[1]), parts[2]
    points = np.frombuffer(body, ">f8", 3 * count).reshape(-1, 3)
    cells = re.match(rb"\nPOLYGONS (\d+) (\d+)\n", body[points.nbytes :])
    faces = np.frombuffer(body, ">i4", int(cells[2]), points.nbytes + cells.end()).reshape(-1, 4)
    assert len(faces) == int(cells[1]) and (faces[:, 0] == 3).all()
    tail = body[points.nbytes + cells.end() + faces.nbytes :]
    head = b"\nPOINT_DATA %d\nNORMALS normals float\n" % count
    assert tail.startswith(head) and len(tail) == len(head) + 12 * count
    normals = np.frombuffer(tail[len(head) :], ">f4").reshape(-1, 3)
    return points[faces[:, 1:]], normals[faces[:, 1:]]


def read_vtp(data):
    root = xml.etree.ElementTree.fromstring(data)
    assert root.attrib == {"type": "PolyData", "version": "1.0", "byte_order": "LittleEndian", "header_type": "UInt64"}
    [space] = root.findall("PolyData/FieldData/DataArray[@Name='SPACE']")
    assert bytes(map(int, space.text.split())) == b"LPS\0"
    piece = root.find("PolyData/Piece")

    def array(place, kind):
        [element] = piece.findall(place)
        content = base64.b64decode(element.text, validate=True)
        assert element.get("format") == "binary" and element.get("type") == kind[1]
        assert int.from_bytes(content[:8], "little") == len(content) - 8
        return np.frombuffer(content[8:], kind[0])

    points = array("Points/DataArray", ("<f8", "Float64")).reshape(-1, 3)
    normals = array("PointData/DataArray", ("<f4", "Float32")).reshape(-1, 3)
    corners = array("Polys/DataArray[@Name='connectivity']", ("<i8", "Int64"))
    ends = array("Polys/DataArray[@Name='offsets']", ("<i8", "Int64"))
    assert (len(points), len(ends)) == (int(piece.get("NumberOfPoints")), int(piece.get("NumberOfPolys")))
    np.testing.assert_array_equal(ends, np.arange(3, len(corners) + 1, 3))
    return points[corners.reshape(-1, 3)], normals[corners.reshape(-1, 3)]


readers = {"vtk": read_vtk, "vtp": read_vtp, "stl": read_stl, "ply": read_ply, "obj": read_obj}
triangles, normals = readers[sys.argv[1][-3:]](open(sys.argv[1], "rb").read())
own = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
shifted = triangles - triangles.mean(axis=(0, 1))
volume = np.einsum("ij,ij->", shifted[:, 0], np.cross(shifted[:, 1], shifted[:, 2])) / 6
own /= np.linalg.norm(own, axis=1, keepdims=True)
print(len(triangles), volume, np.einsum("tcj,tj->tc", normals, own).min())
