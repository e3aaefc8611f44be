# SPDX-License-Identifier: Apache-2.0
"""What the server checks of messages, as C++ tables of message_checks.h. Usage: checks.py OUT"""
import json
import pathlib
import sys

from protocol import definitions, read, schema

KINDS = {"string": "text", "array": "list"}


def between(least, most, unit=""):
    """"from 1 to 9", in words."""
    if least is not None and most is not None:
        return f"of {most:g}{unit}" if unit and least == most else f"{'of' if unit else 'from'} {least:.16g} to {most:.16g}{unit}"
    if most is not None:
        return f"of at most {most:.16g}{unit}"
    return "" if least is None else f"from {least:.16g} on"


def needed(kind):
    """What a value of this schema is, for a sentence that says what is needed."""
    if "title" in kind:
        return kind["title"]
    if "$ref" in kind:
        return needed(definitions()[kind["$ref"].split("/")[-1]])
    if "anyOf" in kind:
        return " or ".join(needed(one) for one in kind["anyOf"])
    if "enum" in kind:
        return " or ".join(filter(None, [", ".join(kind["enum"][:-1]), kind["enum"][-1]]))
    if "exclusiveMinimum" in kind:
        return f"a number greater than {kind['exclusiveMinimum']:g}"
    plain = {"string": "a text", "number": "a number", "integer": "a whole number", "boolean": "true or false", "null": "null", "object": "an object", "array": "a list"}
    range_ = {
        "string": lambda: between(None, kind.get("maxLength"), " characters"),
        "array": lambda: between(kind.get("minItems"), kind.get("maxItems"), " items"),
    }.get(kind["type"], lambda: between(kind.get("minimum"), kind.get("maximum")))()
    return f"{plain[kind['type']]} {range_}".strip()


class Tables:
    """Definitions in C++, each before its use."""

    def __init__(self):
        self.names, self.lines = {}, []

    def type(self, kind):
        """The name of a `Type` for the schema."""
        key = json.dumps(kind)
        if key not in self.names:
            text = self.text(kind)
            self.names[key] = f"type_{len(self.names)}"
            self.lines.append(f"const Type {self.names[key]}{{{text}}};")
        return self.names[key]

    def text(self, kind):
        if "$ref" in kind:
            return self.text(definitions()[kind["$ref"].split("/")[-1]])
        if not kind:
            return ".kind = Type::any"
        if "anyOf" in kind:
            fields = ["either", f".choices = {{{', '.join('&' + self.type(one) for one in kind['anyOf'])}}}"]
        elif "enum" in kind:
            fields = ["text", f".words = {{{', '.join(json.dumps(word) for word in kind['enum'])}}}"]
        else:
            fields = [KINDS.get(kind["type"], kind["type"]), *self.limits(kind), *self.parts(kind)]
        return ", ".join([f".kind = Type::{fields[0]}", f".needed = {json.dumps(needed(kind))}", *fields[1:]])

    def limits(self, kind):
        names = {"least": ("minimum", "exclusiveMinimum", "minItems"), "most": ("maximum", "maxItems", "maxLength")}
        found = [f".{field} = {kind[key]:.17g}" for field, keys in names.items() for key in keys if key in kind]
        return found + ([".is_above_least = true"] if "exclusiveMinimum" in kind else []) + ([f".pattern = {json.dumps(kind['pattern'])}"] if "pattern" in kind else [])

    def parts(self, kind):
        if "items" in kind:
            return [f".items = &{self.type(kind['items'])}"]
        rows = [f"{{{json.dumps(name)}, &{self.type(of)}, {json.dumps(name in kind['required'])}}}" for name, of in kind.get("properties", {}).items()]
        return [f".members = {{{', '.join(rows)}}}"] if rows else []


def checks_file():
    tables = Tables()
    messages = {
        "call_types": {name: schema({"members": kind["arguments"]}) for name, kind in read("calls").items()},
        "request_types": {name: schema(kind) for name, kind in read("requests").items()},
    }
    functions = []
    for name, kinds in messages.items():
        rows = "".join(f"        {{{json.dumps(key)}, &{tables.type(kind)}}},\n" for key, kind in kinds.items())
        functions.append(f"const Types& {name}() {{\n    static const Types types{{\n{rows}    }};\n    return types;\n}}")
    head = ["// Made from apps/viewer/protocol by checks.py: change it there.", '#include "viewer/model/message_checks.h"', ""]
    return "\n".join([*head, "namespace kontur::viewer {", "namespace {", *tables.lines, "}  // namespace", *functions, "}  // namespace kontur::viewer", ""])


if __name__ == "__main__":
    pathlib.Path(sys.argv[1]).write_text(checks_file(), encoding="utf-8")
