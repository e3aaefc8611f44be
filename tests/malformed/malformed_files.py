# SPDX-License-Identifier: Apache-2.0
"""Makes files that are wrong in every way that is known to hurt readers: cut off, with impossible or lying sizes, without
finite geometry, compressed bombs, names that point elsewhere, frames that contradict their file, trees of a million levels.

`cases(folder)` yields a Case for each. All of it is determined by SEED; nothing is downloaded or read from outside.
"""
import dataclasses
import gzip
import io
import json
import math
import pathlib
import random
import re
import struct
import subprocess
import sys
import zlib

import nibabel
import numpy
import pydicom
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence

SEED = 20261122
SUPPORT = pathlib.Path(__file__).resolve().parent.parent / "support"
CUTS = 14  # of each sound file
HUGE = [0, -1, -(2**31), 2**31 - 1, 2**31, 2**32, 2**62, 2**63 - 1]
NUMBERS = ["nan", "-nan", "inf", "-inf", "1e999", "0", "", "x", "1e-320", "--1", "0x10", "1,5"]


@dataclasses.dataclass
class Case:
    name: str
    words: list  # of the command line, run in the case's folder
    refused: bool = True  # else any documented end will do
    declared_mb: float = 0  # payload that the file honestly or not announces and that may be held in memory


class Maker:
    """Puts the files of every `step`-th case into a folder of its own."""

    def __init__(self, folder, step):
        self.folder, self.step, self.made, self.cases = folder, step, 0, []
        self.random = random.Random(SEED)

    def add(self, name, file, content, words=None, refused=True, declared_mb=0, beside=()):
        self.made += 1
        if self.made % self.step:
            return
        name = f"{self.made:04d}_{name}"
        place = self.folder / name
        place.mkdir()
        for other, bytes_ in [(file, content), *beside]:
            (place / other).parent.mkdir(parents=True, exist_ok=True)
            (place / other).write_bytes(bytes_.encode() if isinstance(bytes_, str) else bytes_)
        self.cases.append(Case(name, words or ["inspect", file], refused, declared_mb))

    def cut(self, kind, file, content, words=None, to_the_last=True):
        """Prefixes of all lengths; without the last byte, too, unless the format can do without it."""
        lengths = {0, 1, 3, 131, 132} | {len(content) * n // CUTS for n in range(1, CUTS)}
        if to_the_last:
            lengths.add(len(content) - 1)
        for length in sorted(n for n in lengths if 0 <= n < len(content)):
            self.add(f"{kind}_cut_{length}", file, content[:length], words)

    def flip(self, kind, file, content, count, words=None, limit=None):
        """Copies with one to eight bytes overwritten."""
        for number in range(count):
            mutant = bytearray(content)
            for _ in range(self.random.randint(1, 8)):
                mutant[self.random.randrange(min(limit or len(mutant), len(mutant)))] = self.random.randrange(256)
            self.add(f"{kind}_flipped_{number}", file, bytes(mutant), words, refused=False, declared_mb=64)


# --- NIfTI ---


def nifti_bytes(version=1, shape=(6, 5, 4), dtype=numpy.int16):
    kind = {1: nibabel.Nifti1Image, 2: nibabel.Nifti2Image}[version]
    image = kind(numpy.arange(math.prod(shape)).reshape(shape).astype(dtype), numpy.diag([2.0, 2, 3, 1]))
    image.header.set_qform(image.affine, 1)
    return image.to_bytes()


def patched(content, offset, form, *values):
    content = bytearray(content)
    struct.pack_into(form, content, offset, *values)
    return bytes(content)


def zeros_gz(count):
    """So many zeros as gzip members of 4 MB."""
    return gzip.compress(bytes(1 << 22), mtime=0) * (count >> 22)


def make_nifti(make):
    one, two = nifti_bytes(1), nifti_bytes(2)
    make.cut("nifti1", "a.nii", one)
    make.cut("nifti2", "a.nii", two)
    make.cut("nifti_gz", "a.nii.gz", gzip.compress(one, mtime=0))
    for axis in (1, 2, 3):
        for size in (0, -1, -32768, 32767):
            content = patched(one, 40 + 2 * axis, "<h", size)
            make.add(f"nifti_size_{axis}_{size}", "a.nii", content)
            make.add(f"nifti_size_{axis}_{size}_gz", "a.nii.gz", gzip.compress(content, mtime=0))
        for size in HUGE:
            make.add(f"nifti2_size_{axis}_{size}", "a.nii", patched(two, 16 + 8 * axis, "<q", size))
    for count in (0, -1, 8, 32767, -32768):
        make.add(f"nifti_axes_{count}", "a.nii", patched(one, 40, "<h", count))
    make.add("nifti_all_huge", "a.nii", patched(one, 42, "<3h", 32767, 32767, 32767))
    make.add("nifti_product_beyond_64_bits", "a.nii", patched(two, 24, "<3q", 2**32, 2**31, 2**31))
    make.add("nifti_product_wraps_to_small", "a.nii", patched(two, 24, "<3q", 2**32, 2**32, 120))
    make.add("nifti_frames_wrap", "a.nii", patched(two, 16, "<8q", 4, 6, 5, 4, 2**61, 1, 1, 1))
    make.add("nifti_frames_huge", "a.nii", patched(two, 16, "<8q", 4, 6, 5, 4, 2**31, 1, 1, 1))
    for value in (math.nan, math.inf, -math.inf, 3e38):
        for field, offset in (("srow", 280), ("srow_offset", 292), ("pixdim", 80), ("quatern", 256), ("qoffset", 268)):
            make.add(f"nifti_{field}_{value}", "a.nii", patched(one, offset, "<f", value), refused=math.isnan(value))
    make.add("nifti_flat_affine", "a.nii", patched(one, 280, "<12f", *([0.0] * 12)))
    make.add("nifti_dependent_axes", "a.nii", patched(one, 280, "<12f", 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0))
    make.add("nifti_zero_pixdim_qform", "a.nii", patched(patched(one, 254, "<h", 0), 80, "<3f", 0, 0, 0))
    make.add("nifti_forms_disagree", "a.nii", patched(one, 268, "<f", 40.0))
    make.add("nifti_no_form", "a.nii", patched(one, 252, "<2h", 0, 0))
    for datatype in (0, 1, 3, 32, 128, 1536, 1792, 2048, 2304, -1, 32767):
        make.add(f"nifti_datatype_{datatype}", "a.nii", patched(one, 70, "<h", datatype))
    for offset in (0.0, 351.0, -1.0, math.nan, math.inf, 1e30, 1e9):
        make.add(f"nifti_voxels_at_{offset}", "a.nii", patched(one, 108, "<f", offset))
    for offset in (0, -1, 2**62, 2**63 - 1):
        make.add(f"nifti2_voxels_at_{offset}", "a.nii", patched(two, 168, "<q", offset))
    for slope in (math.inf, -math.inf):
        make.add(f"nifti_slope_{slope}", "a.nii", patched(one, 112, "<f", slope))
    make.add("nifti_intercept_nan", "a.nii", patched(one, 112, "<2f", 2.0, math.nan))
    make.add("nifti_header_size", "a.nii", patched(one, 0, "<i", 347))
    make.add("nifti_magic", "a.nii", patched(one, 344, "<4s", b"n+9\0"))
    make.add("nifti_pair", "a.nii", patched(one, 344, "<4s", b"ni1\0"))
    make.add("nifti_unit", "a.nii", patched(one, 123, "<B", 7))
    make.add("nifti_gz_of_gz", "a.nii.gz", gzip.compress(gzip.compress(one, mtime=0), mtime=0))
    make.add("nifti_gz_checksum", "a.nii.gz", patched(gzip.compress(one, mtime=0), len(gzip.compress(one, mtime=0)) - 8, "<I", 1))
    make.add("nifti_gz_reserved_block", "a.nii.gz", gzip.compress(b"", mtime=0)[:10] + b"\xff" * 100)
    make.flip("nifti", "a.nii", one, 12, limit=352)
    make.flip("nifti_gz", "a.nii.gz", gzip.compress(one, mtime=0), 12)
    lie = patched(one, 42, "<3h", 1024, 1024, 2000)
    make.add("nifti_claims_4_gb", "a.nii", lie)
    make.add("nifti_claims_4_gb_gz", "a.nii.gz", gzip.compress(lie, mtime=0))
    # As many compressed bytes as could hold what is claimed, but they do not.
    noise = make.random.randbytes(4_200_000)
    make.add("nifti_claims_4_gb_noise_gz", "a.nii.gz", gzip.compress(lie + noise, 1, mtime=0))
    make.add("nifti_bomb_behind_the_voxels", "a.nii.gz", gzip.compress(one, mtime=0) + zeros_gz(1 << 30))
    late = patched(patched(one, 108, "<f", 1e9), 42, "<3h", 4, 4, 4)
    make.add("nifti_bomb_before_the_voxels", "a.nii.gz", gzip.compress(late[:352], mtime=0) + zeros_gz(2 << 30))


# --- NRRD and MetaImage ---

VOXELS = bytes(range(120))


def nrrd_text(voxels=VOXELS, **changes):
    fields = {
        "type": "uchar", "dimension": "3", "space": "left-posterior-superior", "sizes": "6 5 4",
        "space directions": "(1,0,0) (0,1,0) (0,0,2)", "kinds": "domain domain domain", "endian": "little",
        "encoding": "raw", "space origin": "(0,0,0)",
    }
    fields.update({key.replace("_", " "): value for key, value in changes.items()})
    lines = "".join(f"{key}: {value}\n" for key, value in fields.items() if value is not None)
    return ("NRRD0004\n" + lines + "\n").encode() + voxels


def make_nrrd(make):
    packed = gzip.compress(VOXELS, mtime=0)
    make.cut("nrrd", "a.nrrd", nrrd_text())
    make.cut("nrrd_gz", "a.nrrd", nrrd_text(packed, encoding="gzip"))
    make.cut("nrrd_seg", "a.seg.nrrd", nrrd_text(packed, encoding="gzip"))
    for size in HUGE + ["", "x", "1e3", "6.5", "99999999999999999999"]:
        make.add(f"nrrd_size_{size}", "a.nrrd", nrrd_text(sizes=f"{size} 5 4"))
    make.add("nrrd_size_wraps", "a.nrrd", nrrd_text(sizes=f"{2**32} {2**32} 120"))
    make.add("nrrd_layers_wrap", "a.nrrd",
             nrrd_text(dimension="4", sizes=f"{2**61} 6 5 4", space_directions="none (1,0,0) (0,1,0) (0,0,2)", kinds=None))
    make.add("nrrd_layers_zero", "a.nrrd",
             nrrd_text(dimension="4", sizes="0 6 5 4", space_directions="none (1,0,0) (0,1,0) (0,0,2)", kinds=None))
    for dimension in ("0", "-1", "2", "5", "17", str(2**31), str(2**63), "nan", ""):
        make.add(f"nrrd_dimension_{dimension}", "a.nrrd", nrrd_text(dimension=dimension))
    for number in NUMBERS:
        make.add(f"nrrd_direction_{number}", "a.nrrd", nrrd_text(space_directions=f"({number},0,0) (0,1,0) (0,0,2)"))
        if number not in ("0", "1e-320"):
            make.add(f"nrrd_origin_{number}", "a.nrrd", nrrd_text(space_origin=f"({number},0,0)"))
    for text in ("", "none none none", "(1,0,0)", "(1,0,0) (0,1,0)", "(1,0,0) (1,0,0) (1,0,0)", "((((((", "(1,0,0,0) (0,1,0) (0,0,2)"):
        make.add("nrrd_directions", "a.nrrd", nrrd_text(space_directions=text))
    for field in ("type", "dimension", "space", "sizes", "space directions", "encoding", "space origin"):
        make.add(f"nrrd_without_{field}", "a.nrrd", nrrd_text(**{field: None}))
    for kind in ("block", "float16", "complex", ""):
        make.add(f"nrrd_type_{kind}", "a.nrrd", nrrd_text(type=kind))
    make.add("nrrd_endian", "a.nrrd", nrrd_text(type="short", endian="middle", sizes="6 5 2"))
    for encoding in ("bzip2", "hex", "", "gzip"):
        make.add(f"nrrd_encoding_{encoding}", "a.nrrd", nrrd_text(encoding=encoding))
    for skip in ("-1", str(2**62), str(2**63 - 1), "x", "200"):
        make.add(f"nrrd_line_skip_{skip}", "a.nrrd", nrrd_text(line_skip=skip))
    for skip in ("-2", str(2**62), str(2**63 - 1), "121"):
        make.add(f"nrrd_byte_skip_{skip}", "a.nrrd", nrrd_text(byte_skip=skip))
    make.add("nrrd_ascii_words", "a.nrrd", nrrd_text(b"1 2 three", encoding="ascii"))
    make.add("nrrd_ascii_out_of_range", "a.nrrd", nrrd_text(b"300 " * 120, encoding="ascii"))
    make.add("nrrd_ascii_claims_4_gb", "a.nrrd", nrrd_text(b"1 " * 100, encoding="ascii", sizes="1024 1024 2000"))
    make.add("nrrd_claims_2_gb", "a.nrrd", nrrd_text(sizes="1024 1024 2000"))
    make.add("nrrd_claims_2_gb_gz", "a.nrrd", nrrd_text(packed, encoding="gzip", sizes="1024 1024 2000"))
    skipped = zeros_gz(1 << 30)
    make.add("nrrd_bomb_in_skip", "a.nrrd", nrrd_text(skipped + packed, encoding="gzip", byte_skip=str(1 << 30)))
    make.add("nrrd_bomb_behind", "a.nrrd", nrrd_text(packed + skipped, encoding="gzip"))
    make.add("nrrd_long_line", "a.nrrd", b"NRRD0004\ntype: " + b"u" * 3_000_000 + b"\n\n")
    make.add("nrrd_endless_header", "a.nrrd", b"NRRD0004\n" + b"# nothing\n" * 10 + b"key:=value\n" * 2_000_000)
    make.add("nrrd_no_line_end", "a.nrrd", b"NRRD0004" + bytes(3_000_000))
    for name in ("/etc/passwd", "../secret.raw", "~/x", "..", ".", "", "missing.raw", "/dev/zero", "LIST", "%03d.raw 1 9 1", "sub/voxels.raw"):
        make.add("nrrd_data_elsewhere", "a.nhdr", nrrd_text(b"", **{"data file": name}), beside=[("sub/voxels.raw", VOXELS)])
    make.add("nrrd_data_short", "a.nhdr", nrrd_text(b"", **{"data file": "v.raw"}), beside=[("v.raw", VOXELS[:50])])
    make.add("nrrd_data_is_itself", "a.nhdr", nrrd_text(b"", **{"data file": "a.nhdr"}, sizes="60 50 40"))
    make.flip("nrrd", "a.nrrd", nrrd_text(), 15)


def metaimage_text(voxels=VOXELS, **changes):
    fields = {
        "ObjectType": "Image", "NDims": "3", "BinaryData": "True", "BinaryDataByteOrderMSB": "False", "CompressedData": "False",
        "TransformMatrix": "1 0 0 0 1 0 0 0 1", "Offset": "0 0 0", "ElementSpacing": "1 1 2", "DimSize": "6 5 4",
        "ElementType": "MET_UCHAR",
    }
    last = changes.pop("ElementDataFile", "LOCAL")
    fields.update(changes)
    lines = "".join(f"{key} = {value}\n" for key, value in fields.items() if value is not None)
    return (lines + f"ElementDataFile = {last}\n").encode() + voxels


def make_metaimage(make):
    packed = zlib.compress(VOXELS)
    make.cut("mha", "a.mha", metaimage_text())
    make.cut("mha_packed", "a.mha", metaimage_text(packed, CompressedData="True", CompressedDataSize=len(packed)))
    for size in HUGE + ["", "x", "6.5", "99999999999999999999"]:
        make.add(f"mha_size_{size}", "a.mha", metaimage_text(DimSize=f"{size} 5 4"))
    make.add("mha_size_wraps", "a.mha", metaimage_text(DimSize=f"{2**32} {2**32} 120"))
    for count in ("0", "-1", "2", "5", str(2**31), "nan"):
        make.add(f"mha_axes_{count}", "a.mha", metaimage_text(NDims=count))
    for number in NUMBERS:
        make.add(f"mha_spacing_{number}", "a.mha", metaimage_text(ElementSpacing=f"{number} 1 2"))
        make.add(f"mha_matrix_{number}", "a.mha", metaimage_text(TransformMatrix=f"{number} 0 0 0 1 0 0 0 1"))
        if number not in ("0", "1e-320"):
            make.add(f"mha_offset_{number}", "a.mha", metaimage_text(Offset=f"{number} 0 0"))
    make.add("mha_flat_matrix", "a.mha", metaimage_text(TransformMatrix="1 0 0 1 0 0 0 0 1"))
    for channels in ("0", "-1", str(2**62), "121"):
        make.add(f"mha_channels_{channels}", "a.mha", metaimage_text(ElementNumberOfChannels=channels))
    for kind in ("MET_NONE", "MET_STRING", "", "uchar"):
        make.add(f"mha_type_{kind}", "a.mha", metaimage_text(ElementType=kind))
    for skip in ("-2", str(2**62), str(2**63 - 1), "121", "x"):
        make.add(f"mha_header_size_{skip}", "a.mha", metaimage_text(HeaderSize=skip))
    for size in (-1, len(packed) + 1, 2**62, "x"):
        make.add(f"mha_packed_size_{size}", "a.mha", metaimage_text(packed, CompressedData="True", CompressedDataSize=size))
    make.add("mha_not_packed", "a.mha", metaimage_text(CompressedData="True"))
    make.add("mha_claims_2_gb", "a.mha", metaimage_text(DimSize="1024 1024 2000"))
    make.add("mha_claims_2_gb_packed", "a.mha", metaimage_text(packed, CompressedData="True", DimSize="1024 1024 2000"))
    make.add("mha_slope", "a.mha", metaimage_text(ElementToIntensityFunctionSlope="2"))
    make.add("mha_endless_header", "a.mha", b"Comment = x\n" * 200_000)
    make.add("mha_long_line", "a.mha", b"Comment = " + b"x" * 3_000_000 + b"\n")
    make.add("mha_no_equals", "a.mha", b"ObjectType Image\n" + metaimage_text())
    for name in ("/etc/passwd", "../secret.raw", "..", ".", "missing.raw", "/dev/zero", "LIST", "%03d.raw 1 9 1", "sub/voxels.raw"):
        make.add("mhd_data_elsewhere", "a.mhd", metaimage_text(b"", ElementDataFile=name), beside=[("sub/voxels.raw", VOXELS)])
        make.add("mha_data_elsewhere", "a.mha", metaimage_text(b"", ElementDataFile=name))
    make.flip("mha", "a.mha", metaimage_text(), 15)


# --- DICOM ---


def support(script, *words):
    subprocess.run([sys.executable, SUPPORT / script, *map(str, words)], check=True, stdout=subprocess.DEVNULL)


def dicom_bytes(dataset):
    stream = io.BytesIO()
    pydicom.dcmwrite(stream, dataset, write_like_original=False)
    return stream.getvalue()


def changed(content, **values):
    """With other values of top-level elements (None: without them); wrong ones are written as they are."""
    dataset = pydicom.dcmread(io.BytesIO(content))
    for word, value in values.items():
        if value is None:
            delattr(dataset, word)
        else:
            setattr(dataset, word, value)
    return dicom_bytes(dataset)


def element_at(content, group, element):
    """Offset of an explicit-VR little-endian element's head."""
    return content.index(struct.pack("<HH", group, element), 132)


def with_text(content, group, element, text):
    """The text element with other text, whatever its VR allows; explicit VR with a short length."""
    at = element_at(content, group, element)
    (length,) = struct.unpack_from("<H", content, at + 6)
    text += " " * (len(text) % 2)
    return content[: at + 6] + struct.pack("<H", len(text)) + text.encode() + content[at + 8 + length :]


def preamble(syntax="1.2.840.10008.1.2.1"):
    meta = pydicom.dataset.FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = "1.2.840.10008.5.1.4.1.1.2", "1.2.3.4"
    meta.TransferSyntaxUID = syntax
    dataset = pydicom.dataset.FileDataset("", {}, file_meta=meta, preamble=bytes(128))
    dataset.is_little_endian, dataset.is_implicit_VR = True, syntax == "1.2.840.10008.1.2"
    return dicom_bytes(dataset)


def nested(levels, explicit=True):
    """Sequences of undefined length in each other, never closed."""
    head = struct.pack("<HH", 0x0008, 0x1140) + (b"SQ\0\0" if explicit else b"") + b"\xff" * 4
    return (head + struct.pack("<HHI", 0xFFFE, 0xE000, 0xFFFFFFFF)) * levels


def make_dicom(make, work):
    for case in ("plain", "rle", "deflated", "implicit", "enhanced", "enhanced_slopes"):
        support("make_dicom_series.py", case, work / case)
    ct = sorted((work / "plain" / "dicom").iterdir())
    slices = [(path.name, path.read_bytes()) for path in ct]
    name, one = slices[4]
    others = slices[:4] + slices[5:]
    words = ["inspect", "d"]

    def series(kind, content, refused=True, declared_mb=0):
        """The damaged slice within its series, and alone."""
        beside = [(f"d/{n}", c) for n, c in others]
        make.add(f"ct_{kind}", f"d/{name}", content, words, refused, declared_mb, beside)

    def alone(kind, content, refused=True, declared_mb=0):
        make.add(f"dicom_{kind}", "a.dcm", content, None, refused, declared_mb)

    make.cut("dicom", "a.dcm", one)
    make.cut("dicom_implicit", "a.dcm", (next((work / "implicit" / "dicom").iterdir())).read_bytes())
    make.cut("dicom_rle", "a.dcm", (next((work / "rle" / "dicom").iterdir())).read_bytes())
    make.cut("dicom_deflated", "a.dcm", (next((work / "deflated" / "dicom").iterdir())).read_bytes(), to_the_last=False)
    enhanced = (work / "enhanced" / "dicom" / "enhanced0.dcm").read_bytes()
    make.cut("enhanced", "a.dcm", enhanced)
    for length in (0, 200, len(one) // 2, len(one) - 2):
        series(f"cut_{length}", one[:length], refused=length > 132)
    for field in ("Rows", "Columns"):
        for size in (0, 1, 65535):
            alone(f"{field}_{size}", changed(one, **{field: size}), declared_mb=1 if size == 1 else 0)
            series(f"{field}_{size}", changed(one, **{field: size}))
    alone("rows_and_columns_huge", changed(one, Rows=65535, Columns=65535))
    for bits in ((0, 0, 0), (1, 1, 0), (16, 17, 16), (16, 0, 0), (64, 64, 63), (16, 16, 40), (65535, 65535, 65534)):
        alone(f"bits_{bits[0]}_{bits[1]}", changed(one, BitsAllocated=bits[0], BitsStored=bits[1], HighBit=bits[2]))
    for text in NUMBERS + ["1\\2\\3\\4", "\\", "9" * 400]:
        series("position", with_text(one, 0x0020, 0x0032, f"{text}\\0\\0"), refused=text not in ("0", "1e-320"))
        alone("spacing", with_text(one, 0x0028, 0x0030, f"{text}\\1"), refused=text not in ("1e-320",))
        alone("orientation", with_text(one, 0x0020, 0x0037, f"{text}\\0\\0\\0\\1\\0"))
        alone("slope", with_text(one, 0x0028, 0x1053, text), refused=text not in ("", "1e-320", "1\\2\\3\\4", "\\"))
    for frames in ("0", "-1", "2", "2147483648", "9223372036854775807", "-9223372036854775808", "99999999999999999999", "x", "1e3"):
        alone(f"frames_{frames}", with_text(enhanced, 0x0028, 0x0008, frames))
        series(f"frames_{frames}", changed_frames(one, frames), refused=frames not in ("0", "-1", "-9223372036854775808"))
    for length in (0xFFFFFFFF, 0xFFFFFFFE, 0x80000000, 0x7FFFFFFE, 3, 0):
        at = element_at(one, 0x7FE0, 0x0010)
        alone(f"pixel_length_{length}", patched(one, at + 8, "<I", length))
        at = element_at(one, 0x0020, 0x0032)
        alone(f"position_length_{length & 0xFFFF}", patched(one, at + 6, "<H", length & 0xFFFF))
    for position in (144, 156, 160, 300, 400):
        alone(f"vr_{position}", one[:position] + b"ZZ" + one[position + 2 :], refused=False)
    alone("no_pixels", one[: element_at(one, 0x7FE0, 0x0010)])
    alone("nothing_but_its_mark", bytes(128) + b"DICM")
    alone("unknown_syntax", one.replace(b"1.2.840.10008.1.2.1\0", b"1.2.840.10008.9.9.9\0"))
    alone("other_syntax", one.replace(b"1.2.840.10008.1.2.1\0", b"1.2.840.10008.1.2\0\0\0"))
    for levels in (100, 10_000, 1_000_000):
        alone(f"nested_{levels}", preamble() + nested(levels))
        alone(f"nested_implicit_{levels}", preamble("1.2.840.10008.1.2") + nested(levels, explicit=False))
        alone(f"nested_in_image_{levels}", one[: element_at(one, 0x0008, 0x103E)] + nested(levels))
    deflate = zlib.compressobj(9, zlib.DEFLATED, -15)
    bomb = preamble("1.2.840.10008.1.2.1.99")
    long_text = struct.pack("<HH", 0x0009, 0x0010) + b"OB\0\0" + struct.pack("<I", 1 << 30)
    packed = deflate.compress(long_text) + deflate.flush(zlib.Z_FULL_FLUSH)
    zeros = deflate.compress(bytes(1 << 22)) + deflate.flush(zlib.Z_FULL_FLUSH)
    alone("deflated_bomb", bomb + packed + zeros * 256 + deflate.flush())
    deflate = zlib.compressobj(9, zlib.DEFLATED, -15)
    lie = struct.pack("<HH", 0x0009, 0x0010) + b"OB\0\0" + struct.pack("<I", 0xFFFFFFF0)
    alone("deflated_lie", bomb + deflate.compress(lie + bytes(100)) + deflate.flush())
    alone("length_lie", preamble() + lie + bytes(100))
    many = struct.pack("<HH", 0x0009, 0x1001) + b"OB\0\0" + struct.pack("<I", 0)
    alone("a_million_elements", preamble() + many * 300_000)
    make.flip("dicom", "a.dcm", one, 30)
    make.flip("dicom_head", "a.dcm", one, 30, limit=900)
    make.flip("enhanced", "a.dcm", enhanced, 30)
    make.flip("dicom_rle", "a.dcm", (next((work / "rle" / "dicom").iterdir())).read_bytes(), 20)
    make_enhanced(make, enhanced)
    make.add("folder_of_nothing", "d/empty.txt", b"", words)
    make.add("folder_of_rubbish", "d/a.dcm", b"rubbish" * 100, words)


def changed_frames(content, frames):
    """A NumberOfFrames put into an image of one frame."""
    at = element_at(content, 0x0028, 0x0010)
    text = (frames + " " * (len(frames) % 2)).encode()
    return content[:at] + struct.pack("<HH", 0x0028, 0x0008) + b"IS" + struct.pack("<H", len(text)) + text + content[at:]


def make_enhanced(make, content):
    def spoilt(kind, spoil, refused=True):
        dataset = pydicom.dcmread(io.BytesIO(content))
        spoil(dataset)
        make.add(f"enhanced_{kind}", "a.dcm", dicom_bytes(dataset), None, refused)

    frames = "PerFrameFunctionalGroupsSequence"
    spoilt("no_frames", lambda d: setattr(d, frames, Sequence([])))
    spoilt("fewer_frames", lambda d: setattr(d, frames, Sequence(d[frames].value[:-1])))
    spoilt("more_frames", lambda d: setattr(d, frames, Sequence([*d[frames].value, d[frames].value[0]])))
    spoilt("empty_frames", lambda d: setattr(d, frames, Sequence([Dataset()] * len(d[frames].value))))
    spoilt("all_frames_at_one_place", lambda d: setattr(d, frames, Sequence([d[frames].value[0]] * len(d[frames].value))))
    spoilt("no_shared", lambda d: delattr(d, "SharedFunctionalGroupsSequence"))
    spoilt("empty_shared", lambda d: setattr(d, "SharedFunctionalGroupsSequence", Sequence([Dataset()])))
    for place in ([0, 0], [0, 0, 0, 0], [1e300, 0, 0], [0, 0, 7.7]):
        spoilt("frame_elsewhere", lambda d: setattr(d[frames].value[3].PlanePositionSequence[0], "ImagePositionPatient", place))
    def turn(d):
        item = Dataset()
        item.ImageOrientationPatient = [0, 1, 0, 1, 0, 0]
        d[frames].value[2].PlaneOrientationSequence = Sequence([item])
    spoilt("one_frame_turned", turn)
    def rescale(d):
        item = Dataset()
        item.RescaleSlope, item.RescaleIntercept, item.RescaleType = 0, 0, "US"
        d[frames].value[2].PixelValueTransformationSequence = Sequence([item])
    spoilt("one_slope_zero", rescale)
    spoilt("pixels_short", lambda d: setattr(d, "PixelData", d.PixelData[:-200]))
    spoilt("rows_lie", lambda d: setattr(d, "Rows", 4000))


def make_seg(make, work):
    support("make_dicom_seg.py", "shuffled", work / "seg.dcm", work / "truth")
    content = (work / "seg.dcm").read_bytes()
    make.cut("seg", "a.dcm", content)

    def spoilt(kind, spoil, refused=True, declared_mb=0):
        dataset = pydicom.dcmread(io.BytesIO(content))
        spoil(dataset)
        make.add(f"seg_{kind}", "a.dcm", dicom_bytes(dataset), None, refused, declared_mb)

    frames = "PerFrameFunctionalGroupsSequence"
    for size in (0, 65535):
        spoilt(f"rows_{size}", lambda d: setattr(d, "Rows", size))
        spoilt(f"columns_{size}", lambda d: setattr(d, "Columns", size))
    spoilt("no_segments", lambda d: delattr(d, "SegmentSequence"))
    spoilt("empty_segments", lambda d: setattr(d, "SegmentSequence", Sequence([])))
    spoilt("same_number_twice", lambda d: setattr(d.SegmentSequence[1], "SegmentNumber", 1))
    spoilt("number_zero", lambda d: setattr(d.SegmentSequence[1], "SegmentNumber", 0))
    spoilt("no_frames", lambda d: setattr(d, frames, Sequence([])))
    spoilt("no_pixels", lambda d: delattr(d, "PixelData"))
    spoilt("no_spacing", lambda d: delattr(d.SharedFunctionalGroupsSequence[0].PixelMeasuresSequence[0], "PixelSpacing"))
    spoilt("flat", lambda d: setattr(d.SharedFunctionalGroupsSequence[0].PixelMeasuresSequence[0], "PixelSpacing", [0, 0]))
    spoilt("far_apart", lambda d: setattr(d[frames].value[0].PlanePositionSequence[0], "ImagePositionPatient", [10, 20, 1e12]))
    spoilt("a_hair_apart",
           lambda d: setattr(d.SharedFunctionalGroupsSequence[0].PixelMeasuresSequence[0], "SpacingBetweenSlices", 1e-12))
    spoilt("lying_bits", lambda d: setattr(d, "BitsAllocated", 8))
    spoilt("kind", lambda d: setattr(d, "SegmentationType", "LABELMAP"))
    make.add("seg_frames_huge", "a.dcm", with_text(content, 0x0028, 0x0008, "9223372036854775807"))
    make.flip("seg", "a.dcm", content, 30)


def make_rtstruct(make, work):
    support("make_rtstruct.py", "good", work / "rt.dcm")
    content = (work / "rt.dcm").read_bytes()
    words = ["inspect", "--check", "a.dcm"]
    make.cut("rtstruct", "a.dcm", content, words)

    def spoilt(kind, spoil, refused=True):
        dataset = pydicom.dcmread(io.BytesIO(content))
        spoil(dataset)
        make.add(f"rtstruct_{kind}", "a.dcm", dicom_bytes(dataset), words, refused)

    contour = lambda d: d.ROIContourSequence[0].ContourSequence[0]
    for count in (0, -1, 3, 2**31 - 1):
        spoilt(f"count_{count}", lambda d: setattr(contour(d), "NumberOfContourPoints", count))
    for marker, text in (("nan", b"nan"), ("inf", b"inf"), ("huge", b"9e999"), ("word", b"abc"), ("comma", b"1,5"), ("blank", b"   ")):
        dataset = pydicom.dcmread(io.BytesIO(content))
        contour(dataset).ContourData = ["7654321"] + list(contour(dataset).ContourData)[1:]
        make.add(f"rtstruct_coordinate_{marker}", "a.dcm", dicom_bytes(dataset).replace(b"7654321", text.ljust(7)), words)
    spoilt("no_contours", lambda d: delattr(d, "ROIContourSequence"))
    spoilt("no_rois", lambda d: delattr(d, "StructureSetROISequence"))
    spoilt("same_number_twice", lambda d: setattr(d.StructureSetROISequence[1], "ROINumber", 1))
    spoilt("unlisted", lambda d: setattr(d.ROIContourSequence[0], "ReferencedROINumber", 999), refused=False)  # with a note
    spoilt("no_number", lambda d: delattr(d.StructureSetROISequence[0], "ROINumber"))
    spoilt("pairs", lambda d: setattr(contour(d), "ContourData", list(contour(d).ContourData)[:-1]))
    spoilt("no_points", lambda d: setattr(contour(d), "ContourData", []))
    spoilt("name_with_line_breaks", lambda d: (setattr(d.StructureSetROISequence[0], "ROIName", "a\nb\x1b[31mc"),
                                               setattr(contour(d), "NumberOfContourPoints", 77)))
    make.add("rtstruct_segment_unnamed", "a.dcm", content, ["segment", "a.dcm", "--spacing-mm", "1", "--output", "o.nii"])
    make.add("rtstruct_segment_unknown", "a.dcm", content, ["segment", "a.dcm", "--roi", "x\ny", "--spacing-mm", "1", "--output", "o.nii"])
    make.flip("rtstruct", "a.dcm", content, 30, words)
    make.add("rtstruct_nested", "a.dcm", content + nested(500_000, explicit=False), words)


# --- contours ---


def ring(z=0.0, count=12, radius=10.0, x=0.0):
    return [[x + radius * math.cos(2 * math.pi * k / count), radius * math.sin(2 * math.pi * k / count), z] for k in range(count)]


def contour_document():
    planes = [
        {"origin": [0, 0, z], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0],
         "contours": [{"closed": True, "hole": False, "points": ring(z, radius=10 - abs(z) / 2)}]}
        for z in (-6.0, 0.0, 6.0)
    ]
    return {"version": 1, "frame": "LPS mm", "structure": "ball", "planes": planes}


SEGMENT = ["segment", "a.json", "--spacing-mm", "2", "--output", "o.nii"]


def make_contour_json(make):
    text = json.dumps(contour_document())
    make.cut("json", "a.json", text.encode(), SEGMENT)

    def spoilt(kind, spoil, refused=True):
        document = contour_document()
        replaced = spoil(document)
        make.add(f"json_{kind}", "a.json", json.dumps(document if replaced is None else replaced), SEGMENT, refused)

    def put(*path):
        def spoil(document):
            place = document
            for key in path[:-2]:
                place = place[key]
            place[path[-2]] = path[-1]
        return spoil

    def drop(*path):
        def spoil(document):
            place = document
            for key in path[:-1]:
                place = place[key]
            del place[path[-1]]
        return spoil

    plane, contour = ("planes", 0), ("planes", 0, "contours", 0)
    others = [None, True, 0, -1, 1.5, "text", [], {}, [[]], [None], [1, 2], [1, 2, 3, 4], {"x": 1}]
    for number, value in enumerate(others):
        for where in (("frame",), ("planes",), (*plane, "origin"), (*plane, "normal"), (*contour, "points"), (*contour, "points", 0)):
            zero = value == [] and where in ((*contour, "points"),)
            spoilt(f"{where[-1]}_{number}", put(*where, value), refused=True or zero)
        spoilt(f"version_{number}", put("version", value))
        spoilt(f"closed_{number}", put(*contour, "closed", value), refused=value is not True)
        spoilt(f"interior_{number}", put("interior", value), refused=value != [])
        spoilt(f"surface_{number}", put("surface", value), refused=value != [])
        spoilt(f"whole_{number}", lambda document: value if value is not None else "null")
    for key in ("frame", "planes"):
        spoilt(f"without_{key}", drop(key))
    for key in ("origin", "normal"):
        spoilt(f"without_{key}", drop(*plane, key))
    spoilt("without_points", drop(*contour, "points"))
    for kind, number in (("largest", 1.7e308), ("huge", 1e300), ("beyond_float", 1e39), ("far", 1e15), ("tiny", 5e-324)):
        spoilt(f"coordinate_{kind}", put(*contour, "points", 0, 0, number), refused=False)
        spoilt(f"origin_{kind}", put(*plane, "origin", 2, number), refused=False)
        spoilt(f"normal_{kind}", put(*plane, "normal", [0, 0, number]), refused=False)
        document = json.dumps(contour_document())
        scale = lambda d: [p["contours"][0].update(points=[[c * number for c in q] for q in p["contours"][0]["points"]])
                           or p.update(origin=[c * number for c in p["origin"]]) for p in d["planes"]] and d
        if kind != "largest":
            spoilt(f"all_{kind}", lambda d: scale(d), refused=False)
    make.add("json_number_out_of_range", "a.json", text.replace("-6.0", "1e999", 1), SEGMENT)
    make.add("json_not_utf8", "a.json", text.encode().replace(b"ball", b"\xff\xfe\x80"), SEGMENT)
    make.add("json_utf16", "a.json", text.encode("utf-16"), SEGMENT)
    make.add("json_nul", "a.json", text.encode() + bytes(4096), SEGMENT, refused=False)
    make.add("json_twice", "a.json", (text + text).encode(), SEGMENT)
    make.add("json_line_breaks_in_a_message", "a.json", text.replace("LPS mm", "LPS\\nmm\\u001b[31m"), SEGMENT)
    for levels in (1000, 1_000_000):
        make.add(f"json_nested_{levels}", "a.json", "[" * levels, SEGMENT)
        closed = "[" * levels + "]" * levels
        make.add(f"json_frame_nested_{levels}", "a.json", text.replace('"LPS mm"', closed), SEGMENT)
        make.add(f"json_version_nested_{levels}", "a.json", text.replace('"version": 1', '"version": ' + closed), SEGMENT)
        make.add(f"json_unknown_nested_{levels}", "a.json", text.replace('"version": 1', '"other": ' + closed), SEGMENT, refused=False)
        make.add(f"json_objects_nested_{levels}", "a.json", '{"a":' * levels, SEGMENT)
    make.add("json_long_frame", "a.json", text.replace("LPS mm", "L" * 5_000_000), SEGMENT)
    make.add("json_long_key", "a.json", '{"' + "k" * 5_000_000 + '": nope}', SEGMENT)
    spoilt("all_points_equal", lambda d: [p["contours"][0].update(points=[[0, 0, 0]] * 12) for p in d["planes"]] and d)
    spoilt("on_a_line", lambda d: [p["contours"][0].update(points=[[k, 0, p["origin"][2]] for k in range(12)]) for p in d["planes"]] and d)
    spoilt("no_planes", put("planes", []))
    spoilt("two_points", put(*contour, "points", [[0, 0, -6], [1, 0, -6]]))
    spoilt("skewed_axes", put(*plane, "u", [1, 1, 0]))
    spoilt("oblique_axes", put(*plane, "u", [0, 0, 1]))
    make.flip("json", "a.json", text.encode(), 30, SEGMENT)


def markups_document():
    curves = [
        {"type": "ClosedCurve", "name": f"ball {n}", "coordinateSystem": "LPS", "coordinateUnits": "mm",
         "controlPoints": [{"id": str(k), "position": p, "positionStatus": "defined"} for k, p in enumerate(ring(z))]}
        for n, z in enumerate((-6.0, 0.0, 6.0))
    ]
    schema = "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/markups-schema-v1.0.3.json#"
    return {"@schema": schema, "markups": curves}


def make_markups(make):
    text = json.dumps(markups_document())
    words = ["segment", "a.mrk.json", "--spacing-mm", "2", "--output", "o.nii"]
    make.cut("markups", "a.mrk.json", text.encode(), words)
    for number, value in enumerate([None, 1, "text", [], {}, [[]], [None], ["x"], [{}]]):
        for key in ("@schema", "markups"):
            document = markups_document()
            document[key] = value
            make.add(f"markups_{key[-7:]}_{number}", "a.mrk.json", json.dumps(document), words)
        for key in ("type", "coordinateSystem", "coordinateUnits", "controlPoints"):
            document = markups_document()
            document["markups"][0][key] = value
            sound = (key, value) in (("coordinateSystem", 1), ("controlPoints", []))  # a curve without a point is left out
            make.add(f"markups_{key}_{number}", "a.mrk.json", json.dumps(document), words, refused=not sound)
        document = markups_document()
        document["markups"][0]["controlPoints"][0]["position"] = value
        make.add(f"markups_position_{number}", "a.mrk.json", json.dumps(document), words)
    for levels in (1000, 1_000_000):
        closed = "[" * levels + "]" * levels
        make.add(f"markups_units_nested_{levels}", "a.mrk.json", text.replace('"mm"', closed, 1), words)
        make.add(f"markups_frame_nested_{levels}", "a.mrk.json", text.replace('"LPS"', closed, 1), words)
    make.add("markups_far", "a.mrk.json", text.replace("10.0", "1e300", 1), words, refused=False)
    make.flip("markups", "a.mrk.json", text.encode(), 15, words)


# --- meshes and tables ---


def stl_bytes(count=4):
    facets = b"".join(struct.pack("<12fH", 0, 0, 1, *(float((k * 7 + n) % 5) for n in range(9)), 0) for k in range(count))
    return b"kontur SPACE=LPS".ljust(80, b"\0") + struct.pack("<I", count) + facets


PLY = b"""ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
"""
OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def make_meshes(make):
    make.cut("stl", "a.stl", stl_bytes())
    for count in (0, 3, 5, 2**31, 2**32 - 1):
        make.add(f"stl_count_{count}", "a.stl", patched(stl_bytes(), 80, "<I", count))
    for value in (math.nan, math.inf):
        make.add(f"stl_{value}", "a.stl", patched(stl_bytes(), 84 + 12, "<f", value))
    make.add("stl_text", "a.stl", b"solid x\nfacet normal 0 0 1\nendsolid\n")
    make.flip("stl", "a.stl", stl_bytes(), 10)
    make.cut("ply", "a.ply", PLY, to_the_last=False)
    for old, new in [(b"vertex 4", b"vertex " + str(n).encode()) for n in (-1, 3, 2**31, 2**63 - 1, 2**64)] + [
        (b"face 4", b"face " + str(n).encode()) for n in (-1, 5, 2**31, 2**63 - 1)
    ] + [
        (b"3 0 2 1", b"3 0 2 9"), (b"3 0 2 1", b"3 0 2 -1"), (b"3 0 2 1", b"3 0 2 1.5"), (b"3 0 2 1", b"2 0 2"), (b"3 0 2 1", b"1e9 0 2"),
        (b"3 0 2 1", b"nan 0 2 1"), (b"0 0 1\n3", b"0 0 nan\n3"), (b"0 0 1\n3", b"0 0 1e999\n3"), (b"ascii 1.0", b"ebcdic 1.0"),
        (b"ascii", b"binary_little_endian"), (b"property float x\n", b""), (b"property float x", b"property quaternion x"),
        (b"end_header", b"element none 9223372036854775807\nend_header"), (b"end_header\n", b""), (b"property list uchar", b"property list float"),
        (b"ply\n", b"plx\n"), (b"element vertex 4\n", b""),
    ]:
        make.add("ply_spoilt", "a.ply", PLY.replace(old, new, 1), refused=new not in (b"property list float",))
    make.add("ply_long_line", "a.ply", b"ply\nformat ascii 1.0\ncomment " + b"x" * 5_000_000)
    make.flip("ply", "a.ply", PLY, 15)
    for old, new in ((b"f 1 3 2", b"f 1 3 9"), (b"f 1 3 2", b"f 0 1 2"), (b"f 1 3 2", b"f -5 1 2"), (b"f 1 3 2", b"f 1 2"),
                     (b"f 1 3 2", b"f 99999999999999999999 1 2"), (b"f 1 3 2", b"f 1/x/y 2 3"), (b"v 1 0 0", b"v 1 0"),
                     (b"v 1 0 0", b"v nan 0 0"), (b"v 1 0 0", b"v 1e999 0 0"), (b"f 1 3 2", b"f 1//9 3//9 2//9"),
                     (b"f 1 3 2", b"f -9223372036854775808 1 2")):
        make.add("obj_spoilt", "a.obj", OBJ.replace(old, new, 1))
    make.flip("obj", "a.obj", OBJ, 10)
    make.add("mesh_of_rubbish", "a.ply", make.random.randbytes(5000))
    make.add("image_of_rubbish", "a.nii", make.random.randbytes(5000))
    make.add("contours_of_rubbish", "a.json", make.random.randbytes(5000))
    make.add("empty_name", "a", b"")
    for name in ("a.nii", "a.nii.gz", "a.nrrd", "a.mha", "a.stl", "a.ply", "a.obj", "a.json", "a.dcm"):
        make.add(f"folder_named_{name}", f"{name}/x", b"x", ["inspect", name])
        make.add(f"empty_{name}", name, b"", refused=name != "a.obj")


def make_tables(make):
    words = ["batch", "a.csv"]
    ball = [("ball.json", json.dumps(contour_document()).encode())]
    row = "ball.json,2,o.nii"
    head = "contours,spacing-mm,output"
    for kind, text in {
        "empty": "", "only_columns": head + "\n", "open_quote": f'{head}\n"ball.json,2,o.nii\n', "behind_quote": f'{head}\n"ball.json"x,2,o.nii\n',
        "too_few": f"{head}\nball.json,2\n", "too_many": f"{head}\n{row},9\n", "same_column": f"{head},output\n{row},p.nii\n",
        "unnamed_column": f"{head},\n{row},\n", "unknown_column": f"{head},colour\n{row},red\n", "no_output": "contours,spacing-mm\nball.json,2\n",
        "bad_number": f"{head}\nball.json,nan,o.nii\n", "bad_number_2": f"{head}\nball.json,-1,o.nii\n", "same_output": f"{head}\n{row}\n{row}\n",
        "nul": f"{head}\nball\0.json,2,o.nii\n", "not_utf8": head.encode() + b"\nb\xff\xfe.json,2,o.nii\n", "utf16": f"{head}\n{row}\n".encode("utf-16"),
        "missing_file": f"{head}\nnone.json,2,o.nii\n", "only_commas": "," * 1_000_000, "only_quotes": '"' * 1_000_001,
        "carriage_returns": "\r" * 1000, "binary": bytes(range(256)) * 100, "option_injection": "contours,spacing-mm,output,config\nball.json,2,o.nii,x\n",
        "dashes": "contours,spacing-mm,output,--help\nball.json,2,o.nii,x\n",
    }.items():
        make.add(f"csv_{kind}", "a.csv", text, words, refused=kind not in ("only_columns",), beside=ball)
    make.add("csv_is_a_folder", "a.csv/x", b"", words)
    make.add("csv_is_missing", "other.csv", b"", words)
    make.add("csv_is_endless", "other.csv", b"", ["batch", "/dev/zero"])
    for command in (["inspect", "/dev/zero"], ["segment", "/dev/zero", "--spacing-mm", "2", "--output", "o.nii"],
                    ["segment", "ball.json", "--image", "/dev/zero", "--output", "o.nii"], ["compare", "/dev/zero", "/dev/null"],
                    ["trace", "/dev/null", "--planes", "ball.json", "--output", "o.json"], ["convert", "/dev/zero", "o.nii"]):
        make.add(f"device_{command[0]}", ball[0][0], ball[0][1], command)


# --- What neighbours' programs write ---


def supported(work, script, *words):
    """The files that a script of the tests writes, by name."""
    folder = work / f"{script}{''.join(words)}"
    folder.mkdir()
    support(script, *words, folder)
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}


def make_mgh(make, work):
    files = supported(work, "image_oracle.py", "make-mgh")
    tail = 20  # of the scan, behind the voxels: a file may end before it
    plain = files["axial_u1.mgh"][:-tail]
    make.cut("mgh", "a.mgh", plain)
    make.cut("mgz", "a.mgz", files["axial_i2.mgz"][:-tail])
    for axis in (0, 1, 2, 3):
        for size in (0, -1, -(2**31), 2**31 - 1):
            make.add(f"mgh_size_{axis}_{size}", "a.mgh", patched(plain, 4 + 4 * axis, ">i", size))
    for place, form, value in [(0, ">i", 2), (20, ">i", 7), (28, ">h", 0)] + [
        (at, ">f", value) for at in (30, 38, 42, 78) for value in (math.nan, math.inf)
    ]:
        make.add(f"mgh_{place}_{value}", "a.mgh", patched(plain, place, form, value))
    make.add("mgz_bomb", "a.mgz", gzip.compress(patched(plain, 4, ">3i", 1024, 1024, 1024)[:284]) + zeros_gz(64 << 20))
    make.flip("mgh", "a.mgh", files["axial_u1.mgh"], 20)


def make_gipl(make, work):
    plain = supported(work, "image_oracle.py", "make-gipl")["i2.gipl"]
    words = ["convert", "a.gipl", "o.nii", "--allow-missing-geometry"]
    make.cut("gipl", "a.gipl", plain, words)
    make.add("gipl_without_permission", "a.gipl", plain)
    for axis in (0, 1, 2):
        for size in (0, 65535):
            make.add(f"gipl_size_{axis}_{size}", "a.gipl", patched(plain, 2 * axis, ">H", size), words)
        for value in (0, -1, math.nan, math.inf):
            make.add(f"gipl_spacing_{axis}_{value}", "a.gipl", patched(plain, 10 + 4 * axis, ">f", value), words)
    for place, form, value in ((8, ">H", 99), (204, ">d", math.nan), (240, ">f", math.nan), (240, ">f", 2), (252, ">I", 1)):
        make.add(f"gipl_{place}_{value}", "a.gipl", patched(plain, place, form, value), words)
    make.flip("gipl", "a.gipl", plain, 15, words)


def make_pairs(make, work):
    files = supported(work, "image_oracle.py", "make-pairs")
    header, voxels = files["axial_1.hdr"], files["axial_1.img"]
    make.add("pair_alone", "a.hdr", header)
    make.add("pair_of_voxels_alone", "a.img", voxels)
    make.cut("pair_header", "a.hdr", header[:348])
    for length in (0, 1, len(voxels) // 2, len(voxels) - 1):
        make.add(f"pair_voxels_cut_{length}", "a.hdr", header, beside=[("a.img", voxels[:length])])
    for offset in (-16, math.nan, math.inf, 1e18):
        make.add(f"pair_offset_{offset}", "a.hdr", patched(header, 108, "<f", offset), beside=[("a.img", voxels)])
    make.add("pair_analyze", "a.hdr", patched(header, 344, "<I", 0), beside=[("a.img", voxels)])


def make_vtk(make, files):
    for name in ("text.vtk", "binary5.vtk"):
        make.cut(f"vtk_{name}", "a.vtk", files[name][: files[name].index(b"POINT_DATA")], to_the_last=False)
    text = files["text.vtk"]
    lines = re.search(rb"LINES (\d+) (\d+)\n(\d+) (\d+)", text)
    for number in (-1, 2**31, 2**63 - 1, 2**64):
        make.add(f"vtk_points_{number}", "a.vtk", re.sub(rb"POINTS \d+", b"POINTS %d" % number, text))
        for group in (1, 2, 3, 4):
            make.add(f"vtk_lines_{group}_{number}", "a.vtk", text[: lines.start(group)] + b"%d" % number + text[lines.end(group) :])
    for old, new in ((b"POLYDATA", b"STRUCTURED_GRID"), (b"float", b"quaternion"), (b"ASCII", b"BINARY"), (b" 1.0", b" nan"),
                     (b" 1.0", b" 1e999"), (b"SPACE=LPS", b"SPACE=up"), (b"# vtk", b"# VTX"), (b"LINES", b"SPLINES")):
        make.add("vtk_spoilt", "a.vtk", text.replace(old, new, 1), refused=new not in (b"SPACE=up", b"# VTX"))
    for name in ("text.vtk", "binary5.vtk"):
        make.flip(f"vtk_{name}", "a.vtk", files[name], 10)


def make_vtp(make, files):
    for name in ("ascii.vtp", "raw.vtp", "packed.vtp"):
        make.cut(f"vtp_{name}", "a.vtp", files[name].rstrip())
        make.flip(f"vtp_{name}", "a.vtp", files[name], 10)
    ascii_ = files["ascii.vtp"]
    for number in (-1, 2**31, 2**63 - 1, 2**64):
        for key in (b"NumberOfPoints", b"NumberOfLines"):
            make.add(f"vtp_{key.decode()}_{number}", "a.vtp", re.sub(key + rb"='\d+'", key + b"='%d'" % number, ascii_))
        make.add(f"vtp_offset_{number}", "a.vtp", re.sub(rb'offset="\d+"', b'offset="%d"' % number, files["raw.vtp"]))
    for old, new in ((b"Float32", b"Float16"), (b"</Points>", b""), (b'"PolyData"', b'"ImageData"'), (b'format="ascii"', b'format="poem"'),
                     (b' 1.0', b' nan'), (b"<Piece", b"<Piece " + b"x" * 5_000_000), (b"<PolyData>", b"<PolyData>" * 100_000)):
        make.add("vtp_spoilt", "a.vtp", ascii_.replace(old, new, 1), refused=new != b"")  # a tag's end is not needed


def cases(folder, step=1):
    """Every `step`-th case, and how many there are; their files lie in `folder`/cases/NAME."""
    work = folder / "work"
    work.mkdir()
    (folder / "cases").mkdir()
    make = Maker(folder / "cases", step)
    make_nifti(make)
    make_nrrd(make)
    make_metaimage(make)
    make_dicom(make, work)
    make_seg(make, work)
    make_rtstruct(make, work)
    make_contour_json(make)
    make_markups(make)
    make_meshes(make)
    make_tables(make)
    make_mgh(make, work)
    make_gipl(make, work)
    make_pairs(make, work)
    lines = supported(work, "make_vtk.py")
    make_vtk(make, lines)
    make_vtp(make, lines)
    return make.cases, make.made
