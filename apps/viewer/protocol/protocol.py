# SPDX-License-Identifier: Apache-2.0
"""The protocol between page and server, from the files beside this one.
typescript.py makes the page's types of it, checks.py what the server checks of messages, the tests JSON Schema.

The files hold JSON Schema in a short form, so that a person can read and change it (docs/viewer-protocol.md, "The schema"):

    "word", "word[]", "word[3]", "word|null"    a type of JSON or a shape of the files; arrays of it, of three; or null
    {"is": "word", ...}                         the same with further keywords of JSON Schema
    {"members": {"id": ..., "name?": ...}}      an object; "?" marks what may be absent
    {"words": [...]}, {"any": [...]}            one of these texts; one of these types
    {"list": ...}, {"map": ...}                 an array, an object with any names, of a type that has no name

`about` becomes a comment of the page's types. `typescript` names the file of the page that has the type already.
"""
import json
import pathlib
import re

HERE = pathlib.Path(__file__).parent
PLAIN = ("string", "number", "integer", "boolean", "null")


def read(name):
    return json.loads((HERE / f"{name}.json").read_text(encoding="utf-8"))


def shapes():
    """What has a name, in the order of the page's types."""
    return {**read("shapes"), **read("requests"), **read("replies")}


def schema_of_word(word):
    if word.endswith("|null"):
        return {"anyOf": [schema_of_word(word.removesuffix("|null")), {"type": "null"}]}
    if array := re.fullmatch(r"(.+)\[(\d*)\]", word):
        count = {"minItems": int(array[2]), "maxItems": int(array[2])} if array[2] else {}
        return {"type": "array", "items": schema_of_word(array[1]), **count}
    if word == "any":
        return {}
    return {"type": word} if word in PLAIN else {"$ref": f"#/$defs/{word}"}


def schema_of_members(members, strict):
    names = {name.removesuffix("?"): schema(kind, strict) for name, kind in members.items()}
    needed = [name for name in members if not name.endswith("?")]
    return {"type": "object", "properties": names, "required": needed, **({"additionalProperties": False} if strict else {})}


def schema(kind, strict=False):
    """JSON Schema; with `strict` objects have no other members than those that are named."""
    if isinstance(kind, str):
        return schema_of_word(kind)
    if "members" in kind:
        return schema_of_members(kind["members"], strict)
    if "words" in kind:
        return {"enum": kind["words"]}
    if "any" in kind:
        return {"anyOf": [schema(one, strict) for one in kind["any"]]}
    if "list" in kind:
        return {"type": "array", "items": schema(kind["list"], strict)}
    if "map" in kind:
        return {"type": "object", "additionalProperties": schema(kind["map"], strict)}
    rest = {key: value for key, value in kind.items() if key not in ("is", "about", "typescript")}
    return {**schema_of_word(kind["is"]), **rest}


def definitions(strict=False):
    return {name: schema(kind, strict) for name, kind in shapes().items()}


def event_schema(name, strict=False):
    kind = read("events")[name]
    if "is" in kind:
        return schema({"members": {"event?": {"words": [name]}, **shapes()[kind["is"]]["members"]}}, strict)
    return schema({"members": {"event": {"words": [name]}, **kind["members"]}}, strict)
