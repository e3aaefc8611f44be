# SPDX-License-Identifier: Apache-2.0
"""make_vtk.py FOLDER: writes the same lines in every way that VTK's two formats of polygonal data know, by the formats' definitions
alone. A pentagon on z = 1 as one closed line; a square on z = 4 as four single edges, in any order and direction; an open line on
z = 7. Files whose name begins with ras say so and are turned."""
import base64
import pathlib
import sys
import zlib

import numpy as np

PENTAGON = [[0, 0, 1], [10, 0, 1], [12, 6, 1], [5, 9.5, 1], [-1, 5, 1]]
SQUARE = [[0, 0, 4], [8, 0, 4], [8, 8, 4], [0, 8, 4]]
OPEN = [[1, 1, 7], [2, 3, 7], [5, 3.25, 7]]
POINTS = np.array(PENTAGON + SQUARE + OPEN, float)
LINES = [[0, 1, 2, 3, 4, 0], [5, 6], [8, 7], [5, 8], [6, 7], [9, 10, 11]]


def legacy(binary, version, title="made by hand SPACE=LPS", points=POINTS):
    """VTK's first format: version 3 with counted cells, version 5.1 with offsets."""

    def numbers(values, kind):
        values = np.asarray(values)
        return values.astype(">" + kind).tobytes() + b"\n" if binary else " ".join(map(str, values.ravel())).encode() + b"\n"

    def text(line):
        return line.encode() + b"\n"

    out = text(f"# vtk DataFile Version {version}") + text(title) + text("BINARY" if binary else "ASCII") + text("DATASET POLYDATA")
    if version == "5.1":
        out += text("FIELD FieldData 1") + text("TimeValue 1 1 double") + numbers([0.5], "f8")
    out += text(f"POINTS {len(points)} float") + numbers(points, "f4")
    if version == "5.1":
        out += text("METADATA") + text("INFORMATION 0") + text("")
        ends = np.cumsum([0] + [len(line) for line in LINES])
        out += text(f"LINES {len(ends)} {ends[-1]}") + text("OFFSETS vtktypeint64") + numbers(ends, "i8")
        out += text("CONNECTIVITY vtktypeint64") + numbers(sum(LINES, []), "i8")
    else:
        out += text("VERTICES 1 2") + numbers([1, 0], "i4")
        out += text(f"LINES {len(LINES)} {sum(len(line) + 1 for line in LINES)}")
        out += numbers(sum(([len(line)] + line for line in LINES), []), "i4")
    return out + text("POINT_DATA 12") + text("SCALARS s float 1") + text("LOOKUP_TABLE default") + numbers([0] * 12, "f4")


KINDS = {"f4": "Float32", "f8": "Float64", "i4": "Int32", "i8": "Int64"}


class Xml:
    """VTK's second format: `place` ascii, binary (base64), raw or base64 (appended)."""

    def __init__(self, place, packed=False, wide=False, order="<", pieces=1, space="LPS"):
        self.place, self.packed, self.order, self.count = place, packed, order, order + ("u8" if wide else "u4")
        self.appended = b""
        attributes = {"type": "PolyData", "version": "1.0", "byte_order": "LittleEndian" if order == "<" else "BigEndian",
                      "header_type": "UInt64" if wide else "UInt32"}
        if packed:
            attributes["compressor"] = "vtkZLibDataCompressor"
        body = "".join(self.piece(points, lines) for points, lines in parts(pieces))
        head = "".join(f" {key}=\"{value}\"" for key, value in attributes.items())
        field = f"<FieldData><Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">{codes(space)}</Array></FieldData>"
        text = f"<?xml version=\"1.0\"?>\n<!-- a > b -->\n<VTKFile{head}>\n<PolyData>\n{field if space else ''}{body}</PolyData>\n"
        self.content = text.encode()
        if place in ("raw", "base64"):
            self.content += f"<AppendedData encoding=\"{place}\">\n _".encode() + self.appended + b"\n</AppendedData>\n"
        self.content += b"</VTKFile>\n"

    def piece(self, points, lines):
        ends = np.cumsum([len(line) for line in lines])
        arrays = self.array(points, "f4", "Points", 3)
        cells = self.array(sum(lines, []), "i4", "connectivity") + self.array(ends, "i8", "offsets")
        return (f"<Piece NumberOfPoints='{len(points)}' NumberOfLines='{len(lines)}' NumberOfPolys='0'>\n<PointData></PointData>\n"
                f"<Points>{arrays}</Points>\n<Lines>{cells}</Lines>\n<Polys/>\n</Piece>\n")

    def array(self, values, kind, name, components=1):
        values = np.asarray(values)
        head = f"<DataArray type=\"{KINDS[kind]}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format="
        if self.place == "ascii":
            return head + f"\"ascii\">\n{' '.join(map(str, values.ravel()))}\n</DataArray>\n"
        content = self.stored(values.astype(self.order + kind).tobytes(), text=self.place != "raw")
        if self.place == "binary":
            return head + f"\"binary\">\n  {content.decode()}\n</DataArray>\n"
        self.appended += content
        return head + f"\"appended\" offset=\"{len(self.appended) - len(content)}\"/>\n"

    def stored(self, content, text):
        encode = base64.b64encode if text else bytes
        if not self.packed:
            return encode(np.array([len(content)], self.count).tobytes() + content)
        size = 16  # of a block, far smaller than VTK's own
        blocks = [zlib.compress(content[at : at + size]) for at in range(0, len(content), size)]
        head = np.array([len(blocks), size, len(content) % size, *map(len, blocks)], self.count)
        return encode(head.tobytes()) + encode(b"".join(blocks))


def codes(text):
    return " ".join(str(ord(c)) for c in text + "\0")


def parts(count):
    """All in one piece, or the open line in a piece of its own."""
    if count == 1:
        return [(POINTS, LINES)]
    return [(POINTS[:9], LINES[:-1]), (POINTS[9:], [[0, 1, 2]])]


def main():
    folder = pathlib.Path(sys.argv[1])
    files = {
        "text.vtk": legacy(False, "3.0"), "binary.vtk": legacy(True, "3.0"),
        "text5.vtk": legacy(False, "5.1"), "binary5.vtk": legacy(True, "5.1"),
        "ras.vtk": legacy(False, "4.2", "3D Slicer output. SPACE=RAS", POINTS * [-1, -1, 1]),
        "unsaid.vtk": legacy(True, "4.2", "vtk output"), "windows.vtk": legacy(False, "3.0").replace(b"\n", b"\r\n"),
        "ascii.vtp": Xml("ascii").content, "binary.vtp": Xml("binary").content, "wide.vtp": Xml("binary", wide=True).content,
        "packed.vtp": Xml("binary", packed=True).content, "packed_wide.vtp": Xml("binary", packed=True, wide=True).content,
        "raw.vtp": Xml("raw").content, "raw_packed.vtp": Xml("raw", packed=True, wide=True).content,
        "appended.vtp": Xml("base64").content, "appended_packed.vtp": Xml("base64", packed=True).content,
        "big.vtp": Xml("raw", order=">").content, "pieces.vtp": Xml("ascii", pieces=2).content,
        "unsaid.vtp": Xml("ascii", space="").content,
    }
    for name, content in files.items():
        (folder / name).write_bytes(content)


if __name__ == "__main__":
    main()
