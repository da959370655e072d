"""Prints what llvm-cov has exported: lines and branches a file, and every line and branch not taken.

    llvm-cov export … | coverage_report.py FOLDER

A line or branch of a template counts as taken if any of its instantiations takes it. Lines that only
run while compiling (constexpr) cannot be seen and count as not taken.
"""
import collections
import json
import pathlib
import sys

CODE_REGION = 0


def collect(data):
    """Executions by file and line, and by file, place and direction of a branch."""
    lines = collections.defaultdict(dict)
    branches = collections.defaultdict(collections.Counter)
    for function in data["functions"]:
        name = function["filenames"][0]
        for line, count in executed_lines(function["regions"]):
            lines[name][line] = max(count, lines[name].get(line, 0))
        for first, column, _, _, taken, not_taken, *_ in function["branches"]:
            branches[name][first, column, "true"] += taken
            branches[name][first, column, "false"] += not_taken
    return lines, branches


def executed_lines(regions):
    """A line's count is that of the innermost region of code that covers it."""
    counts = {}
    for first, _, last, _, count, file, _, kind in sorted(regions, key=lambda region: (region[0], -region[2])):
        if kind == CODE_REGION and file == 0:
            counts.update(dict.fromkeys(range(first, last + 1), count))
    return counts.items()


def share(part, whole):
    return f"{100 * part / whole:6.1f} %" if whole else "       -"


def main():
    folder = pathlib.Path(sys.argv[1])
    lines, branches = collect(json.load(sys.stdin)["data"][0])
    parts = [folder / "include", folder / "firmware" / "core"]
    names = sorted(name for name in lines if any(map(pathlib.Path(name).is_relative_to, parts)))
    total = collections.Counter()
    print(f"{'':44} {'lines':>13} {'branches':>16}")
    for name in names:
        row = collections.Counter(
            lines=len(lines[name]), covered=sum(count > 0 for count in lines[name].values()),
            branches=len(branches[name]), taken=sum(count > 0 for count in branches[name].values()))
        total += row
        print(f"{str(pathlib.Path(name).relative_to(folder)):44} {row['lines']:5}{share(row['covered'], row['lines'])}"
              f" {row['branches']:7}{share(row['taken'], row['branches'])}")
    print(f"{'all':44} {total['lines']:5}{share(total['covered'], total['lines'])}"
          f" {total['branches']:7}{share(total['taken'], total['branches'])}\n\nNot taken:")
    for name in names:
        short = pathlib.Path(name).relative_to(folder)
        source = pathlib.Path(name).read_text().splitlines()
        for line, count in sorted(lines[name].items()):
            if count == 0:
                print(f"  {short}:{line}: never: {source[line - 1].strip()}")
        for (line, column, direction), count in sorted(branches[name].items()):
            if count == 0:
                print(f"  {short}:{line}:{column}: never {direction}: {source[line - 1][column - 1:].strip()}")


if __name__ == "__main__":
    main()
