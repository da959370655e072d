"""Parts of the pages that the programs write, between two markers."""

import json
import re
import subprocess

BEGIN = "<!-- written by tools/docs --update: {} -->"
END = "<!-- end of {} -->"
DIGITS = 3  # of the numbers in an example
SHOWN = ("effect", "joint", "parameters", "evidence", "alternatives", "statement")


def between_markers(text, name):
    """(before, content, after); an error unless both markers stand there once."""
    begin, end = BEGIN.format(name), END.format(name)
    if text.count(begin) != 1 or text.count(end) != 1:
        raise ValueError(f"expected the markers of {name} once")
    head, rest = text.split(begin)
    content, tail = rest.split(end)
    return head + begin, content.strip("\n"), end + tail


def replaced(text, name, content):
    head, _, tail = between_markers(text, name)
    return f"{head}\n{content}\n{tail}"


def options_table(programs):
    """Every option of flexcompd: its name in the configuration file, its default, and its own words."""
    shown = subprocess.run([programs / "flexcompd", "--help"], capture_output=True, text=True, check=True).stdout
    at_start, later = shown.split("Options, read again on SIGHUP:")
    at_start = at_start.split("Options, read at start only:")[1]
    return "\n".join(["| name | default | what it is | changed by SIGHUP |", "|---|---|---|---|"] +
                     [row + " no |" for row in _rows(at_start)] + [row + " yes |" for row in _rows(later)])


def _rows(shown):
    for name, kind, words in re.findall(r"^  --([a-z0-9-]+) ?(\S*.*?)(?:  +|\n +)(\S(?:.|\n {10,})*)$", shown, re.MULTILINE):
        default = re.search(r"=\[?([^]\s]+?)\]?$", kind)
        default = "required" if "REQUIRED" in kind else f"`{default.group(1)}`" if default else ""
        yield f"| `{name}` | {default} | {' '.join(words.split())} |"


def rounded(value):
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    if isinstance(value, list):
        return [rounded(each) for each in value]
    return {key: rounded(each) for key, each in value.items()} if isinstance(value, dict) else value


def example_of(diagnosis):
    """The verdict and the first finding of a diagnosis, as a page shows them."""
    first = diagnosis["findings"][0]
    shown = {"verdict": diagnosis["verdict"],
             "noise_floor_rms": rounded(diagnosis["noise_floor_rms"]),
             "baseline": rounded(diagnosis["baseline"]), "final": rounded(diagnosis["final"]),
             "findings": [{key: rounded(first[key]) for key in SHOWN}]}
    return "```json\n" + json.dumps(shown, indent=2, ensure_ascii=False) + "\n```"
