# SPDX-License-Identifier: Apache-2.0
"""make_dicom_series.py CASE FOLDER: writes a small DICOM series that is hard to read in one way, and what it truly shows.

FOLDER/dicom holds the files, FOLDER/truth.txt the size and the index-to-mm matrix (LPS, three rows of four numbers),
FOLDER/truth.raw the values in modality units (float64, i fastest, slices ascending along the normal).
"""

import random
import struct
import sys
from pathlib import Path

import numpy as np
from pydicom import dcmread
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.encaps import encapsulate
from pydicom.sequence import Sequence
from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian, RLELossless, generate_uid

CT = "1.2.840.10008.5.1.4.1.1.2"
NZ, NY, NX = 9, 12, 14
SPACING = (0.8, 0.7)  # between rows, between columns
STEP = 2.5
ORIGIN = np.array([-20.0, -30.0, 100.0])


def uid(*words):
    return generate_uid(entropy_srcs=[str(w) for w in words])


def stored_values():
    """A lopsided body on a ramp: no two axes can be swapped or flipped unnoticed."""
    z, y, x = np.mgrid[0:NZ, 0:NY, 0:NX]
    return 40 * x + 7 * y + 300 * z + 500 * ((x - 9) ** 2 + (y - 4) ** 2 + 4 * (z - 3) ** 2 < 20)


def new_slice(case, name, series="only"):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = CT
    meta.MediaStorageSOPInstanceUID = uid(case, series, name)
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    d = FileDataset("", {}, file_meta=meta, preamble=b"\0" * 128)
    d.SOPClassUID, d.SOPInstanceUID = CT, meta.MediaStorageSOPInstanceUID
    d.Modality = "CT"
    d.SeriesDescription = f"{series} {case}"
    d.StudyInstanceUID, d.SeriesInstanceUID = uid(case, "study"), uid(case, series)
    d.FrameOfReferenceUID = uid(case, "frame")
    d.PatientName, d.PatientID = "Phantom^One", "P1"
    d.Rows, d.Columns = NY, NX
    d.PixelSpacing, d.SliceThickness = list(SPACING), STEP
    d.SamplesPerPixel, d.PhotometricInterpretation = 1, "MONOCHROME2"
    d.BitsAllocated, d.BitsStored, d.HighBit, d.PixelRepresentation = 16, 16, 15, 1
    d.RescaleSlope, d.RescaleIntercept = 1, -1024
    d.is_little_endian, d.is_implicit_VR = True, False
    return d


def set_pixels(d, values, dtype="<i2"):
    d.PixelData = np.ascontiguousarray(values).astype(dtype).tobytes()
    d["PixelData"].VR = "OB" if np.dtype(dtype).itemsize == 1 else "OW"


def place(d, orientation, position):
    d.ImageOrientationPatient = [f"{v:.9f}" for v in orientation]
    d.ImagePositionPatient = [f"{v:.6f}" if abs(v) < 1e6 else f"{v:.3e}" for v in position]


MPEG2 = "1.2.840.10008.1.2.4.100"
NEW_SYNTAXES = {
    "htj2k": "1.2.840.10008.1.2.4.201",
    "jpeg_xl": "1.2.840.10008.1.2.4.110",
    "private": "1.2.826.0.1.3680043.9.1",
}


def hide_types(path):
    """Stores elements as ones of unknown type (VR UN), as archives do that do not know them."""
    content = path.read_bytes()
    for group, element, vr in [(0x20, 0xE, "UI"), (0x20, 0x32, "DS"), (0x28, 4, "CS"), (0x28, 0x10, "US"), (0x28, 0x30, "DS"), (0x28, 0x1052, "DS")]:
        at = content.index(struct.pack("<HH", group, element) + vr.encode())
        length = struct.unpack_from("<H", content, at + 6)[0]
        content = content[: at + 4] + b"UN\0\0" + struct.pack("<I", length) + content[at + 8 :]
    path.write_bytes(content)


def strip_start(path, case):
    """Takes away the preamble ("bare"), and the meta information ("bare_data"; "bare_implicit": in implicit VR)."""
    d = dcmread(path)
    if case == "bare":
        path.write_bytes(path.read_bytes()[132:])
        return
    d.is_implicit_VR = case == "bare_implicit"
    d.preamble, d.file_meta = None, FileMetaDataset()
    d.save_as(path, write_like_original=True)


def make(case, folder):
    rng = random.Random(case)
    files = folder / "dicom"
    files.mkdir(parents=True)
    c, s = np.cos(np.radians(20)), np.sin(np.radians(20))
    orientation = {"oblique": (c, s, 0, -s * c, c * c, s), "coronal": (1, 0, 0, 0, 0, -1)}.get(case, (1, 0, 0, 0, 1, 0))
    row, column = np.array(orientation[:3]), np.array(orientation[3:])
    normal = np.cross(row, column)
    step = STEP * normal
    if case == "tilt":
        step = step + np.tan(np.radians(15)) * STEP * column
    stored = stored_values()
    truth = stored - 1024.0
    names, numbers = rng.sample(range(100), NZ), rng.sample(range(1000), NZ)

    def save(d, name):
        d.save_as(files / name, write_like_original=False)

    for k in range(NZ):
        if case == "missing" and k in (3, 4, 7):
            continue
        d = new_slice(case, k)
        d.InstanceNumber = numbers[k]
        position = ORIGIN + k * step
        if case in ("rounded", "rounded_missing"):  # 2.53 mm steps written with one digit
            position = ORIGIN + k * 1.012 * step
            position = np.round(position + 0.04 * normal, 1)
            if case == "rounded_missing" and k == 1:
                continue
        if case == "jitter":
            position = position + (0.2 if k == 4 else 0) * normal
        if case == "far":
            position = position + (1e25 if k == NZ - 1 else 0) * normal
        if case == "shifted":
            position = position + (0.5 if k == 4 else 0) * row
        place(d, orientation, position)
        set_pixels(d, stored[k])
        if case == "fraction":
            d.RescaleSlope, d.RescaleIntercept = 0.5, -0.25
            truth[k] = stored[k] * 0.5 - 0.25
        if case == "slopes":
            d.RescaleSlope, d.RescaleIntercept = f"{1 + 0.001 * k:g}", 0
            truth[k] = stored[k] * (1 + 0.001 * k)
        if case == "masked":  # 12 signed bits above 2 unused ones, rubbish in the rest
            d.BitsStored, d.HighBit, d.RescaleIntercept = 12, 13, 0
            value = stored[k] - 1500
            set_pixels(d, ((value & 0xFFF) << 2) | (rng.randrange(4) << 14) | rng.randrange(4), "<u2")
            truth[k] = value
        if case == "bytes":
            d.BitsAllocated, d.BitsStored, d.HighBit, d.PixelRepresentation, d.RescaleIntercept = 8, 8, 7, 0, 0
            set_pixels(d, stored[k] % 256, "u1")
            truth[k] = stored[k] % 256
        if case == "unsigned":
            d.PixelRepresentation, d.RescaleIntercept = 0, 0
            set_pixels(d, stored[k] + 60000, "<u2")
            truth[k] = stored[k] + 60000
        if case == "wide":
            d.BitsAllocated, d.BitsStored, d.HighBit, d.RescaleIntercept = 32, 32, 31, 0
            set_pixels(d, stored[k] * -100000, "<i4")
            truth[k] = stored[k] * -100000
        if case == "implicit":
            d.file_meta.TransferSyntaxUID, d.is_implicit_VR = ImplicitVRLittleEndian, True
        if case == "big_endian":
            d.file_meta.TransferSyntaxUID, d.is_little_endian = "1.2.840.10008.1.2.2", False
            set_pixels(d, stored[k], ">i2")
        if case == "deflated":
            d.file_meta.TransferSyntaxUID = "1.2.840.10008.1.2.1.99"
        if case == "rle":
            d.compress(RLELossless)
        if case == "inverted":
            d.PhotometricInterpretation = "MONOCHROME1"
        if case == "mpeg":  # refused by name, so the pixels need not be real
            d.file_meta.TransferSyntaxUID = MPEG2
            d.PixelData = encapsulate([b"\0" * 64])
            d["PixelData"].is_undefined_length = True
        if case == "colour":
            d.PhotometricInterpretation, d.SamplesPerPixel, d.PlanarConfiguration = "RGB", 3, 0
            d.BitsAllocated, d.BitsStored, d.HighBit, d.PixelRepresentation = 8, 8, 7, 0
            set_pixels(d, np.repeat(stored[k] % 256, 3), "u1")
        if case == "acquisitions":  # differs from slice to slice without meaning anything
            d.AcquisitionNumber = k + 1
        if case == "anonymised":
            d.FrameOfReferenceUID = uid(case, "frame", k)
        if case == "no_frame":
            del d.FrameOfReferenceUID
        if case == "mosaic":
            d.ImageType = ["ORIGINAL", "PRIMARY", "M", "ND", "MOSAIC"]
        if case == "own_damaged" and k == 5:
            d.RescaleSlope = 0
        if case == "numbered":
            d.InstanceNumber = 54321
        if case == "patients":
            d.PatientID = "P1" if k < 5 else "P2"
        if case == "padded":
            d.PixelData += bytes(128)
        if case == "trailing":
            d.add_new(0xFFFCFFFC, "OB", bytes(100))
        if case in NEW_SYNTAXES:  # refused by name, so the pixels need not be real
            d.file_meta.TransferSyntaxUID = MPEG2  # of the same length, and known to pydicom
            d.PixelData = encapsulate([b"\0" * 64])
            d["PixelData"].is_undefined_length = True
        name = f"f{names[k]:04d}.dcm"
        save(d, name)
        if case in NEW_SYNTAXES:
            (files / name).write_bytes((files / name).read_bytes().replace(MPEG2.encode(), NEW_SYNTAXES[case].encode()))
        if case == "unknown_types":
            hide_types(files / name)
        if case == "filled":
            (files / name).write_bytes((files / name).read_bytes() + bytes(510))
        if case.startswith("bare"):
            strip_start(files / name, case)
        if case == "truncated" and k == 5:
            content = (files / name).read_bytes()
            (files / name).write_bytes(content[:-100])
        if case == "numbered":  # what pydicom refuses to write
            (files / name).write_bytes((files / name).read_bytes().replace(b"54321", b"543.0"))
        if case == "duplicated" and k == 5:
            (files / "copy.dcm").write_bytes((files / name).read_bytes())
        if case == "doubled" and k == 5:
            d.SOPInstanceUID = d.file_meta.MediaStorageSOPInstanceUID = uid(case, "another")
            save(d, "copy.dcm")
        if case in ("echoes", "times", "other_series"):
            series = "other" if case == "other_series" else "only"
            d2 = new_slice(case, f"{k} again", series)
            place(d2, orientation, position)
            set_pixels(d2, stored[k] + 1)
            if case == "echoes":
                d.EchoNumbers, d2.EchoNumbers = 1, 2
            if case == "times":  # no two slices share a time
                d.TriggerTime, d2.TriggerTime = f"{300 - k}", f"{700 - 3 * k}"
            save(d, name)
            save(d2, f"a{names[k]:04d}.dcm")
    if case == "other_damaged":
        d = new_slice(case, "capture", "other")
        place(d, orientation, ORIGIN)
        set_pixels(d, stored[0])
        d.RescaleSlope = 0
        save(d, "capture.dcm")
    if case == "company":
        (files / "README.txt").write_text("not DICOM")
        (files / "empty").write_bytes(b"")
        d = new_slice(case, "structures", "structures")
        for word in ("Rows", "Columns", "PixelSpacing", "RescaleSlope"):
            delattr(d, word)
        d.Modality = "RTSTRUCT"
        save(d, "structures.dcm")
        d = new_slice(case, "capture", "capture")
        set_pixels(d, stored[0])
        save(d, "capture.dcm")

    affine = np.column_stack([row * SPACING[1], column * SPACING[0], step, ORIGIN])
    write_truth(folder, affine, truth)


def write_cine(folder, frames, voxels, spacing, origin):
    """An empty series of a gated scan, cubes of so many voxels: 40 ms apart, a beat as long as all frames. Trigger times differ from
    slice to slice and are rounded."""
    folder.mkdir()
    for n in range(frames):
        for k in range(voxels):
            d = new_slice("cine", f"{n} {k}")
            d.Rows = d.Columns = voxels
            d.PixelSpacing, d.SliceThickness = [spacing, spacing], spacing
            place(d, (1, 0, 0, 0, 1, 0), (origin, origin, origin + spacing * k))
            d.TriggerTime, d.NominalInterval = f"{15 + 40 * n + k % 2}", f"{40 * frames}"
            set_pixels(d, np.full((voxels, voxels), n))
            d.save_as(folder / f"{(7 * n + k) % 8}{n}{k}.dcm", write_like_original=False)


def write_phases(folder, frames, voxels, spacing, origin):
    """The same, empty, of a breath: each phase is a series, named by its per cent of the cycle."""
    folder.mkdir()
    for n in range(frames):
        for k in range(voxels):
            d = new_slice("breath", f"{n} {k}", f"phase {n}")
            d.SeriesDescription = f"P4 Gated, {100 * n / frames:.1f}%"
            d.Rows = d.Columns = voxels
            d.PixelSpacing, d.SliceThickness = [spacing, spacing], spacing
            place(d, (1, 0, 0, 0, 1, 0), (origin, origin, origin + spacing * k))
            set_pixels(d, np.full((voxels, voxels), n))
            d.save_as(folder / f"{(7 * n + k) % 8}{n}{k}.dcm", write_like_original=False)


# Parametric maps (PS3.3 C.7.6.24 and C.7.6.25): element, type, bits.
FLOATING = {"enhanced_float": ("FloatPixelData", "<f4", 32), "enhanced_double": ("DoubleFloatPixelData", "<f8", 64)}


def group(**values):
    item = Dataset()
    for word, value in values.items():
        setattr(item, word, value)
    return Sequence([item])


def make_enhanced(case, folder):
    """Frames in no order in one file ("enhanced_files": in two), whose order in the file never is that in space."""
    files = folder / "dicom"
    files.mkdir(parents=True)
    rng = random.Random(case)
    c, s = np.cos(np.radians(20)), np.sin(np.radians(20))
    row, column = np.array((c, s, 0)), np.array((-s * c, c * c, s))
    normal = np.cross(row, column)
    column = np.cross(normal / np.linalg.norm(normal), row)
    normal = np.cross(row, column)
    stored = stored_values()
    truth = stored - 1024.0
    volumes = 2 if case in ("enhanced_echoes", "enhanced_ambiguous") else 1
    order = [(v, k) for v in range(volumes) for k in range(NZ) if not (case == "enhanced_missing" and k == 4)]
    rng.shuffle(order)
    halves = [order[:5], order[5:]] if case == "enhanced_files" else [order]
    for number, half in enumerate(halves):
        d = new_slice(case, f"frames {number}")
        d.SOPClassUID = d.file_meta.MediaStorageSOPClassUID = CT + ".1" if case != "enhanced_echoes" else "1.2.840.10008.5.1.4.1.1.4.1"
        for word in ("PixelSpacing", "SliceThickness", "RescaleSlope", "RescaleIntercept"):
            delattr(d, word)
        d.NumberOfFrames = len(half)
        shared = Dataset()
        shared.PlaneOrientationSequence = group(ImageOrientationPatient=[f"{v:.9f}" for v in (*row, *column)])
        shared.PixelMeasuresSequence = group(PixelSpacing=list(SPACING), SliceThickness=STEP)
        if case != "enhanced_slopes":
            shared.PixelValueTransformationSequence = group(RescaleIntercept=-1024, RescaleSlope=1, RescaleType="HU")
        d.SharedFunctionalGroupsSequence = Sequence([shared])
        frames = []
        for v, k in half:
            frame = Dataset()
            frame.PlanePositionSequence = group(ImagePositionPatient=[f"{p:.6f}" for p in ORIGIN + k * STEP * normal])
            if case == "enhanced_echoes":
                frame.MREchoSequence = group(EffectiveEchoTime=(2.5, 4.75)[v])
            if case == "enhanced_slopes":
                frame.PixelValueTransformationSequence = group(RescaleIntercept=k, RescaleSlope=1 + k / 4, RescaleType="US")
                truth[k] = stored[k] * (1 + k / 4) + k
            if case == "enhanced_incomplete" and len(frames) == 5:
                del frame.PlanePositionSequence
            frames.append(frame)
        d.PerFrameFunctionalGroupsSequence = Sequence(frames)
        set_pixels(d, np.array([stored[k] + v for v, k in half]))
        if case == "enhanced_rle":
            d.compress(RLELossless)
        if case in FLOATING:
            word, kind, bits = FLOATING[case]
            setattr(d, word, np.array([stored[k] for v, k in half], kind).tobytes())
            d.BitsAllocated = bits
            for word in ("PixelData", "BitsStored", "HighBit", "PixelRepresentation"):
                delattr(d, word)
        d.save_as(files / f"enhanced{number}.dcm", write_like_original=False)
    write_truth(folder, np.column_stack([row * SPACING[1], column * SPACING[0], STEP * normal, ORIGIN]), truth)


def write_truth(folder, affine, truth):
    lines = [f"{NX} {NY} {NZ}"] + [" ".join(repr(float(v)) for v in line) for line in affine]
    (folder / "truth.txt").write_text("\n".join(lines) + "\n")
    (folder / "truth.raw").write_bytes(truth.astype("<f8").tobytes())


if __name__ == "__main__":
    case, folder = sys.argv[1], Path(sys.argv[2])
    if case == "odd":  # slices of 63 pixels: bits of one do not fill its last byte
        NY, NX = 9, 7
    if case in ("cine", "breath"):
        folder.mkdir()
        (write_cine if case == "cine" else write_phases)(folder / "dicom", 4, 5, 2.0, -4.0)
    else:
        make_enhanced(case, folder) if case.startswith("enhanced") else make(case, folder)
