# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Completion scripts of bash, zsh and fish, each a text made of the grammar."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from ravenchart.gen.diagnostics import CODES

from .grammar import ENDINGS, ArgumentKind, CommandWords, Grammar, Word

VALUES = {"CODE": tuple(CODES)}
"""The values that a placeholder of the help stands for, where they are a list."""


def _values(word: Word) -> tuple[str, ...]:
    return word.choices or VALUES.get(word.metavar, ())


def _quoted(text: str) -> str:
    """The text as one word of a shell."""
    return "'" + text.replace("'", "'\\''") + "'"


BASH = """\
# Completion of {program} for bash. Made by `{program} completion bash`.
_{program}() {{
    local cur prev command="" i candidates="" kind="" values=""
    cur="${{COMP_WORDS[COMP_CWORD]}}"
    prev="${{COMP_WORDS[COMP_CWORD-1]}}"
    if [[ $cur == "=" ]]; then
        cur=""
    elif [[ $prev == "=" ]]; then
        prev="${{COMP_WORDS[COMP_CWORD-2]}}"
    fi
    for ((i = 1; i < COMP_CWORD; i++)); do
        if [[ ${{COMP_WORDS[i]}} != -* ]]; then
            command="${{COMP_WORDS[i]}}"
            break
        fi
    done
    COMPREPLY=()
    case "$command $prev" in
{values}
    esac
    if [[ -z $kind ]]; then
        case "$command" in
{commands}
            *) return ;;
        esac
        if [[ $cur == -* || -z $kind ]]; then
            kind=values
            values="$candidates"
        fi
    fi
    case "$kind" in
        values) mapfile -t COMPREPLY < <(compgen -W "$values" -- "$cur") ;;
        folder)
            compopt -o filenames 2>/dev/null
            mapfile -t COMPREPLY < <(compgen -d -- "$cur")
            ;;
        file)
            compopt -o filenames 2>/dev/null
            mapfile -t COMPREPLY < <(compgen -f -- "$cur")
            ;;
        model)
            compopt -o filenames 2>/dev/null
            mapfile -t COMPREPLY < <(compgen -d -- "$cur"; {models})
            ;;
    esac
}}
complete -F _{program} {program}
"""


def bash(grammar: Grammar) -> str:
    """The script for bash, 4 or later."""
    words = [flag for word in grammar.options for flag in word.flags]
    names = " ".join(command.name for command in grammar.commands)
    chosen = [f'            "") kind=values; values="{names} {" ".join(words)}" ;;']
    values = []
    for command in grammar.commands:
        for word in command.options:
            if word.kind is not ArgumentKind.NOTHING:
                cases = "|".join(f'"{n} {flag}"' for n in command.names for flag in word.flags)
                values.append(f"        {cases}) {_bash_kind(word)} ;;")
        flags = " ".join(flag for word in command.options for flag in word.flags)
        does = "; ".join([f'candidates="{flags}"', *map(_bash_kind, command.arguments[:1])])
        chosen.append(f"            {'|'.join(command.names)}) {does} ;;")
    models = "; ".join(f"compgen -f -X '!*.{ending}' -- \"$cur\"" for ending in ENDINGS)
    return BASH.format(
        program=grammar.program,
        values="\n".join(values),
        commands="\n".join(chosen),
        models=models,
    )


def _bash_kind(word: Word) -> str:
    values = _values(word)
    if values:
        return f'kind=values; values="{" ".join(values)}"'
    return f"kind={word.kind.value}"


ZSH = """\
#compdef {program}
# Completion of {program} for zsh. Made by `{program} completion zsh`.
_{program}() {{
    local curcontext="$curcontext" state line
    typeset -A opt_args
    local -a commands
    commands=(
{names}
    )
    _arguments -C \\
{options}
        '1:command:->command' \\
        '*::argument:->argument' && return
    case "$state" in
        command) _describe -t commands command commands ;;
        argument)
            case "${{words[1]}}" in
{commands}
            esac
            ;;
    esac
}}
if [[ "${{funcstack[1]}}" == "_{program}" ]]; then
    _{program} "$@"
else
    compdef _{program} {program}
fi
"""


def zsh(grammar: Grammar) -> str:
    """The script for zsh, for a folder of `fpath` or for `source`."""
    names = (_quoted(f"{one.name}:{one.help}") for one in grammar.commands)
    return ZSH.format(
        program=grammar.program,
        names="\n".join(f"        {name}" for name in names),
        options="\n".join(f"        {spec} \\" for spec in _zsh_options(grammar.options)),
        commands="\n".join(_zsh_command(command) for command in grammar.commands),
    )


def _zsh_command(command: CommandWords) -> str:
    specs = [*_zsh_options(command.options)]
    for place, word in enumerate(command.arguments, 1):
        specs.append(_quoted(f"{place}:{_zsh_text(word.metavar)}:{_zsh_kind(word)}"))
    names = "|".join(command.names)
    gap = " \\\n" + 20 * " "
    return f"{16 * ' '}{names}) _arguments{gap}{gap.join(specs)} ;;"


def _zsh_options(words: tuple[Word, ...]) -> Iterator[str]:
    for word in words:
        takes = word.kind is not ArgumentKind.NOTHING
        value = f":{_zsh_text(word.metavar)}:{_zsh_kind(word)}" if takes else ""
        others = "*" if word.repeated else f"({' '.join(word.flags)})"
        for flag in word.flags:
            equals = "=" if takes and flag.startswith("--") else ""
            yield _quoted(f"{others}{flag}{equals}[{_zsh_text(word.help)}]{value}")


def _zsh_kind(word: Word) -> str:
    values = _values(word)
    if values:
        return f"({' '.join(values)})"
    return {
        ArgumentKind.MODEL: f'_files -g "*.({"|".join(ENDINGS)})(-.)"',
        ArgumentKind.FILE: "_files",
        ArgumentKind.FOLDER: "_files -/",
    }.get(word.kind, " ")


def _zsh_text(text: str) -> str:
    """The text without what has a meaning in a description."""
    return text.replace("\\", "").replace("[", "(").replace("]", ")").replace(":", "\\:")


def fish(grammar: Grammar) -> str:
    """The script for fish."""
    start = f"complete -c {grammar.program}"
    lines = [
        f"# Completion of {grammar.program} for fish. Made by `{grammar.program} completion fish`.",
        f"{start} -f",
    ]
    for word in grammar.options:
        lines.append(f"{start} -n __fish_use_subcommand {_fish_word(word)}")
    for command in grammar.commands:
        told = f"-a {command.name} -d {_fish_quoted(command.help)}"
        lines.append(f"{start} -n __fish_use_subcommand {told}")
    for command in grammar.commands:
        when = _fish_quoted(f"__fish_seen_subcommand_from {' '.join(command.names)}")
        lines += [f"{start} -n {when} {_fish_word(word)}" for word in command.words]
    return "\n".join(lines) + "\n"


def _fish_word(word: Word) -> str:
    values = _values(word)
    parts = [f"-l {flag[2:]}" if flag[:2] == "--" else f"-s {flag[1:]}" for flag in word.flags]
    if values:
        parts += ["-x" if word.flags else "", f"-a {_fish_quoted(' '.join(values))}"]
    elif word.kind is ArgumentKind.FOLDER:
        parts += ["-x" if word.flags else "", "-a '(__fish_complete_directories)'"]
    elif word.kind in (ArgumentKind.FILE, ArgumentKind.MODEL):
        parts += ["-r -F" if word.flags else "-F"]
    elif word.kind is ArgumentKind.TEXT and word.flags:
        parts += ["-x"]
    return " ".join(filter(None, [*parts, f"-d {_fish_quoted(word.help)}"]))


def _fish_quoted(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


SCRIPTS: Mapping[str, Callable[[Grammar], str]] = {"bash": bash, "zsh": zsh, "fish": fish}
"""The script for each shell."""
