# SPDX-License-Identifier: Apache-2.0
"""The library's errors. All of them are `Error`; each is also the built-in exception that a Python caller would expect."""


class Error(Exception):
    """What went wrong: one sentence that names the thing, the number and the limit.

    Attributes
    ----------
    kind : str
        The same word as in the library and in reports, such as 'invalid_input'.

    Examples
    --------
    >>> try:
    ...     kontur.read_image("missing.nii.gz")
    ... except kontur.Error as error:
    ...     error.kind
    'io'
    """

    kind = ""


class InvalidInputError(Error, ValueError):
    """The caller's contours, options or arguments cannot be used."""

    kind = "invalid_input"


class UnsupportedError(Error, NotImplementedError):
    """Well-formed, but a variant that kontur does not handle."""

    kind = "unsupported"


class CorruptFileError(Error, ValueError):
    """A file's content contradicts its format or itself."""

    kind = "corrupt_file"


class FileError(Error, OSError):
    """The operating system refused to read or write."""

    kind = "io"


class MissingFileError(FileError, FileNotFoundError):
    """There is no file or folder at a path that was to be read."""


class SingularSystemError(Error, ArithmeticError):
    """The linear system has no unique solution."""

    kind = "singular_system"


class TooLargeError(Error, MemoryError):
    """A stated limit on size, memory or count would be exceeded."""

    kind = "too_large"


class CancelledError(Error):
    """The caller asked to stop."""

    kind = "cancelled"


_BY_KIND = {error.kind: error for error in Error.__subclasses__()}


def from_kind(kind, message):
    """The exception for the library's error of this kind."""
    return _BY_KIND[kind](message)
