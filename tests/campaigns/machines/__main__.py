"""Diagnoses public recordings of real machines, and says whether what was to be reached is
reached."""

import argparse
import os
import pathlib
import sys

from . import planting, study
from .plot import NoPicture
from .registry import MACHINES
from .rivals import comparison
from .study import NoAnswer, Trial
from .tables import Damaged
from .tool import Tool

SOURCE = pathlib.Path(__file__).resolve().parents[3]
VARIABLE = "FLEXCOMP_MACHINE_DATA"
EPILOG = f"""\
Machines: {", ".join(MACHINES)} (default: all).

Each reads the published files from its folder of the data, as its page says where to get them
(tests/campaigns/machines/MACHINE/README.md); a machine whose files are not there is skipped.

Exit code 0: every goal holds of those whose data are there; 1: one does not, or there was no
answer; 2: unusable arguments or files; 130: interrupted.
"""


def arguments():
    parser = argparse.ArgumentParser(
        prog="tools/diagnose-machines", description=__doc__, epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("machines", nargs="*", metavar="MACHINE", help="which to diagnose")
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get(VARIABLE),
                        metavar="DIR", help=f"folder of the published files (default: {VARIABLE})")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE / "build/machines",
                        metavar="DIR", help="folder to write to (default: build/machines)")
    parser.add_argument("--tool", type=pathlib.Path, default=SOURCE / "build/release/bin/flexcomp",
                        metavar="FILE", help="the command (default: build/release/bin/flexcomp)")
    parser.add_argument("--pictures", action="store_true", help="draw pictures beside the answers")
    parser.add_argument("--plant-effects", type=int, metavar="K",
                        help="plant K known effects into each recording instead, each at "
                        f"{', '.join(map(str, planting.SIZES))} times the residual that is left, and "
                        "find them again")
    parser.add_argument("--seed", type=int, default=0, metavar="S",
                        help="draws the effects to plant (default 0)")
    parser.add_argument("--keep", action="store_true",
                        help="take the answers that are in --out already")
    parser.add_argument("--rivals", action="store_true",
                        help="run other packages on the same torques and write the table of README.md")
    options = parser.parse_args()
    for name in options.machines:
        if name not in MACHINES:
            parser.error(f"'{name}' is no machine; there are {', '.join(MACHINES)}")
    if options.data is None:
        parser.error(f"where are the recordings? Say --data DIR or set {VARIABLE}")
    if options.plant_effects is not None and options.plant_effects < 1 or options.seed < 0:
        parser.error("--plant-effects needs at least 1, and --seed must not be negative")
    options.data = pathlib.Path(options.data)
    if not options.data.is_dir():
        parser.error(f"{options.data} is no folder")
    if not os.access(options.tool, os.X_OK):
        parser.error(f"{options.tool} is not there; run tools/build first")
    return options


def _progress(text):
    if sys.stderr.isatty():
        sys.stderr.write(f"\r{text}\033[K")
        sys.stderr.flush()


def _absent(data, reader):
    """The first of the reader's files that is not there, or None."""
    return next((reader.FOLDER + "/" + name for name in reader.FILES
                 if not (data / reader.FOLDER / name).is_file()), None)


def diagnose(name, options):
    """study.Trial of a machine. Raises Damaged or NoAnswer."""
    reader, folder = MACHINES[name].reader, options.out.resolve() / name
    data, tool = options.data / reader.FOLDER, Tool(options.tool.resolve())
    _progress(f"{name}: reading")
    outcomes = {}
    for experiment in reader.write(data, folder):
        _progress(f"{name}: diagnosing {experiment.name}")
        place = folder / f"diagnosis_{experiment.name}"
        known = tool.recall(experiment, place) if options.keep else None
        outcomes[experiment.name] = known or tool.diagnose(experiment, place)
    _progress("")
    return Trial(outcomes, tool, data)


def compare(name, trial, folder):
    """Runs the rivals on a machine's torques, prints the lines of the table, and writes them to the page."""
    rows = {}
    for outcome in trial.outcomes.values():
        units = dict(outcome.groups())
        if "tau" not in units:
            print(f"  {outcome.experiment.name}: no torques, which is what the rivals explain")
            continue
        label = f"[{name}]({name}/README.md), {outcome.experiment.name}"
        results = comparison.compare(outcome, folder, _progress)
        rows[label] = comparison.lines_of_table(label, units["tau"], results)
    _progress("")
    print("\n".join(line for lines in rows.values() for line in lines))
    comparison.update_page(rows)


def _print_outcome(outcome):
    answer = outcome.answer
    print(f"  {outcome.experiment.name}: {answer.verdict}")
    for finding in answer.findings:
        print(f"    {finding}")
    if answer.reason:
        nearest = f"; nearest: {', '.join(answer.nearest)}" if answer.nearest else ""
        print(f"    left: {answer.reason}{nearest}")
    for group, unit in outcome.groups():
        signal = outcome.signal(group)
        before, after = (outcome.errors(simulated, group)
                         for simulated in (outcome.before, outcome.after))
        print(f"    held out, {group}, rms: {study.rms(before):.4g} to {study.rms(after):.4g} "
              f"{unit}; relative: {study.relative(before, signal):.3f} "
              f"to {study.relative(after, signal):.3f}")


def report(name, trial):
    """Prints a machine's paragraph; whether every goal is reached."""
    machine = MACHINES[name]
    print(f"{name}: {machine.reader.TITLE}\n  left out: {machine.reader.LEFT_OUT}")
    for outcome in trial.outcomes.values():
        _print_outcome(outcome)
    goals = machine.goals.judge(trial)
    for goal in goals:
        print(f"  {'holds' if goal.reached else 'MISSED'}: {goal.text}: {goal.found}")
    return all(goal.reached for goal in goals)


def run(name, options):
    """Exit code of one machine."""
    absent = _absent(options.data, MACHINES[name].reader)
    if absent is not None:
        print(f"{name}: skipped, its data are not there ({absent})")
        return 0
    try:
        trial = diagnose(name, options)
        reached = report(name, trial)
        if options.rivals:
            compare(name, trial, options.out.resolve() / name)
        if options.pictures:
            MACHINES[name].pictures.draw(trial, options.out.resolve() / name)
        return 0 if reached else 1
    except (Damaged, NoPicture, comparison.NoRivals) as error:
        _progress("")
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    except NoAnswer as error:
        _progress("")
        print(f"{name}: {error}", file=sys.stderr)
        return 1


def plant(options):
    """Exit code of all machines with planted effects."""
    machines, planted, code, folder = [], [], 0, options.out.resolve()
    for name in options.machines or MACHINES:
        reader = MACHINES[name].reader
        absent = _absent(options.data, reader)
        if absent is not None:
            print(f"{name}: skipped, its data are not there ({absent})")
            continue
        try:
            experiments = reader.write(options.data / reader.FOLDER, folder / name)
            found = planting.run(name, experiments, Tool(options.tool.resolve()), folder / name,
                                 options.plant_effects, options.seed, _progress)
        except (Damaged, NoAnswer) as error:
            _progress("")
            print(f"{name}: {error}", file=sys.stderr)
            code = max(code, 2 if isinstance(error, Damaged) else 1)
            continue
        machines += found[0]
        planted += found[1]
        planting.write(folder / "planted.json", machines, planted)
    _progress("")
    if not planted:
        return code
    print(planting.table(machines, planted))
    for words, holds, numbers in planting.goals_met(machines, planted):
        print(f"{'holds' if holds else 'MISSED'}: {words}: {numbers}")
        code = max(code, 0 if holds else 1)
    return code


def main():
    options = arguments()
    try:
        if options.plant_effects:
            return plant(options)
        return max(run(name, options) for name in options.machines or MACHINES)
    except KeyboardInterrupt:
        print("\ninterrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
