# SPDX-License-Identifier: Apache-2.0
"""Manual pages from the commands' help: kontur.1 and kontur-COMMAND.1."""


def _escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    return "\\&" + text if text.startswith(".") else text


def _paragraph(text):
    return [".PP", _escaped(text)]


def _option(option):
    head = ", ".join(f"\\fB{_escaped(name)}\\fR" for name in option.names)
    if option.value:
        head += f" \\fI{_escaped(option.value)}\\fR"
    text = option.help + (f" (default {option.default})" if option.default else "")
    text += "".join(f" ({'required' if note == 'REQUIRED' else note[0].lower() + note[1:]})" for note in option.notes)
    return [".TP", head, _escaped(text)]


def _footer(footer):
    lines = []
    for block in footer.split("\n\n"):
        title, *rest = block.split("\n")
        if title == "Example:":
            lines += [".SH EXAMPLE", ".nf", *map(_escaped, rest), ".fi"]
        elif block:
            lines += [".SH NOTES", *_paragraph(" ".join([title, *rest]))]
    return lines


def page(command, version):
    """The text of one page."""
    title = "kontur" + (f"-{command.name}" if command.name else "")
    lines = [f".TH {_escaped(title.upper())} 1 \"\" \"kontur {version}\" \"kontur manual\"", ".SH NAME"]
    summary = command.summary.removeprefix("kontur: ")
    lines += [f"{_escaped(title)} \\- {_escaped(summary)}", ".SH SYNOPSIS", f".B {_escaped(command.usage)}"]
    if command.positionals:
        lines.append(".SH ARGUMENTS")
        for name, text in command.positionals:
            lines += [".TP", f"\\fI{_escaped(name)}\\fR", _escaped(text)]
    if command.commands:
        lines.append(".SH COMMANDS")
        for name, text in command.commands:
            lines += [".TP", f"\\fB{_escaped(name)}\\fR", _escaped(f"{text}. See kontur-{name}(1).")]
    lines.append(".SH OPTIONS")
    for option in command.options:
        lines += _option(option)
    lines += _footer(command.footer)
    lines.append(".SH SEE ALSO")
    others = [name for name, _ in command.commands] if command.commands else []
    lines.append(_escaped(", ".join(f"kontur-{name}(1)" for name in others) if others else "kontur(1)"))
    return "\n".join(lines) + "\n"
