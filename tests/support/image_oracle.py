# SPDX-License-Identifier: Apache-2.0
"""Independent reader and writer of image files: nibabel for NIfTI and MGH, small ones of its own for NRRD, MetaImage and GIPL.

    image_oracle.py check FOLDER        every FILE.expect in FOLDER must describe what is found in FILE
    image_oracle.py make-nifti FOLDER   writes files and their FILE.expect (likewise make-nrrd, make-metaimage,
                                        make-pairs, make-mgh, make-gipl)

An .expect file holds the size, the 3 x 4 matrix from index to mm (LPS) by rows, the tolerance in mm and all voxels, i fastest.
"""
import bz2
import gzip
import itertools
import pathlib
import struct
import sys
import zlib

import numpy as np

RAS = np.diag([-1.0, -1.0, 1.0, 1.0])


def read_nifti(path):
    import nibabel

    image = nibabel.load(path)
    header = image.header
    qform, qcode = header.get_qform(coded=True)
    if qcode > 0:
        distance = corner_distance(image.shape, qform, header.get_sform())
        assert distance < 0.02, f"qform and sform differ by {distance} mm"
    assert header.get_xyzt_units()[0] == "mm"
    assert header["descrip"].item().startswith(b"kontur ")
    return RAS @ image.affine, np.asanyarray(image.dataobj)


NRRD_TYPES = {"uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "float": "f4"}


def read_nrrd(path):
    head, _, body = path.read_bytes().partition(b"\n\n")
    lines = head.decode("ascii").split("\n")
    assert lines[0].startswith("NRRD000"), lines[0]
    fields = dict(line.split(": ", 1) for line in lines[1:] if ": " in line and not line.startswith("#"))
    assert fields["space"] == "left-posterior-superior" and fields["dimension"] == "3", fields
    vectors = [list(map(float, v.strip("()").split(","))) for v in fields["space directions"].split()]
    affine = np.eye(4)
    affine[:3, :3] = np.array(vectors).T
    affine[:3, 3] = list(map(float, fields["space origin"].strip("()").split(",")))
    assert fields["endian"] == "little" or fields["type"] == "uint8"
    if fields["encoding"] == "gzip":
        body = gzip.decompress(body)
    if path.name.endswith(".seg.nrrd"):
        check_segments(dict(line.split(":=", 1) for line in lines if ":=" in line), fields, body)
    sizes = tuple(map(int, fields["sizes"].split()))
    return affine, np.frombuffer(body, "<" + NRRD_TYPES[fields["type"]]).reshape(sizes, order="F")


def check_segments(keys, fields, body):
    """The keys that 3D Slicer's documentation asks for, each segment's extent against the voxels."""
    assert keys["Segmentation_MasterRepresentation"] == "Binary labelmap"
    assert keys["Segmentation_ContainedRepresentationNames"] == "Binary labelmap|"
    assert keys["Segmentation_ReferenceImageExtentOffset"] == "0 0 0"
    sizes = tuple(map(int, fields["sizes"].split()))
    values = np.frombuffer(body, "<" + NRRD_TYPES[fields["type"]]).reshape(sizes, order="F")
    labels = [int(keys[f"Segment{n}_LabelValue"]) for n in range(sum(key.endswith("_ID") for key in keys))]
    assert sorted(labels) == sorted(set(values[values != 0].tolist())), labels
    for n, label in enumerate(labels):
        inside = np.argwhere(values == label)
        extent = np.array(keys[f"Segment{n}_Extent"].split(), int).reshape(3, 2)
        np.testing.assert_array_equal(extent, np.stack([inside.min(0), inside.max(0)], 1))
        assert keys[f"Segment{n}_Layer"] == "0" and keys[f"Segment{n}_Name"]
        assert all(0 <= float(part) <= 1 for part in keys[f"Segment{n}_Color"].split())


META_TYPES = {"MET_UCHAR": "u1", "MET_SHORT": "i2", "MET_USHORT": "u2", "MET_INT": "i4", "MET_FLOAT": "f4"}


def read_metaimage(path):
    data = path.read_bytes()
    marker = b"ElementDataFile = LOCAL\n"
    end = data.index(marker) + len(marker)
    fields = dict(line.split(" = ", 1) for line in data[:end].decode("ascii").splitlines())
    spacing = np.array(fields["ElementSpacing"].split(), float)
    # MetaIO stores the direction of axis i, then of j, then of k.
    directions = np.array(fields["TransformMatrix"].split(), float).reshape(3, 3)
    affine = np.eye(4)
    affine[:3, :3] = (directions * spacing[:, None]).T
    affine[:3, 3] = np.array(fields["Offset"].split(), float)
    body = data[end:]
    if fields["CompressedData"] == "True":
        assert int(fields["CompressedDataSize"]) == len(body)
        body = zlib.decompress(body)
    sizes = tuple(map(int, fields["DimSize"].split()))
    return affine, np.frombuffer(body, "<" + META_TYPES[fields["ElementType"]]).reshape(sizes, order="F")


def read_mgh(path):
    import nibabel

    image = nibabel.load(path)
    return RAS @ image.affine, np.asanyarray(image.dataobj)


def read(path):
    if path.name.endswith((".mgh", ".mgz")):
        return read_mgh(path)
    if path.name.endswith((".nii", ".nii.gz")):
        return read_nifti(path)
    return read_nrrd(path) if path.suffix == ".nrrd" else read_metaimage(path)


def corner_distance(shape, a, b):
    corners = [[i * (shape[0] - 1), j * (shape[1] - 1), k * (shape[2] - 1), 1] for i, j, k in itertools.product((0, 1), repeat=3)]
    return np.abs((a - b) @ np.array(corners).T).max()


def check(folder):
    paths = sorted(folder.glob("*.expect"))
    assert paths, "nothing to check"
    for expect in paths:
        numbers = expect.read_text().split()
        size = tuple(map(int, numbers[:3]))
        expected_affine = np.vstack([np.array(numbers[3:15], float).reshape(3, 4), [0, 0, 0, 1]])
        path = expect.with_suffix("")
        affine, values = read(path)
        assert values.shape == size, (path.name, values.shape)
        distance = corner_distance(size, affine, expected_affine)
        assert distance <= float(numbers[15]), (path.name, distance)
        np.testing.assert_array_equal(values.ravel(order="F").astype(float), np.array(numbers[16:], float), path.name)


def write_expectation(path, affine, values, tolerance=1e-6):
    rows = [" ".join(map(str, values.shape))]
    rows += [" ".join(repr(float(x)) for x in row) for row in affine[:3]]
    rows += [repr(tolerance)] + [repr(float(v)) for v in values.ravel(order="F")]
    path.with_name(path.name + ".expect").write_text("\n".join(rows) + "\n")


def some_affines():
    """Orthogonal (both hands), oblique and sheared, index to mm in LPS."""
    rotation, _ = np.linalg.qr(np.random.default_rng(7).normal(size=(3, 3)))
    axes = {
        "axial": np.eye(3),
        "sagittal": np.array([[0, 0, -1], [1, 0, 0], [0, -1, 0.0]]),
        "oblique": rotation,
        "mirrored": rotation @ np.diag([1, 1, -1]),
        "sheared": rotation @ np.array([[1, 0, 0], [0, 1, 0.3], [0, 0, 1]]),
    }
    for name, directions in axes.items():
        affine = np.eye(4)
        affine[:3, :3] = directions * [0.75, 1.25, 3]
        affine[:3, 3] = [-120.5, 33.25, 1700.125]
        yield name, affine


def pattern(dtype, shape=(5, 4, 3)):
    """Values over the type's range that a float holds exactly."""
    count = int(np.prod(shape))
    if np.issubdtype(dtype, np.integer):
        limits = np.iinfo(dtype)
        low, high = max(limits.min, -(2**23)), min(limits.max, 2**23)
        values = np.linspace(low, high, count).round()
    else:
        values = np.linspace(-1000, 1000, count).round(1).astype(np.float32)
    return values.astype(dtype).reshape(shape, order="F")


def make_nifti(folder):
    import nibabel

    def save(name, image, expected_affine, values, tolerance=1e-6):
        path = folder / name
        nibabel.save(image, path)
        write_expectation(path, expected_affine, values, tolerance)

    for code in ("u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"):
        for order in "<>":
            for version, suffix in ((nibabel.Nifti1Image, ".nii"), (nibabel.Nifti2Image, ".nii.gz")):
                values = pattern(np.dtype(code))
                header = version.header_class(endianness=order)
                header.set_data_dtype(np.dtype(order + code))
                image = version(values, np.diag([2.0, 3, 4, 1]), header)
                save(f"{version.__name__}_{code}_{'le' if order == '<' else 'be'}{suffix}", image, RAS @ np.diag([2.0, 3, 4, 1]), values)
    values = pattern(np.dtype("i2"))
    for name, affine in some_affines():
        ras = (RAS @ affine).astype(np.float32).astype(float)
        image = nibabel.Nifti1Image(values, None)
        image.header.set_sform(ras, 1)
        save(f"{name}_sform.nii.gz", image, RAS @ ras, values)
        if name != "sheared":
            image = nibabel.Nifti1Image(values, None)
            image.header.set_qform(ras, 1)
            save(f"{name}_qform.nii", image, RAS @ image.header.get_qform(), values)
    for unit, factor in (("meter", 1000), ("mm", 1), ("micron", 0.001), ("unknown", 1)):
        image = nibabel.Nifti1Image(values, np.diag([2.0, 3, 4, 1]))
        image.header.set_xyzt_units(unit)
        save(f"unit_{unit}.nii", image, RAS @ np.diag([2.0 * factor, 3 * factor, 4 * factor, 1]), values)
    for name, slope, inter in (("ct", 1, -1024), ("integers", 3, -7), ("reals", 0.5, -0.25), ("negative", -2, 0)):
        image = nibabel.Nifti1Image(values, np.diag([2.0, 3, 4, 1]))
        image.header.set_slope_inter(slope, inter)
        scaled = values * float(slope) + inter
        nibabel.save(image, folder / f"scaled_{name}.nii")
        # nibabel divides by the slope when it saves; put the plain numbers back.
        data = bytearray((folder / f"scaled_{name}.nii").read_bytes())
        data[112:120] = np.array([slope, inter], "<f4").tobytes()
        data[352:] = values.astype("<i2").tobytes(order="F")
        (folder / f"scaled_{name}.nii").write_bytes(data)
        write_expectation(folder / f"scaled_{name}.nii", RAS @ np.diag([2.0, 3, 4, 1]), scaled)
    image = nibabel.Nifti1Image(values.reshape(5, 4, 3, 1, 1), np.diag([2.0, 3, 4, 1]))
    save("trailing_axes.nii", image, RAS @ np.diag([2.0, 3, 4, 1]), values)
    image = nibabel.Nifti1Image(values, np.diag([2.0, 3, 4, 1]))
    image.header.extensions.append(nibabel.nifti1.Nifti1Extension("comment", b"text before the voxels"))
    save("extension.nii", image, RAS @ np.diag([2.0, 3, 4, 1]), values)


def nrrd_text(values, affine, encoding, order, space="left-posterior-superior", signs=(1, 1, 1), more=""):
    names = {"u1": "unsigned char", "i1": "signed char", "u2": "ushort", "i2": "short", "u4": "uint", "i4": "int", "u8": "uint64",
             "i8": "long long int", "f4": "float", "f8": "double"}
    turned = np.diag(signs) @ affine[:3]
    vector = lambda v: "(" + ",".join(repr(float(x)) for x in v) + ")"
    lines = ["NRRD0005", "# by the oracle", f"type: {names[values.dtype.str[1:]]}", "dimension: 3", f"space: {space}",
             "sizes: " + " ".join(map(str, values.shape)),
             "space directions: " + " ".join(vector(turned[:, axis]) for axis in range(3)), "kinds: domain domain domain",
             f"encoding: {encoding}", f"space origin: {vector(turned[:, 3])}"]
    if values.dtype.itemsize > 1:
        lines.append("endian: " + ("little" if order == "<" else "big"))
    return "\n".join(lines) + "\n" + more


def stored(values, order):
    return values.astype(values.dtype.newbyteorder(order)).tobytes(order="F")


def ascii_text(values):
    return " ".join(str(v) for v in values.ravel(order="F")).encode() + b"\n"


def make_nrrd(folder):
    affine = np.array([[2.0, 0, 0, -7], [0, 3, 0, 8], [0, 0, 4, 9.5], [0, 0, 0, 1]])
    for code in ("u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"):
        values = pattern(np.dtype(code))
        for order in "<>":
            for encoding, pack in (("raw", bytes), ("gzip", gzip.compress), ("bzip2", bz2.compress)):
                path = folder / f"{code}_{'le' if order == '<' else 'be'}_{encoding}.nrrd"
                path.write_bytes(nrrd_text(values, affine, encoding, order).encode() + b"\n" + pack(stored(values, order)))
                write_expectation(path, affine, values)
        path = folder / f"{code}_text.nrrd"
        path.write_bytes(nrrd_text(values, affine, "ascii", "<").encode() + b"\n" + ascii_text(values))
        write_expectation(path, affine, values)
    values = pattern(np.dtype("i2"))
    for name, oblique in some_affines():
        for space, signs in (("LPS", (1, 1, 1)), ("right-anterior-superior", (-1, -1, 1)), ("LAS", (1, -1, 1))):
            path = folder / f"{name}_{space}.nrrd"
            path.write_bytes(nrrd_text(values, oblique, "raw", "<", space, signs).encode() + b"\n" + stored(values, "<"))
            write_expectation(path, oblique, values)
    scaled = np.diag([0.001, 0.001, 0.001, 1])
    path = folder / "micrometres.nrrd"
    path.write_bytes(nrrd_text(values, affine, "raw", "<", more='space units: "um" "um" "um"\n').encode() + b"\n" + stored(values, "<"))
    write_expectation(path, scaled @ affine, values)
    path = folder / "skips.nrrd"
    text = nrrd_text(values, affine, "raw", "<", more="line skip: 2\nbyte skip: 3\nkey:=value\n")
    path.write_bytes(text.encode() + b"\none line\nanother line\n123" + stored(values, "<"))
    write_expectation(path, affine, values)
    path = folder / "at_the_end.nrrd"
    path.write_bytes(nrrd_text(values, affine, "raw", "<", more="byte skip: -1\n").encode() + b"\nanything" + stored(values, "<"))
    write_expectation(path, affine, values)
    path = folder / "detached.nhdr"
    path.write_bytes(nrrd_text(values, affine, "raw", "<", more="data file: voxels.expect.raw\n").encode())
    (folder / "voxels.expect.raw").write_bytes(stored(values, "<"))
    write_expectation(path, affine, values)
    path = folder / "two_streams.nrrd"
    content = stored(values, "<")
    path.write_bytes(nrrd_text(values, affine, "bz2", "<").encode() + b"\n" + bz2.compress(content[:50]) + bz2.compress(content[50:]))
    write_expectation(path, affine, values)
    path = folder / "windows_lines.nrrd"
    path.write_bytes(nrrd_text(values, affine, "raw", "<").replace("\n", "\r\n").encode() + b"\r\n" + stored(values, "<"))
    write_expectation(path, affine, values)


def metaimage_text(values, affine, order, fields):
    names = {"u1": "UCHAR", "i1": "CHAR", "u2": "USHORT", "i2": "SHORT", "u4": "UINT", "i4": "INT", "u8": "ULONG_LONG",
             "i8": "LONG_LONG", "f4": "FLOAT", "f8": "DOUBLE"}
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    row = lambda numbers: " ".join(repr(float(x)) for x in numbers)
    header = {"ObjectType": "Image", "NDims": "3", "BinaryData": "True", "BinaryDataByteOrderMSB": str(order == ">"),
              "CompressedData": "False", "TransformMatrix": row((affine[:3, :3] / spacing).T.ravel()), "Offset": row(affine[:3, 3]),
              "CenterOfRotation": "0 0 0", "AnatomicalOrientation": "RAI", "ElementSpacing": row(spacing),
              "DimSize": " ".join(map(str, values.shape)), "ElementType": "MET_" + names[values.dtype.str[1:]]}
    header.update(fields)
    header["ElementDataFile"] = header.pop("ElementDataFile", "LOCAL")
    return "".join(f"{key} = {value}\n" for key, value in header.items()).encode()


def make_metaimage(folder):
    affine = np.array([[2.0, 0, 0, -7], [0, 3, 0, 8], [0, 0, 4, 9.5], [0, 0, 0, 1]])

    def save(name, values, affine, order, fields, body):
        path = folder / name
        path.write_bytes(metaimage_text(values, affine, order, fields) + body)
        write_expectation(path, affine, values)

    for code in ("u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"):
        values = pattern(np.dtype(code))
        for order in "<>":
            raw = stored(values, order)
            stem = f"{code}_{'le' if order == '<' else 'be'}"
            save(f"{stem}.mha", values, affine, order, {}, raw)
            packed = zlib.compress(raw)
            size = {"CompressedDataSize": len(packed)} if order == "<" else {}
            save(f"{stem}_packed.mha", values, affine, order, {"CompressedData": "True", **size}, packed)
        save(f"{code}_text.mha", values, affine, "<", {"BinaryData": "False"}, ascii_text(values))
    values = pattern(np.dtype("i2"))
    raw = stored(values, "<")
    for name, oblique in some_affines():
        save(f"{name}.mha", values, oblique, "<", {}, raw)
    save("skip.mha", values, affine, "<", {"HeaderSize": 5}, b"12345" + raw)
    save("at_the_end.mha", values, affine, "<", {"HeaderSize": -1}, b"anything" + raw)
    save("detached.mhd", values, affine, "<", {"ElementDataFile": "voxels.expect.raw"}, b"")
    save("detached.mha", values, affine, "<", {"ElementDataFile": "voxels.expect.raw"}, b"")
    (folder / "voxels.expect.raw").write_bytes(raw)


def make_pairs(folder):
    """NIfTI in two files; the header is what has an expectation, the voxels do where their name is to be read. And Analyze 7.5."""
    import nibabel

    values = pattern(np.dtype("i2"))
    for name, affine in some_affines():
        ras = (RAS @ affine).astype(np.float32).astype(float)
        for version, kind in ((1, nibabel.Nifti1Pair), (2, nibabel.Nifti2Pair)):
            image = kind(values, None)
            image.header.set_sform(ras, 1)
            stem = f"{name}_{version}"
            nibabel.save(image, folder / f"{stem}.img")
            for suffix in (".hdr", ".img"):
                write_expectation(folder / (stem + suffix), RAS @ ras, values)
    for name, suffixes in (("both_packed", (".hdr", ".img")), ("voxels_packed", (".img",))):
        for suffix in (".hdr", ".img"):
            content = (folder / f"axial_1{suffix}").read_bytes()
            packed = suffix in suffixes
            path = folder / (name + suffix + (".gz" if packed else ""))
            path.write_bytes(gzip.compress(content) if packed else content)
            write_expectation(path, dict(some_affines())["axial"], values)
    header = bytearray((folder / "axial_1.hdr").read_bytes())
    struct.pack_into("<f", header, 108, 16.0)
    (folder / "CAPITALS.HDR").write_bytes(header)
    (folder / "CAPITALS.IMG").write_bytes(b"sixteen bytes...".ljust(16) + (folder / "axial_1.img").read_bytes())
    write_expectation(folder / "CAPITALS.HDR", dict(some_affines())["axial"], values)
    (folder / "analyze").mkdir()
    nibabel.save(nibabel.Spm2AnalyzeImage(values, np.diag([2.0, 3, 4, 1])), folder / "analyze" / "a.img")


def make_mgh(folder):
    import nibabel

    for code in ("u1", "i2", "i4", "f4"):
        values = pattern(np.dtype(code))
        for name, affine in some_affines():
            image = nibabel.MGHImage(values, RAS @ affine)
            path = folder / f"{name}_{code}.{'mgz' if code in ('i2', 'f4') else 'mgh'}"
            nibabel.save(image, path)
            loaded = nibabel.load(path)
            write_expectation(path, RAS @ loaded.affine, np.asanyarray(loaded.dataobj), 1e-4)  # nibabel computes with single precision
    values = pattern(np.dtype("i2"))
    image = nibabel.MGHImage(values, RAS @ affine)
    image.header["tr"] = 2.5  # stands behind the voxels
    nibabel.save(image, folder / "scan.mgz")
    write_expectation(folder / "scan.mgz", RAS @ nibabel.load(folder / "scan.mgz").affine, values, 1e-4)
    # What nibabel does not write: samples without a sign, and a header that says nothing of the patient.
    content = bytearray((folder / "axial_u1.mgh").read_bytes()[:284])
    struct.pack_into(">i", content, 20, 10)
    unsigned = pattern(np.dtype("u2"))
    (folder / "unsigned.mgh").write_bytes(content + unsigned.astype(">u2").tobytes(order="F"))
    write_expectation(folder / "unsigned.mgh", RAS @ nibabel.load(folder / "axial_u1.mgh").affine, unsigned, 1e-5)
    struct.pack_into(">h", content, 28, 0)
    struct.pack_into(">i", content, 20, 0)
    (folder / "lost").mkdir()
    path = folder / "lost" / "lost.mgh"
    values = pattern(np.dtype("u1"))
    path.write_bytes(content + values.tobytes(order="F"))
    # As FreeSurfer's setDirectionCosine has it for coronal slices: x to the left, y down, z to the front; nibabel turns y and z.
    coronal = np.array([[-1.0, 0, 0, 2.5], [0, 0, 1, -1.5], [0, -1, 0, 2.0], [0, 0, 0, 1]])
    write_expectation(path, RAS @ coronal, values)


GIPL_TYPES = {"u1": 8, "i1": 7, "i2": 15, "u2": 16, "u4": 31, "i4": 32, "f4": 64, "f8": 65}


def gipl_header(size, kind, spacing, origin, magic=0xEFFFE9B0):
    """By the list of fields in ITK's documentation of the format: all of them big-endian."""
    header = struct.pack(">4H", *size) + struct.pack(">H", kind) + struct.pack(">4f", *spacing) + b"patient".ljust(80, b"\0")
    header += struct.pack(">20f", *([0] * 20)) + bytes(2) + struct.pack(">2d", 0, 0) + struct.pack(">4d", *origin)
    header += struct.pack(">4f", 0, 0, 0, 0) + struct.pack(">I", magic)
    assert len(header) == 256
    return header


def make_gipl(folder):
    affine = np.array([[2.0, 0, 0, -7], [0, 3, 0, 8], [0, 0, 4, 9.5], [0, 0, 0, 1]])
    for code, kind in GIPL_TYPES.items():
        values = pattern(np.dtype(code))
        for magic, frames, suffix in ((0xEFFFE9B0, 0, ".gipl"), (0x2AE389B8, 1, ".gipl.gz")):
            content = gipl_header((5, 4, 3, frames), kind, (2, 3, 4, 0), (-7, 8, 9.5, 0), magic) + stored(values, ">")
            path = folder / f"{code}{suffix}"
            path.write_bytes(gzip.compress(content) if suffix.endswith("gz") else content)
            write_expectation(path, affine, values)


if __name__ == "__main__":
    commands = {"make-pairs": make_pairs, "make-mgh": make_mgh, "make-gipl": make_gipl, "check": check, "make-nifti": make_nifti, "make-nrrd": make_nrrd, "make-metaimage": make_metaimage}
    commands[sys.argv[1]](pathlib.Path(sys.argv[2]))
