#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How fast `kontur fetch` takes a series from Debian's Orthanc, in turns with `curl` of the same series.

Usage: bench/archive.py KONTUR (--slices N, --side PIXELS, --repeat N)

Prints CSV: seconds of each, their ratio, bytes. curl writes one multipart file; kontur writes each object into a file of its
own, takes the list first, and has every file on the disk (fsync) before it ends. The times hang on the disk and on Orthanc,
so read the ratio.
"""
import argparse
import contextlib
import json
import pathlib
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request

import numpy
import pydicom

PLUGIN = "/usr/share/orthanc/plugins/libOrthancDicomWeb.so"
CT = "1.2.840.10008.5.1.4.1.1.2"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@contextlib.contextmanager
def orthanc(folder):
    port = free_port()
    settings = {"StorageDirectory": str(folder / "db"), "IndexDirectory": str(folder / "db"), "HttpPort": port, "DicomPort": free_port(),
                "AuthenticationEnabled": False, "RemoteAccessAllowed": False, "Plugins": [PLUGIN]}
    (folder / "orthanc.json").write_text(json.dumps(settings))
    with open(folder / "log", "w") as log:
        server = subprocess.Popen(["Orthanc", folder / "orthanc.json"], stdout=log, stderr=log)
    try:
        for _ in range(600):
            with contextlib.suppress(OSError):
                socket.create_connection(("127.0.0.1", port), 1).close()
                break
            time.sleep(0.1)
        yield f"http://127.0.0.1:{port}"
    finally:
        server.terminate()
        server.wait(60)


def put(rest, slices, side):
    """A series of noise; its address."""
    study, series = pydicom.uid.generate_uid(), pydicom.uid.generate_uid()
    random = numpy.random.default_rng(52)
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    for n in range(slices):
        dataset = pydicom.Dataset()
        dataset.file_meta = pydicom.dataset.FileMetaDataset()
        dataset.file_meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
        dataset.file_meta.MediaStorageSOPClassUID = dataset.SOPClassUID = CT
        dataset.file_meta.MediaStorageSOPInstanceUID = dataset.SOPInstanceUID = pydicom.uid.generate_uid()
        dataset.StudyInstanceUID, dataset.SeriesInstanceUID, dataset.Modality, dataset.PatientID = study, series, "CT", "bench"
        dataset.InstanceNumber, dataset.ImagePositionPatient, dataset.ImageOrientationPatient = n + 1, [0, 0, n], [1, 0, 0, 0, 1, 0]
        dataset.Rows, dataset.Columns, dataset.PixelSpacing, dataset.SamplesPerPixel = side, side, [0.7, 0.7], 1
        dataset.BitsAllocated, dataset.BitsStored, dataset.HighBit, dataset.PixelRepresentation = 16, 16, 15, 1
        dataset.PhotometricInterpretation = "MONOCHROME2"
        dataset.PixelData = random.integers(-1000, 1000, (side, side), numpy.int16).tobytes()
        dataset.is_little_endian, dataset.is_implicit_VR = True, False
        file = pydicom.filebase.DicomBytesIO()
        pydicom.dcmwrite(file, dataset, write_like_original=False)
        opener.open(urllib.request.Request(f"{rest}/instances", data=file.getvalue())).read()
    return f"{rest}/dicom-web/studies/{study}/series/{series}"


def seconds(*words):
    start = time.perf_counter()
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kontur", type=pathlib.Path)
    parser.add_argument("--slices", type=int, default=600)
    parser.add_argument("--side", type=int, default=512)
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args()
    if not shutil.which("Orthanc") or not pathlib.Path(PLUGIN).exists():
        sys.exit("orthanc or orthanc-dicomweb is not installed")
    print("slices,bytes,curl_s,kontur_s,kontur_speed_of_curl")
    with tempfile.TemporaryDirectory() as name, orthanc(pathlib.Path(name)) as rest:
        folder, ratios = pathlib.Path(name), []
        address = put(rest, options.slices, options.side)
        for n in range(options.repeat):
            accept = 'Accept: multipart/related; type="application/dicom"; transfer-syntax=*'
            curl = seconds("curl", "-s", "-f", "--noproxy", "*", "-H", accept, "-o", folder / "curl.out", address)
            kontur = seconds(options.kontur, "fetch", address, "-o", folder / f"out{n}")
            size = sum(path.stat().st_size for path in (folder / f"out{n}").iterdir())
            ratios.append(curl / kontur)
            print(f"{options.slices},{size},{curl:.2f},{kontur:.2f},{curl / kontur:.2f}", flush=True)
            shutil.rmtree(folder / f"out{n}")
        print(f"# median {statistics.median(ratios):.2f}")


if __name__ == "__main__":
    main()
