# SPDX-License-Identifier: Apache-2.0
"""An archive that misbehaves in a way that is chosen, and what each way makes of find, fetch and send."""
import json
import time

import pydicom
from support import BORDER, JSON, Archive

INPUT, CORRUPT, IO, TOO_LARGE, STOPPED = 65, 66, 74, 77, 130
PARTS = f'multipart/related; type="application/dicom"; boundary={BORDER}'


def is_series(handler, path):
    return handler.command == "GET" and "/series/" in path and not path.endswith("/instances")


def is_series_or_object(handler, path):
    return is_series(handler, path) and not path.endswith("/series")


class Hostile(Archive):
    """Each do_FAULT answers in place of the archive, or lets it answer."""

    def status(self, handler, status, **headers):
        self.reply(handler, status, "text/html", b"<p>secret-of-the-server</p>", **headers)
        return True

    def do_401(self, handler, path):
        return self.status(handler, 401)

    def do_403(self, handler, path):
        return self.status(handler, 403)

    def do_404(self, handler, path):
        return self.status(handler, 404)

    def do_500(self, handler, path):
        return self.status(handler, 500)

    def do_409(self, handler, path):
        return handler.command == "POST" and self.status(handler, 409)

    def do_413(self, handler, path):
        return handler.command == "POST" and self.status(handler, 413)

    def do_failed(self, handler, path):
        if handler.command == "POST":
            uid = {"00081155": {"vr": "UI", "Value": [self.sent]}, "00081197": {"vr": "US", "Value": [0x0122]}}
            self.reply(handler, 409, JSON, json.dumps({"00081198": {"vr": "SQ", "Value": [uid]}}).encode())
            return True

    def do_changed(self, handler, path):
        if handler.command == "POST":
            uid = {"00081155": {"vr": "UI", "Value": [self.sent]}, "00081196": {"vr": "US", "Value": [0xB000]}}
            self.reply(handler, 202, JSON, json.dumps({"00081199": {"vr": "SQ", "Value": [uid]}}).encode())
            return True

    def do_redirect(self, handler, path):
        return self.status(handler, 302, Location=self.elsewhere + "/dicom-web" + path + "?token=secret-of-the-server")

    def do_redirect_here(self, handler, path):
        if "/moved" not in handler.path:
            return self.status(handler, 301, Location=handler.path.replace("/dicom-web", "/dicom-web/moved"))

    def do_redirect_for_ever(self, handler, path):
        return self.status(handler, 301, Location=handler.path)

    def do_early(self, handler, path):
        if is_series_or_object(handler, path):
            body = self.parts(self.objects.values())
            self.reply(handler, 200, PARTS, body[: len(body) // 2], length=len(body))
            handler.close_connection = True
            return True

    def do_early_without_length(self, handler, path):
        if is_series_or_object(handler, path):
            handler.send_response(200)
            handler.send_header("Content-Type", PARTS)
            handler.send_header("Connection", "close")
            handler.end_headers()
            body = self.parts(self.objects.values())
            handler.wfile.write(body[: len(body) // 2])
            handler.close_connection = True
            return True

    def do_wrong_border(self, handler, path):
        if is_series_or_object(handler, path):
            self.reply(handler, 200, PARTS, self.parts(self.objects.values(), "another"))
            return True

    def do_no_border(self, handler, path):
        if is_series_or_object(handler, path):
            self.reply(handler, 200, "multipart/related", self.parts(self.objects.values()))
            return True

    def do_html(self, handler, path):
        self.reply(handler, 200, "text/html", b"<p>log in first</p>")
        return True

    def do_no_json(self, handler, path):
        self.reply(handler, 200, JSON, b'[{"0020000D": ')
        return True

    def do_no_dicom(self, handler, path):
        if is_series_or_object(handler, path):
            self.reply(handler, 200, PARTS, self.parts([b"no DICOM"] * len(self.objects)))
            return True

    def do_twice(self, handler, path):
        if is_series_or_object(handler, path):
            self.reply(handler, 200, PARTS, self.parts([next(iter(self.objects.values()))] * len(self.objects)))
            return True

    def do_fewer(self, handler, path):
        if is_series_or_object(handler, path):
            self.reply(handler, 200, PARTS, self.parts(list(self.objects.values())[:5]))
            return True

    def for_ever(self, handler, kind, piece, pause):
        handler.send_response(200)
        handler.send_header("Content-Type", kind)
        handler.send_header("Connection", "close")
        handler.end_headers()
        handler.close_connection = True
        try:
            while True:
                handler.wfile.write(piece)
                time.sleep(pause)
        except OSError:
            return True

    def do_endless_json(self, handler, path):
        return self.for_ever(handler, JSON, b" " * 1_000_000, 0)

    def do_endless_parts(self, handler, path):
        return is_series_or_object(handler, path) and self.for_ever(handler, PARTS, self.parts(self.objects.values())[: -len(BORDER) - 6], 0)

    def do_dripping(self, handler, path):
        return is_series_or_object(handler, path) and self.for_ever(handler, PARTS, b"-", 0.2)

    def do_silent(self, handler, path):
        time.sleep(30)
        return True

    def do_slow(self, handler, path):
        """Three of nine, then next to nothing."""
        if is_series_or_object(handler, path):
            body = self.parts(list(self.objects.values())[:3])
            self.reply(handler, 200, PARTS, body[: -len("--\r\n")], length=10 * len(body))
            time.sleep(30)
            return True


FAULTS = [
    ("401", IO, "--credentials"),
    ("403", IO, "does not let this user"),
    ("404", INPUT, "does not have"),
    ("500", IO, "500"),
    ("redirect", IO, "leads on to http://127.0.0.1:"),
    ("redirect-for-ever", IO, "more than 5 times"),
    ("early", IO, "ended early"),
    ("early-without-length", IO, "ended early"),
    ("wrong-border", CORRUPT, "border"),
    ("no-border", CORRUPT, "names no border"),
    ("html", CORRUPT, "text/html"),
    ("no-json", CORRUPT, "no JSON"),
    ("no-dicom", CORRUPT, "no DICOM file"),
    ("twice", CORRUPT, "sent before"),
    ("fewer", IO, "5 of the 9"),
    ("endless-json", TOO_LARGE, "67108864 bytes"),
    ("endless-parts", CORRUPT, "sent before"),
    ("dripping", IO, "--give-up-s"),
    ("silent", IO, "--give-up-s"),
    ("slow", IO, "--give-up-s"),
]

STOW_FAULTS = [("401", IO, "--credentials"), ("403", IO, "does not let"), ("409", IO, "409"), ("413", TOO_LARGE, "new.dcm"), ("redirect", IO, "leads on"), ("failed", IO, "no objects of this class (0122)")]


def made_file(tmp_path, files):
    """A new object of the archive's study."""
    dataset = pydicom.dcmread(files[0])
    dataset.SOPInstanceUID = dataset.file_meta.MediaStorageSOPInstanceUID = pydicom.uid.generate_uid()
    dataset.SeriesInstanceUID = pydicom.uid.generate_uid()
    dataset.save_as(tmp_path / "new.dcm")
    return tmp_path / "new.dcm", str(dataset.SOPInstanceUID)
