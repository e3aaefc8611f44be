# SPDX-License-Identifier: Apache-2.0
"""A small DICOMweb archive that can misbehave on purpose, and Debian's Orthanc."""
import contextlib
import http.server
import json
import os
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import sys
import threading
import time
import urllib.request

import pydicom
import pytest

KONTUR = os.environ["KONTUR_CLI"]
ROOT = pathlib.Path(__file__).parents[2]
PLUGIN = pathlib.Path("/usr/share/orthanc/plugins/libOrthancDicomWeb.so")
BORDER = "a-border"
JSON = "application/dicom+json"
NAMES = {"StudyInstanceUID": "0020000D", "SeriesInstanceUID": "0020000E", "SOPInstanceUID": "00080018", "Modality": "00080060",
         "InstanceNumber": "00200013", "NumberOfSeriesRelatedInstances": "00201209"}
FILTERS = {"StudyInstanceUID", "SOPInstanceUID", "InstanceNumber"}


def kontur(*words, cache=None, timeout=120, **environment):
    """The finished process, with a cache of its own and without the proxies of whoever runs the tests."""
    own = {name: value for name, value in os.environ.items() if "proxy" not in name.lower() and not name.startswith("KONTUR_ARCHIVE")}
    own |= {"XDG_CACHE_HOME": str(cache or "/nonexistent")} | environment
    return subprocess.run([KONTUR, *map(str, words)], capture_output=True, text=True, timeout=timeout, stdin=subprocess.DEVNULL, env=own)


def make_series(folder):
    """Nine axial slices; the files in their order."""
    subprocess.run([sys.executable, ROOT / "tests/support/make_dicom_series.py", "axial", folder], check=True)
    return sorted((folder / "dicom").iterdir())


def values(**tags):
    """An object of DICOM JSON: tags by their keyword."""
    return {NAMES[name]: {"vr": "UI", "Value": [value]} for name, value in tags.items()}


class Archive:
    """One study in memory. `fault` says what goes wrong; `requests` are all that came: method, path, headers; `queries` theirs."""

    def __init__(self, files=(), context=None):
        self.fault, self.requests, self.queries, self.stored, self.counts = "", [], [], {}, True
        self.first_number = 1
        self.objects = {}
        for file in files:
            header = pydicom.dcmread(file, stop_before_pixels=True)
            self.objects[str(header.SOPInstanceUID)] = file.read_bytes()
            self.study, self.series, self.modality = str(header.StudyInstanceUID), str(header.SeriesInstanceUID), header.Modality
        archive = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                archive.answer(self, b"")

            def do_POST(self):
                archive.answer(self, self.rfile.read(int(self.headers["Content-Length"])))

            def log_message(self, *words):
                pass

        class Server(http.server.ThreadingHTTPServer):
            daemon_threads, block_on_close = True, False

            def handle_error(self, *words):
                pass

        self.server = Server(("127.0.0.1", 0), Handler)
        if context:
            self.server.socket = context.wrap_socket(self.server.socket, server_side=True)
        self.port = self.server.server_address[1]
        self.address = f"{'https' if context else 'http'}://127.0.0.1:{self.port}/dicom-web"
        threading.Thread(target=self.server.serve_forever, args=(0.05,), daemon=True).start()

    def stop(self):
        self.server.shutdown()
        self.server.server_close()

    @property
    def series_address(self):
        return f"{self.address}/studies/{self.study}/series/{self.series}"

    def parts(self, objects, border=BORDER):
        body = b"".join(b"--%s\r\nContent-Type: application/dicom\r\n\r\n%s\r\n" % (border.encode(), data) for data in objects)
        return body + b"--%s--\r\n" % border.encode()

    def listed(self, path):
        """What QIDO answers; None for another path."""
        if re.fullmatch(r"/studies", path):
            return [values(StudyInstanceUID=self.study)]
        if path == f"/studies/{self.study}/series":
            count = {"NumberOfSeriesRelatedInstances": str(len(self.objects))} if self.counts else {}
            return [values(SeriesInstanceUID=self.series, Modality=self.modality, **count)]
        if path in (f"/studies/{self.study}/series/{self.series}/instances", f"/studies/{self.study}/instances"):
            return [values(SOPInstanceUID=uid, InstanceNumber=n + self.first_number) for n, uid in enumerate(self.objects)]
        return [] if path.startswith("/studies/") and path.endswith(("/series", "/instances")) else None

    def answer(self, handler, body):
        path, _, query = handler.path.removeprefix("/dicom-web").removeprefix("/moved").partition("?")
        self.requests.append((handler.command, path, dict(handler.headers)))
        self.queries.append(query)
        misbehave = getattr(self, "do_" + self.fault.replace("-", "_"), None)
        if misbehave and misbehave(handler, path):
            return
        if handler.command == "POST":
            return self.store(handler, path, body)
        found = self.listed(path)
        if found is not None:
            terms = dict(term.split("=", 1) for term in query.split("&") if "=" in term)
            for name in FILTERS & set(terms):
                found = [one for one in found if one.get(NAMES[name], {}).get("Value") in ([terms[name]], [int(terms[name])] if terms[name].isdigit() else None)]
            begin = int(terms.get("offset", 0))
            return self.reply(handler, 200, JSON, json.dumps(found[begin : begin + min(4, int(terms.get("limit", 4)))]).encode())
        if path.endswith("/rendered"):
            return self.reply(handler, 200, "image/jpeg", b"\xff\xd8\xff" + path.split("/")[-2].encode())
        uids = [path.split("/")[-1]] if "/instances/" in path else list(self.objects)
        if not path.startswith(f"/studies/{self.study}/series/{self.series}") or not set(uids) <= set(self.objects):
            return self.reply(handler, 404, "text/plain", b"nothing here")
        self.reply(handler, 200, f'multipart/related; type="application/dicom"; boundary={BORDER}', self.parts(self.objects[uid] for uid in uids))

    def store(self, handler, path, body):
        data = body.split(b"\r\n\r\n", 1)[1].rsplit(b"\r\n--", 1)[0]
        uid = str(pydicom.dcmread(pydicom.filebase.DicomBytesIO(data), stop_before_pixels=True).SOPInstanceUID)
        self.stored[uid] = data
        self.objects[uid] = data
        self.reply(handler, 200, JSON, json.dumps({"00081199": {"vr": "SQ", "Value": [{"00081155": {"vr": "UI", "Value": [uid]}}]}}).encode())

    def reply(self, handler, status, kind, body, length=None, **headers):
        handler.send_response(status)
        handler.send_header("Content-Type", kind)
        handler.send_header("Content-Length", str(len(body) if length is None else length))
        for name, value in headers.items():
            handler.send_header(name, value)
        handler.end_headers()
        with contextlib.suppress(OSError):
            handler.wfile.write(body)


def certificate(folder, name, *options):
    """A certificate for 127.0.0.1 that is its own authority, made by openssl; (certificate, key)."""
    files = folder / f"{name}.pem", folder / f"{name}.key"
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1"]
    subprocess.run([*command, "-out", files[0], "-keyout", files[1], *options], check=True, capture_output=True)
    return files


def context_of(certificate_and_key):
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(*certificate_and_key)
    return context


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Orthanc:
    """Debian's Orthanc with its DICOMweb plugin, on ports of its own."""

    def __init__(self, folder, port=None, **more):
        if not shutil.which("Orthanc") or not PLUGIN.exists():
            pytest.skip("orthanc or orthanc-dicomweb is not installed")
        self.port = port or free_port()
        settings = {"StorageDirectory": str(folder / "db"), "IndexDirectory": str(folder / "db"), "HttpPort": self.port, "DicomPort": free_port()}
        settings |= {"AuthenticationEnabled": False, "RemoteAccessAllowed": False, "Plugins": [str(PLUGIN)]} | more
        (folder / "orthanc.json").write_text(json.dumps(settings))
        self.log = open(folder / "orthanc.log", "w")
        self.process = subprocess.Popen(["Orthanc", folder / "orthanc.json"], stdout=self.log, stderr=self.log)
        self.rest = f"http://127.0.0.1:{self.port}"
        self.address = self.rest + "/dicom-web"
        for _ in range(300):
            with contextlib.suppress(OSError):
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return
            time.sleep(0.1)
        self.stop()
        pytest.fail("Orthanc does not start: " + (folder / "orthanc.log").read_text())

    def ask(self, path, data=None):
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        with opener.open(urllib.request.Request(self.rest + path, data=data), timeout=60) as answer:
            return json.load(answer)

    def put(self, files):
        for file in files:
            assert self.ask("/instances", pathlib.Path(file).read_bytes())["Status"] == "Success"

    def stop(self):
        self.process.terminate()
        self.process.wait(timeout=30)
        self.log.close()


@contextlib.contextmanager
def running(server):
    try:
        yield server
    finally:
        server.stop()
