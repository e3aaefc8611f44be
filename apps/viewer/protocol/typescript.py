# SPDX-License-Identifier: Apache-2.0
"""The page's types of the protocol. Usage: typescript.py OUT"""
import json
import pathlib
import re
import sys

from protocol import read, shapes


def of_word(word, read_only):
    if word.endswith("|null"):
        return of_word(word.removesuffix("|null"), read_only) + " | null"
    if array := re.fullmatch(r"(.+)\[(\d*)\]", word):
        item = of_word(array[1], False)
        if array[2]:
            return f"[{', '.join([item] * int(array[2]))}]"
        return ("readonly " if read_only else "") + item + "[]"
    return {"integer": "number", "any": "unknown"}.get(word, word)


def typescript(kind, read_only=False):
    """`read_only`: arrays that are only sent."""
    if isinstance(kind, str):
        return of_word(kind, read_only)
    if "members" in kind:
        rows = [f"{quoted(name)}: {typescript(of, read_only)}" for name, of in kind["members"].items()]
        return f"{{ {'; '.join(rows)} }}" if rows else "Record<string, never>"
    if "words" in kind:
        return " | ".join(f'"{word}"' for word in kind["words"])
    if "any" in kind:
        return " | ".join(typescript(one, read_only) for one in kind["any"])
    if "list" in kind:
        item = typescript(kind["list"])
        return f"({item})[]" if "|" in item else f"{item}[]"
    if "map" in kind:
        return f"Partial<Record<string, {typescript(kind['map'])}>>"
    return of_word(kind["is"], read_only)


def quoted(name):
    plain = name.removesuffix("?")
    return name if re.fullmatch(r"[a-z_]\w*", plain) else f'"{plain}"' + name[len(plain) :]


def comment(kind, indent=""):
    about = kind.get("about") if isinstance(kind, dict) else None
    return f"{indent}/** {about} */\n" if about else ""


def declaration(name, kind, more=""):
    if isinstance(kind, str) or "members" not in kind:
        constant = "constant" in kind and f"export const {kind['constant']}: readonly {name}[] = {json.dumps(kind['words'])};\n"
        return comment(kind) + f"export type {name} = {typescript(kind, read_only=True)};\n" + (constant or "")
    lines = [comment(of, "  ") + f"  {quoted(member)}: {typescript(of)};\n" for member, of in kind["members"].items()]
    return comment(kind) + f"export interface {name} {{\n{more}{''.join(lines)}}}\n"


def event_declarations():
    types, union = [], []
    for event, kind in read("events").items():
        if "as" in kind:
            types.append(declaration(kind["as"], kind, f'  event: "{event}";\n'))
        union.append(kind.get("as") or " & ".join([*([kind["is"]] if "is" in kind else []), f'{{ event: "{event}" }}']))
    return [*types, "export type ServerEvent =\n" + "".join(f"  | {'(' + one + ')' if '&' in one else one}\n" for one in union)[:-1] + ";\n"]


def call_declarations():
    of = lambda kind, read_only: typescript(kind if isinstance(kind, str) else {"members": kind}, read_only)
    rows = [f'  "{name}": {{ arguments: {of(kind["arguments"], True)}; result: {of(kind["result"], False)} }};\n' for name, kind in read("calls").items()]
    return [f"/** What the page may call, with what, and what it gets. */\nexport interface Calls {{\n{''.join(rows)}}}\n"]


def typescript_file():
    here = {name: kind for name, kind in shapes().items() if "typescript" not in kind}
    there = {name: kind["typescript"] for name, kind in shapes().items() if "typescript" in kind}
    imports = "".join(
        f"import type {{ {', '.join(sorted(name for name in there if there[name] == file))} }} from \"{file}\";\n" for file in sorted(set(there.values()))
    )
    head = f"// SPDX-License-Identifier: Apache-2.0\n// Made from apps/viewer/protocol by protocol.py: change it there.\n{imports}"
    types = [declaration(name, kind) for name, kind in here.items()]
    return "\n".join([head, *types, *event_declarations(), *call_declarations()])


if __name__ == "__main__":
    pathlib.Path(sys.argv[1]).write_text(typescript_file(), encoding="utf-8")
