"""python -m campaign --seed N --count K --out DIR: writes cases, and their truth in clear."""

import argparse
import json
import pathlib
import sys

from . import draw, write_case


def main():
    parser = argparse.ArgumentParser(prog="campaign", description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, required=True, help="cases to draw")
    parser.add_argument("--only", type=int, nargs="*", metavar="NUMBER",
                        help="write these cases only, counted from 0")
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="DIR")
    options = parser.parse_args()
    if options.seed < 0 or options.count < 1:
        parser.error("--seed must not be negative, --count at least 1")
    truths = {}
    cases = draw(options.seed, options.count)
    for number, case in enumerate(cases):
        if options.only is None or number in options.only:
            name = f"{number:03d}"
            truths[name] = write_case(case, options.out / name)
            if sys.stderr.isatty():
                print(f"\r{number + 1}/{len(cases)}", end="", file=sys.stderr)
    (options.out / "truth.json").write_text(json.dumps(truths, indent=1) + "\n")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
