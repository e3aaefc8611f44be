# SPDX-License-Identifier: Apache-2.0
"""What a hostile web page, a scanner or a broken client may send. Each must be refused, and the server must live on."""
import concurrent.futures
import contextlib
import json
import os
import random
import socket
import struct
import time

import numpy
import pytest

from support import Page, running


SANITIZED = bool(os.environ.get("KONTUR_SANITIZED"))  # needs several times the memory, and keeps what was freed for a while
FUZZ = int(os.environ.get("KONTUR_FUZZ_ROUNDS", "300"))  # random paths, and as many messages: 100000 for people


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with running(tmp_path_factory.mktemp("hostile"), "phantom") as one:
        yield one
        assert one.page().do("ping") == {}


def raw(server, data, timeout=15):
    """The status of the reply to these bytes; None when the server just closes."""
    with socket.create_connection(("127.0.0.1", server.port), timeout=timeout) as connection:
        connection.sendall(data)
        reply = b""
        try:
            while b"\r\n" not in reply and (more := connection.recv(4096)):
                reply += more
        except ConnectionResetError:
            return None
    return int(reply.split()[1]) if reply else None


def head(server, method="GET", target="/", version="HTTP/1.1", host=None, origin=None, token=True, extra=""):
    lines = [f"{method} {target} {version}", f"Host: {server.host if host is None else host}"]
    lines += [f"Origin: {origin}"] if origin else []
    lines += [f"Authorization: Bearer {server.token}"] if token else []
    return ("\r\n".join(lines) + "\r\n" + extra + "\r\n").encode()


UPGRADE = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n"


def upgrade(server, origin="own", protocol="own", host=None, target="/api/socket"):
    origin = f"http://{server.host}" if origin == "own" else origin
    protocol = f"kontur, {server.token}" if protocol == "own" else protocol
    extra = UPGRADE + (f"Sec-WebSocket-Protocol: {protocol}\r\n" if protocol else "")
    return head(server, target=target, host=host, origin=origin, token=False, extra=extra)


BODY = b'{"plane": 1}'


def post(server, target, body, **more):
    return head(server, "POST", target, origin=f"http://{server.host}", extra=f"Content-Length: {len(body)}\r\n", **more) + body


# name, bytes to send, statuses that are right
REQUESTS = [
    ("rebound name", lambda s: head(s, host="attacker.example"), {421}),
    ("rebound name with our port", lambda s: head(s, host=f"attacker.example:{s.port}"), {421}),
    ("another port", lambda s: head(s, host="127.0.0.1:1"), {421}),
    ("no port", lambda s: head(s, host="127.0.0.1"), {421}),
    ("empty host", lambda s: head(s, host=""), {421}),
    ("user in host", lambda s: head(s, host=f"a@{s.host}"), {421}),
    ("host in upper case with dot", lambda s: head(s, host=f"LOCALHOST.:{s.port}"), {421}),
    ("private address", lambda s: head(s, host=f"192.168.0.1:{s.port}"), {421}),
    ("all addresses", lambda s: head(s, host=f"0.0.0.0:{s.port}"), {421}),
    ("no host", lambda s: b"GET / HTTP/1.1\r\n\r\n", {421}),
    ("no host in HTTP/1.0", lambda s: b"GET / HTTP/1.0\r\n\r\n", {421}),
    ("two hosts", lambda s: head(s, extra=f"Host: {s.host}\r\n"), {400, 421}),
    ("absolute address of another host", lambda s: head(s, target="http://attacker.example/"), {400}),
    ("foreign origin", lambda s: head(s, origin="http://attacker.example"), {403}),
    ("null origin", lambda s: head(s, origin="null"), {403}),
    ("origin with https", lambda s: head(s, origin=f"https://{s.host}"), {403}),
    ("origin of another port", lambda s: head(s, origin="http://127.0.0.1:1"), {403}),
    ("origin of the other loopback name", lambda s: head(s, origin=f"http://localhost:{s.port}"), {403}),
    ("POST without origin", lambda s: head(s, "POST", "/api/slice", extra=f"Content-Length: {len(BODY)}\r\n") + BODY, {403}),
    ("POST from a form", lambda s: head(s, "POST", "/api/slice", origin="http://attacker.example", token=False), {403}),
    ("no token", lambda s: head(s, target="/api/mesh/1", token=False), {401}),
    ("wrong token", lambda s: head(s, target="/api/mesh/1", token=False, extra="Authorization: Bearer wrong\r\n"), {401}),
    ("prefix of the token", lambda s: head(s, target="/api/mesh/1", token=False, extra="Authorization: Bearer secre\r\n"), {401}),
    ("token as basic authorization", lambda s: head(s, target="/api/mesh/1", token=False, extra="Authorization: Basic secret\r\n"), {401}),
    ("token in the address", lambda s: head(s, target=f"/api/mesh/1?token={s.token}", token=False), {401}),
    ("encoded address without token", lambda s: head(s, target="/%61pi/export/contours.json?structure=1", token=False), {401}),
    ("address encoded elsewhere without token", lambda s: head(s, target="/a%70i/export/project.kontur", token=False), {401}),
    ("encoded slash without token", lambda s: head(s, target="/api%2fexport/project.kontur", token=False), {401}),
    ("encoded import without token", lambda s: head(s, "POST", "/%61pi/import/contours?name=x.json", origin=f"http://{s.host}", token=False), {401}),
    ("malformed address without token", lambda s: head(s, target="/%zz", token=False), {401}),
    ("encoded import beyond the limit", lambda s: head(s, "POST", "/%61pi/import/mask?name=a.nii", origin=f"http://{s.host}", extra="Content-Length: 9000000000\r\n"), {413}),
    ("encoded slice beyond the limit", lambda s: head(s, "POST", "/%61pi/slice", origin=f"http://{s.host}", extra="Content-Length: 70000\r\n"), {413}),
    ("two authorizations", lambda s: head(s, target="/api/mesh/1", extra="Authorization: Bearer wrong\r\n"), {400, 401}),
    ("socket without origin", lambda s: upgrade(s, origin=None), {403}),
    ("socket with null origin", lambda s: upgrade(s, origin="null"), {403}),
    ("socket of a foreign page", lambda s: upgrade(s, origin="http://attacker.example"), {403}),
    ("socket by a rebound name", lambda s: upgrade(s, host="attacker.example"), {421}),
    ("socket without token", lambda s: upgrade(s, protocol=None), {401}),
    ("socket with a wrong token", lambda s: upgrade(s, protocol="kontur, wrong"), {401}),
    ("socket at another address", lambda s: upgrade(s, target="/"), {404}),
    ("plain GET of the socket", lambda s: head(s, target="/api/socket"), {404}),
    ("a file of the system", lambda s: head(s, target="/../../../../etc/passwd"), {404}),
    ("an encoded file of the system", lambda s: head(s, target="/%2e%2e/%2e%2e/etc/passwd"), {404}),
    ("an export beside the list", lambda s: head(s, target="/api/export/..%2f..%2fetc%2fpasswd?structure=1"), {415}),
    ("broken percent code", lambda s: head(s, target="/%zz"), {400}),
    ("a folder of the system", lambda s: head(s, target="/api/folder?path=/etc"), {400}),
    ("a folder by dots", lambda s: head(s, target="/api/folder?path=" + os.path.expanduser("~") + "/../../etc"), {400}),
    ("a folder without token", lambda s: head(s, target="/api/folder?path=/", token=False), {401}),
    ("a hidden folder", lambda s: head(s, target="/api/folder?path=" + os.path.expanduser("~") + "/.ssh"), {400}),
    ("no folder", lambda s: head(s, target="/api/folder"), {400}),
    ("series of the system", lambda s: head(s, target="/api/series?path=/proc"), {400}),
    ("a thumbnail of the system", lambda s: head(s, target="/api/thumbnail?file=/dev/zero"), {400}),
    ("opening a device", lambda s: post(s, "/api/open", b'{"path": "/dev/zero"}'), {400}),
    ("opening without token", lambda s: post(s, "/api/open", b'{"path": "phantom"}', token=False), {401}),
    ("opening from another page", lambda s: head(s, "POST", "/api/open", origin="http://attacker.example"), {403}),
    ("closing without origin", lambda s: head(s, "POST", "/api/close"), {403}),
    ("opening what is no path", lambda s: post(s, "/api/open", b'{"path": ["a"]}'), {400}),
    ("another session's slice", lambda s: post(s, "/api/slice", json.dumps(SLICE).encode()).replace(b"Content-Length", b"Kontur-Opening: 7\r\nContent-Length", 1), {400}),
    ("DELETE", lambda s: head(s, "DELETE"), {405}),
    ("preflight", lambda s: head(s, "OPTIONS", origin="http://attacker.example"), {403}),
    ("CONNECT", lambda s: head(s, "CONNECT", target="attacker.example:443"), {405, 400}),
    ("header of 9 KiB", lambda s: head(s, extra=f"X: {'x' * 9216}\r\n"), {431}),
    ("5000 headers", lambda s: head(s, extra="A: b\r\n" * 5000), {431, None}),
    ("body beyond the limit", lambda s: head(s, "POST", "/api/slice", origin=f"http://{s.host}", extra="Content-Length: 70000\r\n"), {413}),
    ("body of 2^63", lambda s: head(s, "POST", "/api/slice", origin=f"http://{s.host}", extra="Content-Length: 9223372036854775807\r\n"), {413}),
    ("body of 2^64", lambda s: head(s, "POST", "/api/slice", origin=f"http://{s.host}", extra="Content-Length: 18446744073709551616\r\n"), {400}),
    ("import beyond the limit", lambda s: head(s, "POST", "/api/import/mask?name=a.nii", origin=f"http://{s.host}", extra="Content-Length: 9000000000\r\n"), {413}),
    ("negative length", lambda s: head(s, "POST", "/api/slice", origin=f"http://{s.host}", extra="Content-Length: -1\r\n"), {400}),
    ("two lengths", lambda s: head(s, "POST", "/api/slice", origin=f"http://{s.host}", extra="Content-Length: 1\r\nContent-Length: 2\r\n"), {400}),
    ("chunks beyond the limit", lambda s: head(s, "POST", "/api/slice", origin=f"http://{s.host}", extra="Transfer-Encoding: chunked\r\n") + b"20000\r\n" + b"x" * 0x20000 + b"\r\n0\r\n\r\n", {413, None}),
    ("no HTTP", lambda s: b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", {400}),
    ("HTTP/2 preface", lambda s: b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", {400, 421, None}),
]


@pytest.mark.parametrize("request_bytes, statuses", [pytest.param(r, s, id=name.replace(" ", "-")) for name, r, s in REQUESTS])
def test_a_hostile_request_is_refused(server, request_bytes, statuses):
    assert raw(server, request_bytes(server)) in statuses


def test_at_least_40_hostile_requests_are_tried():
    assert len(REQUESTS) >= 40


def test_every_reply_carries_the_security_headers_and_none_opens_it_to_others(server):
    for target in ("/", "/nothing", "/api/mesh/1"):
        _, headers, _ = server.request("GET", target)
        assert headers["Content-Security-Policy"].startswith("default-src 'self'") and f"ws://{server.host};" in headers["Content-Security-Policy"]
        assert headers["X-Content-Type-Options"] == "nosniff" and headers["Cross-Origin-Resource-Policy"] == "same-origin"
        assert headers["Cache-Control"] == "no-store"
        assert not any(name.lower().startswith("access-control") for name in headers)


SLICE = {"view": "v", "plane": {"origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "normal": [0, 0, 1], "mm_per_pixel": 1},
         "width": 8, "height": 8, "window": {"center": 0, "width": 1}}


@pytest.mark.parametrize(
    "change",
    [{"width": 0}, {"width": 4097}, {"width": 1e99}, {"height": -1}, {"height": 1.5}, {"window": {"center": 0, "width": 0}},
     {"window": None}, {"plane": {}}, {"plane": {**SLICE["plane"], "u": [2, 0, 0]}}, {"plane": {**SLICE["plane"], "v": [1, 0, 0]}},
     {"plane": {**SLICE["plane"], "mm_per_pixel": 0}}, {"plane": {**SLICE["plane"], "origin": [1e9, 0, 0]}}, {"pixels": 1}],
)
def test_a_slice_that_makes_no_sense_is_refused(server, change):
    status, _, body = server.request("POST", "/api/slice", json.dumps({**SLICE, **change}).encode())
    assert status == 400 and json.loads(body)["error"]["kind"] == "invalid_input"


def test_frames_beyond_the_limit_and_binary_ones_close_the_socket(server):
    for payload, opcode, code in ((b" " * ((4 << 20) + 1), 1, 1009), (b"{}", 2, 1003)):
        page = server.page()
        with pytest.raises((ConnectionError, BrokenPipeError)) as closed:
            page.send_frame(payload, opcode)
            page.receive()
        assert str(code) in str(closed.value) or isinstance(closed.value, (ConnectionResetError, BrokenPipeError))


def test_a_declared_frame_of_an_exabyte_closes_the_socket(server):
    page = server.page()
    page.socket.sendall(b"\x81\xff" + struct.pack(">Q", 1 << 60) + b"\0\0\0\0")
    with pytest.raises(ConnectionError):
        page.receive()


def test_messages_that_are_no_calls_are_answered(server):
    page = server.page()
    deep = b"[" * 100_000
    for payload in (b"", b"null", b"[]", b"{", b'{"seq": 1}', b'{"call": 1}', b'{"call": "undo", "call": {}}', deep, b'{"call": "\\ud800"}', b"1e999"):
        page.send_frame(payload)
        assert page.receive()["error"]["kind"] == "invalid_input"


def test_what_is_nested_deeply_is_refused(server):
    """Copying and writing JSON is recursive: it would overflow the stack."""
    page = server.page()
    for depth in (65, 30_000, 200_000):
        page.send_frame(b'{"seq": 1, "call": "page.save", "state": ' + b"[" * depth + b"]" * depth + b"}")
        error = page.receive()["error"]
        assert error == {"kind": "invalid_input", "message": "the message is nested deeper than 64 levels"}
    page.do("page.save", state={"[{": ["]" * 100, "[" * 100]})
    deep = json.dumps({**SLICE, "plane": {**SLICE["plane"], "x": "@"}}).replace('"@"', "[" * 30_000 + "]" * 30_000)
    status, _, body = server.request("POST", "/api/slice", deep.encode())
    assert status == 400 and "nested deeper" in json.loads(body)["error"]["message"]


def test_text_that_is_no_utf8_closes_the_socket(server):
    page = server.page()
    page.send_frame(b'{"call": "\xff\xfe"}')
    with pytest.raises(ConnectionError):
        page.receive()


def test_random_paths_lead_nowhere(server):
    choose = random.Random(FUZZ)
    parts = ["..", "%2e%2e", "%2f", "/", "//", "api", "mesh", "export", "import", "etc", "passwd", "%00", "~", "\\", "index.html", "?", "&", "=", ".", "assets", "😀", "%e2"]
    for number in range(FUZZ):
        if number % 3:
            target = "/" + "".join(choose.choice(parts) for _ in range(choose.randrange(1, 9)))
        else:  # any bytes that can stand in a request's first line
            target = "/" + "".join(chr(choose.randrange(33, 127)) for _ in range(choose.randrange(1, 40)))
        status = raw(server, head(server, target=target))
        assert status in (200, 400, 404, 415) and (status != 200 or "index.html" in target or set(target.split("?")[0]) <= {"/"}), target


def test_fuzzed_messages_change_nothing_that_was_not_asked_for(server):
    choose = random.Random(FUZZ + 1)
    page = server.page()
    calls = ["path", "outline", "contour.add", "contour.move_point", "contour.pull", "contour.redraw", "contour.copy", "contour.set", "structure.set", "value", "draft.drop"]
    values = [None, -1, 0, 1, 1e308, "x", "", [], {}, [0, 0, 0], [[0, 0, 0]] * 3, True, SLICE["plane"], [{"at": [0, 0, 0], "kind": "wire"}] * 2]
    names = ["id", "plane", "control", "at", "to", "from", "by", "path", "index", "structure", "closed", "offset_mm", "radius_mm", "draft"]
    for _ in range(FUZZ):
        reply = page.ask(choose.choice(calls), **{choose.choice(names): choose.choice(values) for _ in range(6)})
        assert "result" in reply or reply["error"]["kind"] in ("invalid_input", "too_large")


def test_a_slow_client_is_cut_off(server):
    """A header that trickles in never holds a connection for longer than the limit."""
    with socket.create_connection(("127.0.0.1", server.port), timeout=30) as connection:
        connection.sendall(b"GET / HTTP/1.1\r\nHost: ")
        started = time.monotonic()
        try:
            assert connection.recv(100) == b""
        except ConnectionResetError:
            pass
        assert time.monotonic() - started < 25


def is_closed(connection):
    try:
        return connection.recv(10) == b""
    except ConnectionResetError:
        return True


def trickle(connection):
    connection.sendall(b"GET / HTTP/1.1\r\nHost: ")


def ask_without_token(server):
    return lambda connection: connection.sendall(head(server, token=False))


def ask_without_listening(server):
    """For the largest file, and more often than the system's buffers hold."""
    return lambda connection: connection.sendall(200 * head(server, target="/assets/scene.js", token=False))


@pytest.mark.parametrize("saying", ["nothing", "a little", "no token", "no token, and deaf"])
def test_idle_connections_do_not_shut_the_page_out(server, saying):
    say = {"nothing": lambda _: None, "a little": trickle, "no token": ask_without_token(server), "no token, and deaf": ask_without_listening(server)}[saying]
    page = server.page()  # is open already, and stays
    many = []
    try:
        for _ in range(64):
            many.append(socket.create_connection(("127.0.0.1", server.port), timeout=15))
            with contextlib.suppress(ConnectionError):
                say(many[-1])
        assert server.request("GET", "/")[0] == 200
        other = server.page()
        assert other.do("ping") == {} and page.do("ping") == {}
        other.close()
    finally:
        for connection in many:
            connection.close()
        page.close()


def test_idle_connections_of_the_page_itself_make_room_for_another(server):
    """A browser keeps them for a while, and opens what was closed again; what is being answered stays."""
    many = [socket.create_connection(("127.0.0.1", server.port), timeout=15) for _ in range(32)]
    for connection in many:
        connection.sendall(head(server, target="/api/mesh/1"))
        assert connection.recv(1 << 16).startswith(b"HTTP/1.1 200")
    assert server.request("GET", "/")[0] == 200
    assert is_closed(many[0])
    for connection in many:
        connection.close()


def test_connections_beyond_the_limit_are_closed_and_then_there_is_room_again(server):
    many = [socket.create_connection(("127.0.0.1", server.port), timeout=15) for _ in range(40)]
    assert [is_closed(connection) for connection in many[:8]] == [True] * 8  # those that have said nothing for longest
    for connection in many:
        connection.close()
    for _ in range(50):
        if raw(server, head(server)) == 200:
            return
        time.sleep(0.1)
    pytest.fail("no connection was freed")


def test_pages_and_half_open_connections_come_and_go_at_once(server):
    """Each ends at another point: before a request, in a header, in a body, in a handshake, in a reply, in a call."""
    body = json.dumps({**SLICE, "width": 512, "height": 512}).encode()
    call = json.dumps({"seq": 1, "call": "path", "plane": SLICE["plane"], "control": [{"at": [0, 0, 0], "kind": "line"}]}).encode()
    beginnings = [b"", head(server)[:20], post(server, "/api/slice", body)[:-9], upgrade(server)[:60], post(server, "/api/slice", body),
                  upgrade(server), head(server, target="/assets/scene.js"), post(server, "/api/slice", b"{")]
    choose = random.Random(FUZZ + 2)
    page = server.page()

    def come_and_go(number):
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", server.port), timeout=15) as connection:
            connection.sendall(beginnings[number % len(beginnings)])
            how = number // len(beginnings) % 3
            if how == 1:
                connection.shutdown(socket.SHUT_WR)  # half open: it may still listen
            if how == 2:
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # a reset
            elif number % 5 == 0:
                connection.recv(100)

    def call_and_leave(_):
        with contextlib.suppress(OSError, AssertionError):  # there may be no room for another page
            other = Page(server)
            other.send_frame(call)
            other.close()

    with concurrent.futures.ThreadPoolExecutor(24) as threads:
        jobs = [(come_and_go, number) for number in range(240)] + [(call_and_leave, number) for number in range(24)]
        choose.shuffle(jobs)
        for done in [threads.submit(*job) for job in jobs]:
            done.result()
    assert page.do("ping") == {}
    for _ in range(100):
        if raw(server, head(server)) == 200:
            break
        time.sleep(0.1)
    assert server.request("POST", "/api/slice", body)[0] == 200


def test_a_page_that_reads_nothing_is_cut_off_and_costs_the_others_nothing(server):
    """Events for a page that does not take them pile up to a limit, then the page is dropped."""
    deaf, page = server.page(), server.page()
    deaf.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    name = "x" * 90
    for number in range(200):
        page.do("structure.set", id=1, name=f"{name}{number}")
    assert page.structures[1]["name"].endswith("199")
    deaf.close()


def resident_mib(server, what="VmRSS"):
    with open(f"/proc/{server.process.pid}/status") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith(what))


def test_floods_cost_no_memory(server):
    """Requests that nobody reads the replies of, a page that calls and does not listen, connections that come and go."""
    before = resident_mib(server)
    body = json.dumps({**SLICE, "width": 512, "height": 512}).encode()
    one = head(server, "POST", "/api/slice", origin=f"http://{server.host}", extra=f"Content-Length: {len(body)}\r\n") + body
    deaf = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(4)]
    for connection in deaf:
        connection.settimeout(0.5)
        try:
            connection.sendall(one * 2000)
        except TimeoutError:
            pass  # the server does not take more than it answers
    page = server.page()
    page.socket.settimeout(0.5)
    try:
        for _ in range(20_000):
            page.send_frame(json.dumps({"seq": 1, "call": "path", "plane": SLICE["plane"], "control": [{"at": [0, 0, 0], "kind": "line"}] * 50}).encode())
    except TimeoutError:
        pass
    for connection in (*deaf, page.socket):
        connection.close()
    for _ in range(1000):
        socket.create_connection(("127.0.0.1", server.port), timeout=15).close()
    assert server.page().do("ping") == {}
    assert SANITIZED or resident_mib(server) < before + 150


def test_an_idle_server_is_small(tmp_path):
    with running(tmp_path, "phantom") as one:  # 60 MiB of it
        page = one.page()
        page.do("ping")
        print(f"\nidle with the phantom: {resident_mib(one):.0f} MiB")
        assert SANITIZED or resident_mib(one) < 400
