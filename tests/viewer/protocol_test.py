# SPDX-License-Identifier: Apache-2.0
"""The schema of apps/viewer/protocol against docs, sources and what a running server says, judged by python3-jsonschema."""
import json
import pathlib
import re
import sys

import pytest

from support import ring, running, shifted, spline_controls

jsonschema = pytest.importorskip("jsonschema")
ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "apps/viewer/protocol"))
import protocol  # noqa: E402

CALLS = protocol.read("calls")


def complaints(message, schema):
    """What the message has that the schema does not know, or the other way round."""
    whole = {**schema, "$defs": protocol.definitions(strict=True)}
    return [f"{'/'.join(map(str, error.absolute_path))}: {error.message[:200]}" for error in jsonschema.Draft202012Validator(whole).iter_errors(message)]


def result_schema(call):
    result = CALLS[call]["result"]
    return protocol.schema(result if isinstance(result, str) else {"members": result}, strict=True)


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with running(tmp_path_factory.mktemp("protocol"), "phantom") as one:
        yield one


def test_the_schema_is_json_schema():
    for kind in (*protocol.definitions().values(), *map(protocol.event_schema, protocol.read("events")), *map(result_schema, CALLS)):
        jsonschema.Draft202012Validator.check_schema(kind)
    text = json.dumps(protocol.definitions())
    assert set(re.findall(r"#/\$defs/(\w+)", text)) <= set(protocol.definitions())


def test_the_schema_has_the_servers_calls_and_no_others():
    tables = "".join(path.read_text() for path in (ROOT / "apps/viewer/session").glob("*.cpp"))
    assert set(re.findall(r'\{"([a-z_.]+)", \{[a-z_]+(?:, false)?\}\}', tables)) == set(CALLS)


def documented():
    """{call: (arguments, those that may be absent)} of the tables of docs/viewer-protocol.md."""
    rows = re.findall(r"^\| (`[a-z_.]+`(?:, `[a-z_.]+`)*) \|([^|]*)\|", (ROOT / "docs/viewer-protocol.md").read_text(), re.MULTILINE)
    for names, arguments in rows:
        plain = re.sub(r"\([^)]*\)|: .*?(?=, `|$)", lambda m: m[0] if m[0].startswith(", `") else "", arguments)
        for name in re.findall(r"`([a-z_.]+)`", names):
            yield name, set(re.findall(r"`([a-z_]+)`", plain))


def test_the_documents_name_each_call_and_its_arguments():
    tables = {}
    for name, arguments in documented():
        if name in CALLS:
            tables.setdefault(name, set()).update(arguments)
    assert set(tables) == set(CALLS)
    for name, arguments in tables.items():
        known = {argument.removesuffix("?") for argument in CALLS[name]["arguments"]} - {"draft"}
        assert known <= arguments | {"origin"}, name


def test_the_documents_name_each_event():
    text = (ROOT / "docs/viewer-protocol.md").read_text()
    for name in protocol.read("events"):
        assert re.search(rf"^\| [^|]*`{name}`", text, re.MULTILINE), name


def test_what_a_server_says_is_what_the_schema_says(server):
    page = server.page()
    said = [page.session]
    plane = page.session["views"]["axial"]["plane"]
    pixels = shifted(plane, 64, 64, 2.0)
    calls = {"value": {"at": [0, 0, 0]}, "structure.add": {}, "structure.set": {"id": 1, "name": "Liver"}, "page.save": {"state": {"a": 1}}}
    results = {name: page.do(name, **arguments) for name, arguments in calls.items()}
    structure = results["structure.add"]["structure"]["id"]
    controls = spline_controls(ring(plane, 30))
    results["path"] = page.do("path", plane=pixels, control=controls, closed=True)
    results["contour.add"] = page.do("contour.add", structure=structure, plane=plane, control=controls)
    said.append(page.wait_for_surface(structure))
    contour = results["contour.add"]["contour"]["id"]
    results["contour.move_point"] = page.do("contour.move_point", id=contour, index=0, to=plane["origin"], draft=True)
    results["outline"] = page.do("outline", structure=structure, plane=plane)
    results["suggest"] = page.do("suggest", structure=1)
    for name in ("contour.remove", "undo", "redo", "draft.drop", "ping"):
        results[name] = page.do(name, **({"ids": [contour]} if name == "contour.remove" else {}))
    said += page.events
    for event in said:
        assert complaints(event, protocol.event_schema(event["event"], strict=True)) == [], event["event"]
    for name, result in results.items():
        assert complaints(result, result_schema(name)) == [], name
    assert {"session", "surface", "changed"} <= {event["event"] for event in said}


def test_replies_to_requests_are_what_the_schema_says(server):
    page = server.page()
    plane = page.session["views"]["axial"]["plane"]
    page.do("contour.add", structure=1, plane=plane, control=spline_controls(ring(plane, 30)))
    page.wait_for_surface(1)
    head, _ = server.slice(shifted(plane, 64, 64, 2.0), time=0)
    assert head["contours"] and head["outlines"]
    replies = {"SliceHeader": {key: value for key, value in head.items() if key != "arrays"}}
    status, _, body = server.request("GET", "/api/statistics")
    assert status == 200, body
    replies["Statistics"] = json.loads(body)
    for name, reply in replies.items():
        assert complaints(reply, protocol.definitions(strict=True)[name]) == [], name
    status, _, body = server.request("POST", "/api/slice", json.dumps({"plane": {}, "width": 1, "height": 1}).encode())
    assert status == 400 and json.loads(body)["error"]["message"] == "'plane.origin' is missing; a point [x, y, z] is needed"


@pytest.mark.parametrize("name", CALLS)
def test_each_needed_argument_is_asked_for(server, name):
    page = server.page()
    for argument in [argument for argument in CALLS[name]["arguments"] if not argument.endswith("?")][:1]:
        error = page.refused(name)
        assert error["kind"] == "invalid_input" and error["message"].startswith(f"'{argument}' is missing; ")
    assert page.refused(name, **{"nonsense": 1})["kind"] == "invalid_input"
