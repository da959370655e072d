"""Known effects planted into real recordings, and whether they are found again.

A machine is diagnosed first; what was learnt becomes its model. Of that model some residual is left. One
thing is then changed: an effect's exact consequence is added to the measured channel, so many times as
large as that residual. The diagnosis of the changed recording must name it. What it names on the
unchanged recording, with the same model, is no news.
"""

import dataclasses
import json
import shutil

import numpy as np

from . import consequences
from .tables import COLUMNS, columns_of, read_recording, write_recording
from .urdf_arm import UrdfArm, coupled

SIZES = 3, 6, 12  # times the residual that is left, root mean squares
GOAL = {6: 0.90, 12: 0.98}  # share that is named rightly
QUIET = 0.98  # share of the unchanged recordings in which nothing new is named
SMALL = 1e-6  # of an effect's amount, for its slope
ATTEMPTS = 20  # draws for one that a machine may have


@dataclasses.dataclass
class Planted:
    """One effect at one size: new: names of findings that the unchanged recording has not."""

    machine: str
    experiment: str
    effect: str
    size: int
    amount: float
    found: bool
    new: list
    wrong: list
    verdict: str


@dataclasses.dataclass
class Machine:
    """An experiment as it was diagnosed: model with what was learnt, findings of the unchanged
    recordings with it, residual left by column."""

    name: str
    experiment: object
    arm: object
    baseline: list
    left: dict


def _residual(tool, model, paths, folder):
    """{column: rms} of measured less simulated over recordings."""
    squares = {}
    for path in paths:
        measured, simulated = read_recording(path), tool.simulate(model, path,
                                                                  folder / "simulated.csv")
        for group in ("tau", "q_link", "xyz"):
            for column in columns_of(measured, group):
                left = measured[column] - simulated[column]
                squares.setdefault(column, []).append(left[np.isfinite(left)] ** 2)
    return {column: float(np.sqrt(np.mean(np.concatenate(parts))))
            for column, parts in squares.items() if sum(map(len, parts))}


def learnt(name, experiment, tool, folder):
    """Diagnoses an experiment, and once more with what was learnt: a Machine. Raises NoAnswer."""
    first = tool.diagnose(experiment, folder / f"learnt_{experiment.name}")
    model = dataclasses.replace(experiment, model=first.updated_model)
    second = tool.diagnose(model, folder / f"unchanged_{experiment.name}")
    arm = UrdfArm(experiment.model)
    arm.coupled = coupled(first.updated_model)
    left = _residual(tool, first.updated_model, experiment.recordings, folder)
    return Machine(name, model, arm, second.answer.findings, left)


def _ratio(trace, left):
    """Of a trace's columns the largest rms over the residual's."""
    return max((float(np.sqrt(np.nanmean(np.square(values)))) / left[column]
                for column, values in trace.items() if left.get(column)), default=0.0)


def amount_for(effect, recording, left, size):
    """Amount by which an effect stands `size` times out of the residual."""
    slope = _ratio(effect.trace(recording, SMALL), left) / SMALL
    return size / slope if slope > 0 else np.inf


def _changed(path, effect, amount, target):
    """Writes the recording at path, with the effect, to target."""
    recording = read_recording(path)
    trace = effect.trace(recording, amount)
    groups = {group: np.column_stack([recording[column] + trace.get(column, 0.0)
                                      for column in columns_of(recording, group)])
              for group in COLUMNS if columns_of(recording, group)}
    return write_recording(target, recording["t"], **groups)


def _plant(machine, effect, size, tool, folder):
    """A Planted. Raises NoAnswer."""
    experiment = machine.experiment
    amount = amount_for(effect, read_recording(experiment.recordings[0]), machine.left, size)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    changed = [_changed(path, effect, amount, folder / f"planted_{path.name}")
               for path in [*experiment.recordings, experiment.holdout]]
    answer = tool.diagnose(dataclasses.replace(experiment, recordings=changed[:-1],
                                               holdout=changed[-1]), folder / "diagnosis").answer
    before = {finding.name for finding in machine.baseline}
    new = [finding for finding in answer.findings if finding.name not in before]
    return Planted(machine.name, experiment.name, str(effect), size, float(amount),
                   any(effect.matches(finding) for finding in new),
                   [finding.name for finding in new],
                   [finding.name for finding in new if not effect.matches(finding)],
                   answer.verdict)


def _able(machine, rng, count):
    """Effects that the machine may have at the largest size, and that it is not said to have."""
    recording, found = read_recording(machine.experiment.recordings[0]), []
    for _ in range(ATTEMPTS):
        for effect in consequences.drawn(rng, recording, machine.arm, count):
            amount = amount_for(effect, recording, machine.left, max(SIZES))
            known = any(effect.matches(finding) for finding in machine.baseline)
            if amount <= effect.most_in(recording) and not known and len(found) < count:
                found.append(effect)
        if len(found) == count:
            break
    return found


def run(name, experiments, tool, folder, count, seed, progress):
    """([Machine], [Planted]) of a machine's experiments. Raises NoAnswer."""
    machines, planted = [], []
    for experiment in experiments:
        progress(f"{name}: diagnosing {experiment.name}")
        machine = learnt(name, experiment, tool, folder)
        machines.append(machine)
        rng = np.random.default_rng([seed, *f"{name} {experiment.name}".encode()])
        effects = _able(machine, rng, count)
        for number, effect in enumerate(effects):
            for size in SIZES:
                progress(f"{name} {experiment.name}: {effect} at {size} times, "
                         f"{number + 1} of {len(effects)}")
                planted.append(_plant(machine, effect, size, tool,
                                      folder / f"planted_{experiment.name}"))
    return machines, planted


def _share(rows, size, what):
    chosen = [row for row in rows if row.size == size]
    return f"{sum(map(what, chosen))} of {len(chosen)}" if chosen else "–"


def _line(name, machines, rows):
    cells = [name, str(sum(bool(machine.baseline) for machine in machines))
             + f" of {len(machines)}"]
    for size in SIZES:
        cells += [_share(rows, size, lambda row: row.found),
                  _share(rows, size, lambda row: bool(row.wrong))]
    return "| " + " | ".join(cells) + " |"


def table(machines, planted):
    """The table of a README, Markdown."""
    heads = ["machine", "unchanged: named all the same"]
    for size in SIZES:
        heads += [f"{size} ×: found", "wrong beside"]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for name in dict.fromkeys(machine.name for machine in machines):
        lines.append(_line(name, [machine for machine in machines if machine.name == name],
                           [row for row in planted if row.machine == name]))
    lines.append(_line("all", machines, planted))
    return "\n".join(lines)


def goals_met(machines, planted):
    """[(words, whether it holds, in numbers)]"""
    found = []
    for size, share in GOAL.items():
        rows = [row for row in planted if row.size == size]
        right = sum(row.found for row in rows)
        found.append((f"planted at {size} times the residual: right effect and joint in at least "
                      f"{share:.0%}", right >= share * len(rows), f"{right} of {len(rows)}"))
    quiet = sum(not machine.baseline for machine in machines)
    found.append((f"unchanged: nothing new in at least {QUIET:.0%}",
                  quiet >= QUIET * len(machines), f"{quiet} of {len(machines)}"))
    return found


def write(path, machines, planted):
    """All figures as JSON."""
    path.write_text(json.dumps({
        "sizes": SIZES,
        "unchanged": [{"machine": machine.name, "experiment": machine.experiment.name,
                       "named": [finding.name for finding in machine.baseline],
                       "left": machine.left} for machine in machines],
        "planted": [dataclasses.asdict(row) for row in planted]}, indent=1) + "\n")


