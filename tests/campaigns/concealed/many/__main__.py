"""tools/concealed --many-small-causes: machines that are a little off everywhere.

Draws cases of both classes, seals what is concealed, has each diagnosed in a sandbox, opens the seal,
and sets the updated model's error on a held-out recording beside that of the nominal model, of the
best plain refit and of the oracle that knows the structure.
"""

import argparse
import json
import os
import pathlib
import shutil
import sys

from protocol import sandbox, seal, workers

from . import cases, diagnosed, judge

SOURCE = pathlib.Path(__file__).resolve().parents[4]
OURS = ("cases", "answers", "summary.json", seal.SEALED, seal.HASH, seal.OPENED, seal.KEY)


def _parse(words):
    parser = argparse.ArgumentParser(prog="tools/concealed --many-small-causes", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True, metavar="S", help="draws the cases")
    parser.add_argument("--cases", type=int, default=40, metavar="N",
                        help="of each class (default 40)")
    parser.add_argument("--class", dest="classes", action="append", choices=list(cases.CLASSES),
                        help="one class only; may be given again (default: both)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="J",
                        help="cases at a time (default: one a core)")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR",
                        help="default: build/concealed/many-S; an earlier run there is replaced")
    parser.add_argument("--tool", type=pathlib.Path, default=SOURCE / "build/release/bin/flexcomp",
                        metavar="FILE", help="default: build/release/bin/flexcomp")
    parser.add_argument("--limit", type=float, default=300.0, metavar="S",
                        help="seconds after which a diagnosis counts as failed (default 300)")
    parser.add_argument("--only-write", action="store_true",
                        help="write the cases, sealed, and diagnose nothing")
    parser.add_argument("--again", action="store_true",
                        help="diagnose the opened cases of an earlier run in --out once more")
    options = parser.parse_args(words)
    options.classes = options.classes or list(cases.CLASSES)
    options.tool = options.tool.resolve()
    options.out = (options.out or SOURCE / f"build/concealed/many-{options.seed}").resolve()
    if options.seed < 0 or options.cases < 1 or options.jobs < 1 or not options.limit > 0:
        parser.error("--seed must not be negative; --cases and --jobs need at least 1, --limit "
                     "more than 0 s")
    if not options.only_write and not os.access(options.tool, os.X_OK):
        parser.error(f"{options.tool} is not there; run tools/build first")
    return options


def _name(kind, number):
    return f"{kind}-{number:02d}"


def _write(task):
    kind, seed, number, folder = task
    return _name(kind, number), cases.write(kind, seed, number, folder)


def _diagnose(task):
    tool, limit, kind, case, answers = task
    diagnosed.run(tool, workers.box(), limit, kind, case, answers)
    return case.name


def _print(found):
    def percent(share):
        return f"{share['count']} of {share['of']}"

    for kind, each in found.items():
        holdout, untrained = each["holdout"], each["untrained"]
        print(f"\n{kind}: {each['cases']} cases, {each['answered']} answered; "
              f"{each['seconds']['median']:.1f} s in the median, {each['seconds']['max']:.0f} s at "
              f"most (processor {each['cpu']['median']:.1f}, {each['cpu']['max']:.0f} s)")
        for part, entry in (("held out", holdout), ("untrained region", untrained)):
            print(f"  {part}: within 1.1 of the oracle {percent(entry['within_oracle'])}, of the "
                  f"plain refit {percent(entry['within_plain'])}; not worse than it beyond chance "
                  f"{percent(entry['not_worse_than_plain_beyond_chance'])}; error over the oracle's "
                  f"{entry['over_oracle']['median']:.3f} in the median, "
                  f"{entry['over_oracle']['max']:.2f} at most" if entry["over_oracle"] else part)
        print(f"  cases with findings that cannot be: {percent(each['cases_with_impossible'])}; "
              f"wrong names {each['wrong_names']} of {each['findings']}; parameters within their "
              f"interval {percent(each['intervals'])}; verdicts {each['verdicts']}")


def main(words=None):
    options = _parse(words)
    tasks = [(kind, options.seed, number, options.out / "cases" / _name(kind, number))
             for number in range(options.cases) for kind in options.classes]
    if options.again:
        truths = json.loads((options.out / seal.OPENED).read_text())["truth"]
        tasks = [task for task in tasks if task[3].name in truths]
        truths = {task[3].name: truths[task[3].name] for task in tasks}
        shutil.rmtree(options.out / "answers", ignore_errors=True)
        sealed = None
    else:
        workers.clear(options.out, OURS)
        truths = dict(workers.each(options.jobs, _write, tasks, "written"))
        sealed = seal.SealedTruth(truths, options.out)
        print(f"Truth of {len(truths)} cases sealed. SHA-256: {sealed.sha256}", flush=True)
    if options.only_write:
        sealed.open()
        return 0
    box = [options.tool], [options.out]
    tried = sandbox.Sandbox(*box)
    if not tried.isolated:
        print(f"No sandbox: {tried.why_not}.")
    workers.each(options.jobs, _diagnose, [
        (options.tool, options.limit, kind, folder, options.out / "answers" / folder.name)
        for kind, _, _, folder in tasks], "diagnosed", box)
    if sealed is not None:
        truths = sealed.open()
    rows = [judge.judged(name, truth, options.out / "cases" / name, options.out / "answers" / name)
            for name, truth in sorted(truths.items())]
    found = {kind: judge.figures([row for row in rows if row["class"] == kind])
             for kind in options.classes}
    summary = {"seed": options.seed, "tool": str(options.tool), "figures": found, "cases": rows}
    (options.out / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    _print(found)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
