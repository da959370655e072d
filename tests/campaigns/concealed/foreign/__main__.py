"""tools/concealed --foreign-laws: machines with physics that no catalogue holds.

Half of the cases have one foreign law, a quarter one beside an effect of the catalogue, a quarter
nothing. Each is sealed, diagnosed in a sandbox, and opened. Then it is measured by how much the updated
model brings down the error beyond the noise, held out and in a region that nobody trained in; which
names were given; and which laws, at which place. Beside it stands a plain refit of the model's springs
and friction, and, where flexcomp's formulas can say it, the concealed law itself.
"""

import argparse
import json
import os
import pathlib
import shutil
import sys

from campaign import case as campaign
from protocol import sandbox, seal, workers

from . import cases, judge, milled, table, trial

SOURCE = pathlib.Path(__file__).resolve().parents[4]
OURS = ("cases", "floors", "answers", "summary.json", seal.SEALED, seal.HASH, seal.OPENED, seal.KEY)


def _parse(words):
    parser = argparse.ArgumentParser(prog="tools/concealed --foreign-laws", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True, metavar="S", help="draws the cases")
    parser.add_argument("--cases", type=int, default=80, metavar="N", help="how many (default 80)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="J",
                        help="cases at a time (default: one a core)")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR",
                        help="default: build/concealed/foreign-S; an earlier run there is replaced")
    parser.add_argument("--tool", type=pathlib.Path, default=SOURCE / "build/release/bin/flexcomp",
                        metavar="FILE", help="default: build/release/bin/flexcomp")
    parser.add_argument("--limit", type=float, default=300.0, metavar="S",
                        help="seconds after which a diagnosis counts as failed (default 300)")
    parser.add_argument("--law-seconds", type=float, metavar="S",
                        help="given to the tool: laws beside findings too, up to S (default: as the "
                        "tool does unasked)")
    parser.add_argument("--no-loop", action="store_true",
                        help="mill no circles with the diagnosed models")
    parser.add_argument("--no-rivals", action="store_true", help="leave the plain refit out")
    parser.add_argument("--again", type=pathlib.Path, metavar="DIR",
                        help="diagnose the first --cases opened cases of an earlier run in DIR with "
                        "another build")
    options = parser.parse_args(words)
    options.tool = options.tool.resolve()
    options.out = (options.out or SOURCE / f"build/concealed/foreign-{options.seed}").resolve()
    if options.seed < 0 or options.cases < 1 or options.jobs < 1 or not options.limit > 0:
        parser.error("--seed must not be negative; --cases and --jobs need at least 1, --limit "
                     "more than 0 s")
    if not os.access(options.tool, os.X_OK):
        parser.error(f"{options.tool} is not there; run tools/build first")
    if options.again:
        options.again = options.again.resolve()
        if not (options.again / seal.OPENED).is_file():
            parser.error(f"{options.again} holds no opened campaign")
        if options.again == options.out:
            parser.error("--again needs another --out, or the earlier answers would be lost")
    return options


def _write(task):
    name, case, folder = task
    try:
        return name, cases.write(case, folder / "cases" / name, folder / "floors" / name)
    except campaign.Unsuitable:
        shutil.rmtree(folder / "cases" / name)
        return name, None


def _diagnose(task):
    tool, options, limit, case, answers = task
    trial.diagnose(tool, options, workers.box(), limit, case, answers)


def _measure(task):
    trial.measure(*task)


def _mill(task):
    tool, truth, model, answers = task
    said = milled.mill(tool, truth, model, answers / "updated_model.yaml")
    (answers / "loop.json").write_text(json.dumps(said) + "\n")


def _drawn(options):
    """Writes the cases and seals their truth; returns the SealedTruth and the cases' names."""
    tasks = [(f"{number:03d}", case, options.out)
             for number, case in enumerate(cases.draw(options.seed, options.cases))]
    truths = {name: truth for name, truth in workers.each(options.jobs, _write, tasks, "written") if truth}
    if len(truths) < len(tasks):
        print(f"{len(tasks) - len(truths)} cases could not be drawn and are left out.")
    sealed = seal.SealedTruth(truths, options.out)
    print(f"Truth of {len(truths)} cases sealed. SHA-256: {sealed.sha256}", flush=True)
    return sealed, sorted(truths)


def main(words=None):
    options = _parse(words)
    workers.clear(options.out, OURS)
    source = options.again or options.out
    if options.again:
        sealed, truths = None, json.loads((source / seal.OPENED).read_text())["truth"]
        names = sorted(truths)[:options.cases]
    else:
        sealed, names = _drawn(options)
    box = [options.tool], [options.out, source]
    tried = sandbox.Sandbox(*box)
    if not tried.isolated:
        print(f"No sandbox: {tried.why_not}.")
    asked = [] if options.law_seconds is None else ["--law-seconds", f"{options.law_seconds:g}"]
    workers.each(options.jobs, _diagnose, [
        (options.tool, asked, options.limit, source / "cases" / name, options.out / "answers" / name)
        for name in names], "diagnosed", box)
    if sealed:
        truths = sealed.open()
    workers.each(options.jobs, _measure, [
        (options.tool, source / "cases" / name, source / "floors" / name,
         options.out / "answers" / name, truths[name], not options.no_rivals)
        for name in names], "measured")
    if not options.no_loop:
        workers.each(options.jobs, _mill, [
            (options.tool, truths[name], source / "cases" / name / "model" / "robot.yaml",
             options.out / "answers" / name)
            for name in names if milled.is_asked(truths[name])], "milled")
    rows = [judge.judged(name, truths[name], options.out / "answers" / name) for name in names]
    found = judge.figures(rows)
    (options.out / "summary.json").write_text(json.dumps(
        {"seed": options.seed, "tool": str(options.tool), "figures": found, "cases": rows},
        indent=1, ensure_ascii=False) + "\n")
    table.show(rows, found)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
