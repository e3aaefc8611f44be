# SPDX-License-Identifier: Apache-2.0
"""An archive for the page's tests: Debian's Orthanc with nine axial slices in it, or the series in FOLDER/dicom. Prints its DICOMweb address, and ends with its
input. Exit code 77 where Orthanc is not installed.

python3 serve.py FOLDER [PORT]    # with a port: the archive of this folder comes back
"""
import pathlib
import shutil
import sys

import support

folder = pathlib.Path(sys.argv[1])
port = int(sys.argv[2]) if len(sys.argv) > 2 else None
if not shutil.which("Orthanc") or not support.PLUGIN.exists():
    sys.exit(77)
with support.running(support.Orthanc(folder, port)) as orthanc:
    if port is None:
        own = folder / "dicom"
        orthanc.put(sorted(own.iterdir()) if own.exists() else support.make_series(folder))
    print(orthanc.address, flush=True)
    sys.stdin.read()
