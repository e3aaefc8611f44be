# SPDX-License-Identifier: Apache-2.0
"""Images from an archive that speaks DICOMweb, and results back to it, as `kontur find`, `fetch` and `send` do.

An address is that of the service, such as 'https://archive.example/dicom-web', or of a study, a series or an object in it. All
functions take who asks, as keywords:

credentials : path
    A file of one line, user:password or Bearer TOKEN, which only its owner may read. Without it the variable
    KONTUR_ARCHIVE_CREDENTIALS counts.
ca : path
    The certificate of a private authority, in place of the system's.
give_up_s : int
    Seconds with less than 1 kB/s after which to give up.

libcurl is loaded with the first request, and UnsupportedError raised where there is none.

Examples
--------
>>> try:
...     kontur.archive.find("http://127.0.0.1:9/dicom-web")
... except kontur.FileError as error:
...     print(str(error)[:24])
cannot reach 127.0.0.1:9
"""
from ._core import _archive
from ._core._archive import *

__all__ = sorted(name for name in vars(_archive) if not name.startswith("_"))

# Where users find them, in messages and in pickles.
for _name in __all__:
    globals()[_name].__module__ = "kontur.archive"
del _name, _archive
