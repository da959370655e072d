"""One case: everything drawn from (family, seed), and written into a folder."""

import dataclasses
import json

import numpy as np

from . import cell as cells, conceal, detect, foreign, kinds, machine as physics, recording, sensors
from .effects import CATALOGUE, VARIANTS
from .trace import CHANNELS, channels_of
from .trajectories import Unreachable

FAMILIES = ("single", "pair", "clean", "foreign", "variant")
ATTEMPTS = 40  # with one combination of effect and kind
FOREIGN_LIKENESS = 0.8  # no entry of the catalogue may fit a foreign trace better
PAIR_LIKENESS = 0.9

SINGLES = tuple((name, kind) for name, effect in CATALOGUE.items() for kind in effect.kinds)
VARIED = tuple((effect, kind) for effect in VARIANTS for kind in effect.kinds)
FOREIGNS = tuple((entry[0], kind) for entry in foreign.FOREIGN for kind in entry[1])


class NoCase(Exception):
    """Nothing suitable came of any draw from this seed."""


def _hints(effects):
    hints = {}
    for effect in effects:
        hints |= effect.hints
        if effect.groups == ("tau",):
            hints["torque"] = True
    return hints


def _single(rng, effect, kind, folder, patient):
    cell = cells.draw(rng, kind, _hints([effect]), folder)
    entry, _ = conceal.conceal(rng, cell, effect, conceal.rivals(cell, cell.training), patient)
    return cell, [entry]


def _pair(rng, kind, folder):
    names = [name for name, effect in CATALOGUE.items() if kind in effect.kinds]
    chosen = [CATALOGUE[str(name)] for name in rng.choice(names, 2, replace=False)]
    cell = cells.draw(rng, kind, _hints(chosen), folder)
    rivals = conceal.rivals(cell, cell.training)
    (first, one), (second, other) = (conceal.conceal(rng, cell, effect, rivals) for effect in chosen)
    if abs(one @ other) > PAIR_LIKENESS * np.linalg.norm(one) * np.linalg.norm(other):
        raise conceal.Unsuitable("too like each other")
    both = cell.difference(conceal.machine_of(cell.robot, [first, second]))
    for likeness in detect.likenesses(both, rivals, cell.training):
        if likeness.remainder < detect.REMAINDER:
            raise conceal.Unsuitable(f"both together are like {likeness.effect}")
    return cell, [first, second]


def _foreign_machine(rng, cell, intrude, take):
    machine = physics.Machine(cell.robot.copy())
    intrude(rng, machine, take.drive, cell.robot, cell.scale)
    return machine


def _foreign(rng, intrude, kind, folder):
    """Cell and a machine for each take."""
    hints = {"torque": True} if intrude is foreign.cable_harness else {}
    cell = cells.draw(rng, kind, hints, folder)
    seeds = rng.integers(2**63, size=1 if intrude in _PERMANENT else len(cell.takes))
    machines = [_foreign_machine(np.random.default_rng(seeds[k % len(seeds)]), cell, intrude,
                                 cell.takes[0] if intrude in _PERMANENT else take)
                for k, take in enumerate(cell.takes)]
    take, machine = cell.takes[0], machines[0]
    ratio = detect.signal_to_noise(cell.robot, machine, [take], cell.levels, cell.quality, local=True)
    if not ratio >= detect.FACTOR:
        raise conceal.Unsuitable("too weak")
    trace = cell.difference(machine, [take])
    likest = []
    for likeness in detect.likenesses(trace, conceal.rivals(cell, [take]), [take]):
        if likeness.correlation > FOREIGN_LIKENESS:
            raise conceal.Unsuitable(f"too like {likeness.effect}")
        likest.append(likeness)
    likest = detect.likest_first(likest)
    return cell, machines, ratio, likest[:3]


# Properties of the machine, the same in every take; the others happen anew.
_PERMANENT = (foreign.joint_coupling, foreign.tooth_defect, foreign.load_dependent_encoder,
              foreign.cable_harness, foreign.current_limit)


def _floor(cell, take, shown, truth):
    """Rms of what no model can predict, by channel: noise of the channel and of what it is predicted
    from, spikes and gaps left out."""
    floor = {}
    for group in channels_of(take):
        noise = np.broadcast_to(cell.levels[group], truth[group].shape)
        if group == "q_link":
            noise = noise[:, cell.quality.link_encoders]
        floor[CHANNELS[group]] = float(np.sqrt((noise**2).mean()))
    if "xyz" in take.columns and "wrench" in take.columns:
        rows = np.linspace(0, len(take.rows) - 1, min(len(take.rows), 250)).astype(int)
        model = physics.nominal(cell.robot)
        state = physics.at(physics.motors(model, take.drive), take.rows[rows])
        pair = []
        for wrench in (truth["wrench"], shown["wrench"]):
            state.wrench = wrench[rows]
            pair.append(physics.predict(model, state, ["xyz"])["xyz"])
        floor["tcp_position"] = float(np.hypot(floor["tcp_position"], np.sqrt(
            ((pair[1] - pair[0]) ** 2).mean())))
    return floor


def _write_take(rng, cell, take, machine, folder):
    groups = [name for name in physics.GROUPS if name in take.columns]
    truth = physics.measure(machine, take.drive, groups, take.rows)
    shown = sensors.add_noise(rng, cell.quality, truth, cell.levels)
    if "q_cmd" in take.columns:
        shown["q_cmd"] = physics.at(physics.motors(physics.nominal(cell.robot), take.drive),
                                    take.rows).q
    if "temp_c" in take.columns:
        temperature = np.interp(take.rows, np.arange(len(take.drive.temperature)), take.drive.temperature)
        shown["temp_c"] = (temperature + 0.05 * rng.normal(size=len(take.rows)))[:, None]
    recording.write(folder / f"{take.name}.csv", take.time, shown)
    return _floor(cell, take, shown, truth)


def _describe(entry):
    equivalents = [{"effect": other.effect, "joint": other.joint,
                    "correlation": round(other.correlation, 6)}
                   for other in entry.likest if other.correlation > detect.EQUIVALENT]
    likest = [dataclasses.asdict(other) for other in entry.likest[:3]]
    form = getattr(entry.effect, "form", "")
    if form:  # a law of its own says as much, and a law at the joint is of its own
        equivalents.append({"effect": "law", "joint": "any", "correlation": 1.0})
    return {"effect": entry.name, "form": form, "joint": entry.joint, "parameters": entry.parameters,
            "units": entry.effect.units, "signal_to_noise": entry.ratio, "equivalents": equivalents,
            "likest": likest}


def _attempt(family, seed, attempt, folder):
    rng = np.random.default_rng([FAMILIES.index(family), seed, attempt])
    truth = {"family": family, "seed": seed, "attempt": attempt, "effects": [], "foreign": None}
    if family == "single":
        # A stride without a common divisor visits all combinations in turn; one that stays unsuitable
        # gives way to the next.
        number = (seed * 29 + attempt // ATTEMPTS) % len(SINGLES)
        name, kind = SINGLES[number]
        cell, entries = _single(rng, CATALOGUE[name], kind, folder, attempt % ATTEMPTS < ATTEMPTS // 4)
    elif family == "variant":
        effect, kind = VARIED[(seed * 13 + attempt // ATTEMPTS) % len(VARIED)]
        cell, entries = _single(rng, effect, kind, folder, patient=False)
    elif family == "pair":
        kind = kinds.KINDS[seed % len(kinds.KINDS)]
        cell, entries = _pair(rng, kind, folder)
    elif family == "clean":
        kind = kinds.KINDS[seed % len(kinds.KINDS)]
        warming = {"warming": True} if rng.random() < 0.2 else {}
        cell, entries = cells.draw(rng, kind, warming, folder), []
    else:
        intrude, kind = FOREIGNS[(seed * 11 + attempt // ATTEMPTS) % len(FOREIGNS)]
        cell, machines, ratio, likest = _foreign(rng, intrude, kind, folder)
        truth["foreign"] = {"name": intrude.__name__, "signal_to_noise": ratio,
                            "likest": [dataclasses.asdict(other) for other in likest]}
    if family != "foreign":
        truth["effects"] = [_describe(entry) for entry in entries]
        machines = [conceal.machine_of(cell.robot, entries)] * len(cell.takes)
    return rng, cell, machines, truth


def write(family, seed, folder):
    """Draws the case, writes robot.yaml, its URDF, the recordings and truth.json into the folder (which
    exists and is empty); returns what truth.json says. Raises NoCase."""
    for attempt in range(6 * ATTEMPTS):
        try:
            rng, cell, machines, truth = _attempt(family, seed, attempt, folder)
            break
        except (Unreachable, conceal.Unsuitable):
            for left in folder.iterdir():
                left.unlink()
    else:
        raise NoCase(f"no suitable {family} case from seed {seed}")
    floors = [_write_take(rng, cell, take, machine, folder)
              for take, machine in zip(cell.takes, machines)]
    truth |= {"kind": cell.kind, "columns": list(cell.takes[0].columns),
              "rows": [len(take.rows) for take in cell.takes],
              "recordings": [f"{take.name}.csv" for take in cell.takes if not take.holdout],
              "holdout": next((f"{take.name}.csv" for take in cell.takes if take.holdout), None),
              "noise_rms": floors[0]}
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")
    return truth
