"""The command line of a blind campaign."""

import argparse
import os
import pathlib

SOURCE = pathlib.Path(__file__).resolve().parents[4]
TOLD = "STATE"  # one line: how far the campaign in a folder is
DESCRIPTION = """\
Proves `flexcomp diagnose` blind: draws a campaign of recordings with concealed physics, seals the
truth, diagnoses every case in a sandbox, opens the seal, scores, sets rivals beside it, and closes
the loop: one case of each effect mills a circle, corrected by the nominal and by the diagnosed model.
"""
EPILOG = """\
DIR holds afterwards: report.html, scores.json, cases/ (recordings and nominal models), answers/
(what the tool wrote), seal.sha256 (printed before the first diagnosis), truth.sealed, and, since
the seal was opened, truth.json and seal.key.

The truth of a campaign follows from its seed: take one that nobody has looked at.

Exit code 0: every goal that could be judged holds; 1: one does not, or the seal was touched, in
which case nothing is scored; 2: unusable arguments; 130: interrupted.
"""


def parse(words):
    """words: without the program's name; None: those it was called with."""
    parser = argparse.ArgumentParser(prog="tools/concealed", description=DESCRIPTION, epilog=EPILOG,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)

    def count(text):
        number = int(text)
        if number < 0:
            raise argparse.ArgumentTypeError("is negative")
        return number

    parser.add_argument("--seed", type=count, required=True, metavar="N", help="draws the campaign")
    parser.add_argument("--cases", type=count, default=100, metavar="K",
                        help="how many (default 100)")
    parser.add_argument("--jobs", type=count, default=os.cpu_count(), metavar="J",
                        help="cases at a time (default: one a core)")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR",
                        help="default: build/concealed/seed-N; an earlier campaign there is "
                        "replaced")
    parser.add_argument("--tool", type=pathlib.Path, default=SOURCE / "build/release/bin/flexcomp",
                        metavar="FILE", help="what is put to the proof (default: "
                        "build/release/bin/flexcomp)")
    parser.add_argument("--limit", type=float, default=300.0, metavar="S",
                        help="seconds after which a diagnosis counts as failed (default 300)")
    parser.add_argument("--rival-limit", type=float, default=60.0, metavar="S",
                        help="the same for each rival (default 60)")
    parser.add_argument("--no-rivals", action="store_true", help="leave the rivals out")
    parser.add_argument("--toolboxes", action="store_true",
                        help="mujoco.sysid and FIGAROH among the rivals, where there are torques")
    parser.add_argument("--no-loop", action="store_true",
                        help="mill no circles with the diagnosed models")
    options = parser.parse_args(words)
    options.tool = options.tool.resolve()
    options.out = (options.out or SOURCE / f"build/concealed/seed-{options.seed}").resolve()
    if not os.access(options.tool, os.X_OK) or options.tool.is_dir():
        parser.error(f"{options.tool} is not there; run tools/build first")
    if options.jobs < 1 or options.cases < 1:
        parser.error("--jobs and --cases need at least 1")
    if not (options.limit > 0 and options.rival_limit > 0):
        parser.error("--limit and --rival-limit need more than 0 s")
    if options.out.exists() and not (options.out.is_dir() and (
            (options.out / TOLD).is_file() or not any(options.out.iterdir()))):
        parser.error(f"{options.out} holds something else than a campaign; name another --out")
    return options
