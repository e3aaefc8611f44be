# SPDX-License-Identifier: Apache-2.0
"""Starts `kontur open` and speaks to it as a browser's page does: HTTP, and a WebSocket of a few lines."""
import base64
import contextlib
import hashlib
import http.client
import json
import math
import os
import pathlib
import signal
import socket
import struct
import subprocess

import nibabel
import numpy

KONTUR = os.environ["KONTUR_CLI"]


class Server:
    """A running `kontur open`."""

    def __init__(self, folder, *words, token="secret", **options):
        self.folder, self.token = pathlib.Path(folder), token
        environment = {**os.environ, "XDG_DATA_HOME": str(self.folder / "data"), "TMPDIR": str(self.folder), **options}
        self.process = subprocess.Popen(
            [KONTUR, "open", *map(str, words), "--no-browser", "--token", token, "--timeout", "300"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL, env=environment,
        )
        self._take(self.process.stdout.readline())
        self.project = pathlib.Path(self.process.stdout.readline().split(";")[0].removeprefix("project "))

    def _take(self, line):
        self.address = line.strip()
        assert self.address, self.process.stderr.read()
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.host = f"127.0.0.1:{self.port}"

    @classmethod
    def of(cls, process, address, token):
        """One that was started otherwise, and has told its address."""
        server = cls.__new__(cls)
        server.process, server.token = process, token
        server._take(address)
        return server

    def stop(self, how=signal.SIGINT):
        self.process.send_signal(how)
        code = self.process.wait(60)
        self.process.stdout.close()
        self.process.stderr.close()
        return code

    def request(self, method, target, body=None, headers=None):
        """(status, headers, body) as a page of ours would ask for it; `headers` overrides, None removes."""
        send = {"Host": self.host, "Origin": f"http://{self.host}", "Authorization": f"Bearer {self.token}"}
        send.update(headers or {})
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.putrequest(method, target, skip_host=True, skip_accept_encoding=True)
        for key, value in send.items():
            if value is not None:
                connection.putheader(key, value)
        if body is not None:
            connection.putheader("Content-Length", str(len(body)))
        connection.endheaders(body)
        reply = connection.getresponse()
        result = reply.status, dict(reply.getheaders()), reply.read()
        connection.close()
        return result

    def binary(self, method, target, body=None):
        """(JSON, arrays) of a binary reply."""
        status, _, data = self.request(method, target, body)
        assert status == 200, data
        return self.parts(data)

    @staticmethod
    def parts(data):
        """(JSON, arrays) of the bytes of a binary reply."""
        size = struct.unpack_from("<I", data)[0]
        head = json.loads(data[4 : 4 + size])
        types = {"u8": "u1", "u16": "<u2", "u32": "<u4", "f32": "<f4"}
        arrays = {
            name: numpy.frombuffer(data, types[a["type"]], a["count"], 4 + size + a["offset"])
            for name, a in head["arrays"].items()
        }
        return head, arrays

    def slice(self, plane, width=64, height=64, **more):
        request = {"view": "test", "plane": plane, "width": width, "height": height, "window": {"center": -450, "width": 1100}}
        return self.binary("POST", "/api/slice", json.dumps({**request, **more}).encode())

    def page(self):
        return Page(self)


class Page:
    """One WebSocket. Keeps every event; `state` is what a page would show."""

    def __init__(self, server, greeted=True):
        self.socket = socket.create_connection(("127.0.0.1", server.port), timeout=120)
        self.buffer, self.events, self.calls = bytearray(), [], 0
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /api/socket HTTP/1.1\r\nHost: {server.host}\r\nOrigin: http://{server.host}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Protocol: kontur, {server.token}\r\n\r\n".encode()
        )
        head = self._until(b"\r\n\r\n").decode()
        assert head.startswith("HTTP/1.1 101"), head
        accept = hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()
        assert f"Sec-WebSocket-Accept: {base64.b64encode(accept).decode()}" in head
        assert "Sec-WebSocket-Protocol: kontur\r\n" in head
        if not greeted:
            return
        self.greeting = self.receive()
        if self.greeting["event"] == "start":
            self.events = []
            return
        self.session = self.greeting
        assert self.session["event"] == "session"
        self.structures = {s["id"]: s for s in self.session["structures"]}
        self.contours = {c["id"]: c for c in self.session["contours"]}
        self.history = self.session["history"]

    def close(self):
        self.socket.close()

    def _read(self, count):
        while len(self.buffer) < count:
            more = self.socket.recv(1 << 20)
            if not more:
                raise ConnectionError("the server closed the connection")
            self.buffer += more
        data = bytes(self.buffer[:count])
        del self.buffer[:count]
        return data

    def _until(self, end):
        data = b""
        while not data.endswith(end):
            data += self._read(1)
        return data

    def send_frame(self, payload, opcode=1):
        mask = os.urandom(4)
        size = len(payload)
        length = struct.pack(">B", 128 | size) if size < 126 else struct.pack(">BH", 254, size) if size < 1 << 16 else struct.pack(">BQ", 255, size)
        masked = bytes(numpy.frombuffer(payload, "u1") ^ numpy.resize(numpy.frombuffer(mask, "u1"), size)) if size else b""
        self.socket.sendall(bytes([128 | opcode]) + length + mask + masked)

    def receive_frame(self):
        first, size = self._read(2)
        if size == 126:
            size = struct.unpack(">H", self._read(2))[0]
        elif size == 127:
            size = struct.unpack(">Q", self._read(8))[0]
        return first & 15, self._read(size)

    def receive(self):
        """The next JSON message; pings are answered."""
        while True:
            opcode, payload = self.receive_frame()
            if opcode == 9:
                self.send_frame(payload, 10)
            elif opcode == 8:
                raise ConnectionError(f"closed with {struct.unpack('>H', payload[:2])[0] if payload else 'no code'}")
            elif opcode == 1:
                return json.loads(payload)

    def _apply(self, event):
        self.events.append(event)
        if event["event"] != "changed":
            return
        for kind, items in (("structures", self.structures), ("contours", self.contours)):
            items.update({row["id"]: row for row in event[kind]["set"]})
            for removed in event[kind]["removed"]:
                items.pop(removed, None)
        self.history = event["history"]

    def ask(self, call, **arguments):
        """The whole reply to a call; events on the way are applied."""
        self.calls += 1
        self.send_frame(json.dumps({"seq": self.calls, "call": call, **arguments}).encode())
        while True:
            message = self.receive()
            if "event" not in message:
                assert message["seq"] == self.calls, message
                return message
            self._apply(message)

    def do(self, call, **arguments):
        """The result of a call that succeeds."""
        reply = self.ask(call, **arguments)
        assert "result" in reply, reply
        return reply["result"]

    def refused(self, call, **arguments):
        """The error of a call that does not."""
        reply = self.ask(call, **arguments)
        assert "error" in reply, reply
        return reply["error"]

    def wait_for_surface(self, structure, stage="finished"):
        """The first such surface among the events to come or not yet looked at."""
        while True:
            for at, event in enumerate(self.events):
                if event["event"] == "surface" and event["structure"] == structure and event["stage"] == stage:
                    del self.events[: at + 1]
                    return event
            self.events.clear()
            self._apply(self.receive())


@contextlib.contextmanager
def running(folder, *words, **options):
    server = Server(folder, *words, **options)
    try:
        yield server
    finally:
        server.stop(signal.SIGKILL)


def shifted(plane, width, height, mm_per_pixel):
    """The plane of a canvas whose middle is the plane's origin."""
    origin = numpy.array(plane["origin"]) - mm_per_pixel * (0.5 * (width - 1) * numpy.array(plane["u"]) + 0.5 * (height - 1) * numpy.array(plane["v"]))
    return {**plane, "origin": origin.tolist(), "mm_per_pixel": mm_per_pixel}


def at_offset(plane, offset_mm):
    return {**plane, "origin": (numpy.array(plane["origin"]) + offset_mm * numpy.array(plane["normal"])).tolist()}


def ring(plane, radius, count=12, center=(0.0, 0.0)):
    """Points of a circle on a plane."""
    o, u, v = (numpy.array(plane[k]) for k in ("origin", "u", "v"))
    angles = [2 * math.pi * i / count for i in range(count)]
    return [(o + (center[0] + radius * math.cos(a)) * u + (center[1] + radius * math.sin(a)) * v).tolist() for a in angles]


def spline_controls(points):
    return [{"at": p, "kind": "spline"} for p in points]


def write_image(path, radius=12.0):
    """A ball of 100 on -1000, oblique and anisotropic."""
    shape, spacing = (48, 40, 32), (1.0, 1.2, 1.5)
    turn = 0.2
    rotation = numpy.array([[numpy.cos(turn), -numpy.sin(turn), 0], [numpy.sin(turn), numpy.cos(turn), 0], [0, 0, 1]])
    affine = numpy.eye(4)
    affine[:3, :3] = rotation @ numpy.diag(spacing)
    affine[:3, 3] = (-20, -30, 7)
    index = numpy.stack(numpy.meshgrid(*(numpy.arange(n) for n in shape), indexing="ij"), -1)
    distance = numpy.linalg.norm((index - numpy.array(shape) // 2) * spacing, axis=-1)
    values = numpy.where(distance < radius, 100, -1000).astype(numpy.int16)
    nibabel.save(nibabel.Nifti1Image(values, affine), path)
