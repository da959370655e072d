"""Writes the manual page of a program and its completions for bash, from what its --help says.

manual.py PROGRAM SECTION PAGE COMPLETIONS
"""

import pathlib
import re
import subprocess
import sys


def help_of(*command):
    text = subprocess.run([*map(str, command), "--help"], check=True, capture_output=True, text=True).stdout
    return text.replace(str(command[0]), command[0].name)


def subcommands(text):
    """Their names, in the order of the help."""
    _, _, rest = text.partition("\nSubcommands:\n")
    return re.findall(r"^  ([a-z][a-z-]*)(?: |$)", rest, re.MULTILINE)


def options(text):
    own = text.partition("\nSubcommands:\n")[0]
    return sorted(set(re.findall(r"^ +(?:-\w,)?(--[a-z][a-z-]*)", own, re.MULTILINE)))


def escaped(text):
    """For a block that is set as it stands."""
    lines = text.rstrip().replace("\\", "\\e").replace("-", "\\-").splitlines()
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in lines)


def block(text):
    return f".nf\n{escaped(text)}\n.fi\n"


def every_help(program):
    """{words after the program: help} of it and all its subcommands."""
    helps, waiting = {}, [()]
    while waiting:
        words = waiting.pop(0)
        helps[words] = help_of(program, *words)
        waiting += [(*words, name) for name in subcommands(helps[words])]
    return helps


def page(program, section, helps, version):
    title = program.name.upper()
    said, _, usage = helps[()].strip().partition("\nUsage: ")
    summary = " ".join(said.split("\n\n")[0].split()).removeprefix(f"{program.name} ").rstrip(".")
    text = (f'.TH {title} {section} "" "{version}"\n.SH NAME\n{program.name} \\- {escaped(summary)}\n'
            f".SH SYNOPSIS\n{escaped(usage.splitlines()[0])}\n.SH DESCRIPTION\n{block(said)}")
    own = usage.partition("\n")[2].partition("\nSubcommands:\n")[0]
    text += f".SH OPTIONS\n{block(own.strip())}"
    for words, help_text in helps.items():
        if words:
            text += f'.SH "{" ".join((program.name, *words)).upper()}"\n{block(help_text)}'
    return text


def completions(program, helps):
    name = program.name
    # After `help` comes what could have come in its place.
    helps = {words: text for words, text in helps.items() if words != ("help",)}
    cases = "\n".join(f'    "{" ".join(words)}") known="{" ".join(subcommands(text) + options(text))}" ;;'
                      for words, text in helps.items())
    return f"""# bash completion for {name}
_{name}() {{
  local known='' place='' word
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "${{place:+$place }}$word" in
      {"|".join(f'"{" ".join(words)}"' for words in helps if words) or "''"}) place="${{place:+$place }}$word" ;;
    esac
  done
  case "$place" in
{cases}
  esac
  local current="${{COMP_WORDS[COMP_CWORD]}}"
  mapfile -t COMPREPLY < <(compgen -W "$known" -- "$current")
}}
complete -o default -F _{name} {name}
"""


def main():
    program, section, manual, completion = sys.argv[1:]
    program = pathlib.Path(program)
    helps = every_help(program)
    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.strip()
    pathlib.Path(manual).write_text(page(program, section, helps, version))
    pathlib.Path(completion).write_text(completions(program, helps))


if __name__ == "__main__":
    main()
