# SPDX-License-Identifier: Apache-2.0
"""Shell completions from the commands' help: commands, options, the values of options that have few, file names."""


def bash(main, commands):
    """For bash-completion's folder of completions, or to be sourced."""
    cases, values = [], []
    for command in commands:
        names = " ".join(name for option in command.options for name in option.names)
        cases.append(f'        {command.name}) words="{names}" ;;')
        for option in command.options:
            if option.value and not option.takes_path:
                key = f"{command.name},{option.names[-1]}"
                values.append(f'        {key}) words="{" ".join(option.choices)}"; files= ;;')
    everything = " ".join([command.name for command in commands] + [name for o in main.options for name in o.names])
    return "\n".join([
        "# bash completion of kontur",
        "_kontur() {",
        "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]} words= files=yes",
        "    if [ \"$COMP_CWORD\" -eq 1 ]; then",
        f'        COMPREPLY=($(compgen -W "{everything}" -- "$word"))',
        "        return",
        "    fi",
        '    case "$command" in',
        *cases,
        "    esac",
        '    case "$word" in -*) files= ;; *) words= ;; esac',
        '    case "$command,$before" in',
        *values,
        "    esac",
        '    COMPREPLY=($(compgen -W "$words" -- "$word"))',
        '    if [ -n "$files" ]; then COMPREPLY+=($(compgen -f -- "$word")); fi',
        "}",
        "complete -o filenames -F _kontur kontur",
        "",
    ])


def _zsh_quoted(text):
    for special in "[]:\\":
        text = text.replace(special, "\\" + special) if special != "\\" else text
    return text.replace("'", "'\\''")


def _zsh_option(option):
    action = ""
    if option.value:
        action = f":{_zsh_quoted(option.value.lower())}:"
        action += f"({' '.join(option.choices)})" if option.choices else "_files" if option.takes_path else ""
    return [f"            '{name}[{_zsh_quoted(option.help)}]{action}'" for name in option.names]


def zsh(main, commands):
    """For a folder in zsh's fpath, under the name _kontur."""
    lines = ["#compdef kontur", "", "_kontur() {", "    if (( CURRENT == 2 )); then", "        local -a commands=("]
    lines += [f"            '{name}:{_zsh_quoted(text)}'" for name, text in main.commands]
    lines += ["        )", "        _describe command commands", "        return", "    fi", "    case $words[2] in"]
    for command in commands:
        lines += [f"    {command.name})", "        _arguments -S '1:command' \\"]
        lines += [line + " \\" for option in command.options for line in _zsh_option(option)]
        lines += ["            '*:file:_files'", "        ;;"]
    return "\n".join(lines + ["    esac", "}", "", '_kontur "$@"', ""])


def _fish_quoted(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def fish(main, commands):
    """For fish's folder of completions, under the name kontur.fish."""
    lines = ["# fish completion of kontur"]
    for name, text in main.commands:
        lines.append(f"complete -c kontur -n __fish_use_subcommand -f -a {name} -d {_fish_quoted(text)}")
    for command in commands:
        for option in command.options:
            line = f"complete -c kontur -n '__fish_seen_subcommand_from {command.name}'"
            for name in option.names:
                line += f" -l {name[2:]}" if name.startswith("--") else f" -s {name[1:]}"
            if option.choices:
                line += f" -x -a '{' '.join(option.choices)}'"
            elif option.value:
                line += " -r -F" if option.takes_path else " -x"
            lines.append(f"{line} -d {_fish_quoted(option.help)}")
    return "\n".join(lines) + "\n"
