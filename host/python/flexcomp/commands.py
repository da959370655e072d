"""The commands of the host, as functions that return their JSON as objects.

Options are named as on the command line, with underscores: `feed=0.05`. A tuple is joined by commas
(`center=(1.6, 0, 1.2)`), a list repeats the option (`recording=["a.csv", "b.csv"]`), True is a flag. The
program is $FLEXCOMP_PROGRAM, or the `flexcomp` in the path."""

import json
import os
import pathlib
import subprocess

_DOES_NOT_HOLD = 1
_NOT_FOUND = 127  # as a shell


class CommandError(Exception):
    """A command that did not do its work: `code` is its exit code, the text what it says. A program that is
    not there has the code of a shell, 127."""

    def __init__(self, code, text):
        self.code = code
        super().__init__(text)


def _words(options):
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        for one in value if isinstance(value, list) else [value]:
            if one is True:
                yield option
            elif one is not False and one is not None:
                yield option
                yield ",".join(map(str, one)) if isinstance(one, tuple) else str(one)


def _call(allowed, words, options):
    program = os.environ.get("FLEXCOMP_PROGRAM", "flexcomp")
    try:
        done = subprocess.run([program, *map(str, words), *_words(options)], capture_output=True, text=True)
    except OSError as error:
        raise CommandError(_NOT_FOUND, f"{program}: {error.strerror}; $FLEXCOMP_PROGRAM names the program, or "
                           "`flexcomp` is in the path") from None
    if done.returncode not in allowed:
        raise CommandError(done.returncode, (done.stderr or done.stdout).strip())
    return done.stdout


def run(*words, **options):
    """Any command: run("plan", "circle", model=...). What it printed; raises CommandError."""
    return _call((0,), words, options)


def ask(*words, **options):
    """Any command that has --json; its object. One whose check does not hold (exit code 1) returns it too."""
    text = _call((0, _DOES_NOT_HOLD), words, options | {"json": True})
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        raise CommandError(_DOES_NOT_HOLD, text.strip()) from None


def diagnose(*, out, **options):
    """Where recordings and the model differ, and why: the content of diagnosis.json."""
    run("diagnose", out=out, **options)
    return json.loads((pathlib.Path(out) / "diagnosis.json").read_text(encoding="utf-8"))


def _asking(name, *words):
    def command(*arguments, **options):
        return ask(*words, *arguments, **options)

    command.__name__ = command.__qualname__ = name
    command.__doc__ = f"`flexcomp {' '.join(words)} --json`: its object."
    return command


check = _asking("check", "check")
circularity = _asking("circularity", "circularity")
compensate = _asking("compensate", "compensate")
contour = _asking("contour", "contour")
convert = _asking("convert", "convert")
export = _asking("export", "export")
force = _asking("force", "force")
form = _asking("form", "form")
identify = _asking("identify", "identify")
map_circularity = _asking("map_circularity", "map")
place = _asking("place", "place")
plan_program = _asking("plan_program", "plan", "program")
plant = _asking("plant", "plant")
select = _asking("select", "select")
table = _asking("table", "table")
verify_table = _asking("verify_table", "table", "verify")
