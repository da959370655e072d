"""Scores `flexcomp diagnose` on recordings with concealed effects, and says whether the goals hold."""

import argparse
import csv
import dataclasses
import json
import multiprocessing
import os
import pathlib
import sys
import time

from generator import case
from generator.effects import CATALOGUE

from . import figures, table, trial, without

SOURCE = pathlib.Path(__file__).resolve().parents[4]
EPILOG = """\
Families of cases, each drawn from seeds --seed, --seed + 1, ...:
  single   one effect of the catalogue, each in each kind of recording it applies to, in turn
  pair     two effects
  clean    the model is right
  foreign  physics that is in no catalogue
  variant  an effect of the catalogue in a form that no law of it has

Seeds below 1000 are for development. Published figures come from seeds from 1000000 on, which
nobody has looked at before; once looked at, the next ones are taken.

Exit code 0: every goal holds; 1: one does not; 2: unusable arguments; 130: interrupted.
With fewer cases than a goal asks for, its rate is judged all the same and this is said.
"""


def arguments():
    parser = argparse.ArgumentParser(
        prog="tools/score-diagnosis", description=__doc__, epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)

    def count(text):
        number = int(text)
        if number < 0:
            raise argparse.ArgumentTypeError("is negative")
        return number

    parser.add_argument("--seed", type=count, default=0, metavar="N", help="first seed (default 0)")
    for family, number in (("single", 200), ("pairs", 100), ("clean", 200), ("foreign", 60),
                           ("variant", 0)):
        parser.add_argument(f"--{family}", type=count, default=number, metavar="N",
                            help=f"number of {family} cases (default {number})")
    parser.add_argument("--jobs", type=count, default=os.cpu_count(), metavar="J",
                        help="processes at a time (default: one a core)")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR",
                        help="keep cases and answers in DIR, and use again those that are there")
    parser.add_argument("--tool", type=pathlib.Path, default=SOURCE / "build/release/bin/flexcomp",
                        metavar="FILE", help="what is scored (default: build/release/bin/flexcomp)")
    parser.add_argument("--limit", type=float, default=300.0, metavar="S",
                        help="seconds after which a run counts as failed (default 300)")
    parser.add_argument("--without", choices=[*CATALOGUE, without.ALL], metavar="EFFECT",
                        help="leave an effect out of the catalogue, and compare with it on --single "
                        "cases that conceal it; all: each effect in turn, --single cases of each")
    options = parser.parse_args()
    if not os.access(options.tool, os.X_OK):
        parser.error(f"{options.tool} is not there; run tools/build first")
    if options.jobs < 1:
        parser.error("argument --jobs: needs at least 1")
    return options


def _progress(done, total, begin):
    if sys.stderr.isatty():
        elapsed = time.monotonic() - begin
        left = elapsed / done * (total - done) if done else 0
        sys.stderr.write(f"\r{done} of {total} cases, about {left / 60:.0f} min left \033[K")
        sys.stderr.write("\n" if done == total else "")
        sys.stderr.flush()


def collect(options, folder):
    """Results of all cases, in their order; raises KeyboardInterrupt where the user interrupts."""
    digest = trial.generator_digest()
    numbers = {"single": options.single, "pair": options.pairs, "clean": options.clean,
               "foreign": options.foreign, "variant": options.variant}
    trials = [trial.Trial(options.tool.resolve(), family, options.seed + k,
                          folder / f"{family}-{options.seed + k}", digest, options.limit,
                          bool(options.keep))
              for family in case.FAMILIES for k in range(numbers[family])]
    results, begin = [], time.monotonic()
    # Leaving the pool ends the workers.
    with multiprocessing.Pool(options.jobs, trial.leave_interrupts_to_the_parent) as pool:
        for wanted, result in zip(trials, pool.imap(trial.run, trials)):
            if result is None:
                print(f"left out: {wanted.family} {wanted.seed} gives no case", file=sys.stderr)
            else:
                results.append(result)
            _progress(len(results), len(trials), begin)
    return results


def _write(results, found, missed, folder, seed):
    scores = {"seed": seed, "goals_met": not missed,
              "goals": [dataclasses.asdict(goal) | {"met": goal not in missed}
                        for goal in figures.GOALS],
              "figures": {name: figure.as_json() if isinstance(figure, figures.Rate) else figure
                          for name, figure in found.items()}}
    (folder / "scores.json").write_text(json.dumps(scores, indent=1) + "\n")
    with (folder / "cases.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        names = [field.name for field in dataclasses.fields(results[0])] if results else []
        writer.writerow(names)
        for result in results:
            row = dataclasses.asdict(result)
            row["holdout_ratio"] = " ".join(f"{channel}={ratio:.3f}"
                                            for channel, ratio in result.holdout_ratio.items())
            writer.writerow([row[name] for name in names])


def _print(results, found, missed, folder):
    print(table.render(results, list(CATALOGUE)))
    print()
    for name, figure in found.items():
        shown = f"{figure:6.2f}" if isinstance(figure, float) else figure
        print(f"{name:<52} {'no case' if shown is None else shown}")
    print()
    for goal in figures.GOALS:
        figure = found[goal.figure]
        if figures.value_of(figure) is None:
            continue
        few = isinstance(figure, figures.Rate) and len(
            [r for r in results if goal.figure.startswith(r.family)]) < goal.cases
        print(f"{'MISSED' if goal in missed else 'holds':<7} {goal.figure}: "
              f"{'at least' if goal.at_least else 'at most'} {goal.limit:g}"
              + (f" (asks for {goal.cases} cases; these are fewer)" if few else ""))
    print(f"\nAll cases: {folder / 'cases.csv'}; figures: {folder / 'scores.json'}")


def main():
    options = arguments()
    folder = (options.keep or SOURCE / "build/diagnosis-trials").resolve()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        if options.without:
            return without.score(options, folder)
        results = collect(options, folder)
    except KeyboardInterrupt:
        print("\ninterrupted; nothing is scored", file=sys.stderr)
        return 130
    found = figures.figures(results)
    missed = figures.unmet(found)
    _write(results, found, missed, folder, options.seed)
    _print(results, found, missed, folder)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
