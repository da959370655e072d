"""Effects are left out of the catalogue, one after the other: how well laws, and what is still listed, make
up for each."""

import collections
import dataclasses
import json
import multiprocessing
import shutil
import subprocess

from generator import case
from generator.effects import CATALOGUE

from . import trial

WORSE = 2.0  # times the held-out error with the effect, up to which it is made up for
SHARE = 0.7  # of the effects that a command can undo, of which this shall be so
PLACED = 0.9  # of the cases in which a law is given: it is at the right place
ALL = "all"

# Where a law names the place rightly, by what the effect alters; beside the joint, where it has one.
TORQUE = ("joint_torque", "sensor tau")
ANGLE = ("joint_angle", "joint_windup")
TOOL = ("tcp_tool", "tcp_base")
BASE = ("base", "tcp_base")
FORCE = tuple(f"sensor {axis}" for axis in ("fx", "fy", "fz", "mx", "my", "mz"))
CLOCK = ()  # no law acts there
PLACES = {
    "joint_stiffness": ANGLE, "nonlinear_stiffness": ANGLE, "link_flexibility": ANGLE + TOOL,
    "base_compliance": BASE, "tool_compliance": TOOL, "payload": TORQUE + ANGLE, "link_mass": TORQUE + ANGLE,
    "gravity_compensator": TORQUE + ANGLE, "joint_offset": ANGLE, "link_length": ANGLE + TOOL,
    "tcp_offset": TOOL, "thermal_drift": ANGLE + TOOL + BASE, "backlash": ANGLE, "hysteresis": ANGLE,
    "transmission_ripple": ANGLE, "servo_lag": ANGLE + TORQUE, "resonance": ANGLE + TORQUE,
    "wrench_bias": FORCE, "wrench_scale": FORCE, "wrench_frame": FORCE, "time_offset": CLOCK,
    "coulomb_friction": TORQUE, "viscous_friction": TORQUE, "stribeck_friction": TORQUE,
    "rotor_inertia": TORQUE, "torque_ripple": TORQUE, "torque_offset": TORQUE}
# Effects that move the tool, so that a command can undo them. A vibration is fed by commands.
UNDONE = tuple(name for name, effect in CATALOGUE.items()
               if "xyz" in effect.groups and not name.startswith("wrench_")
               and name not in ("time_offset", "resonance"))


@dataclasses.dataclass
class Pair:
    """A case's held-out errors over the noise with the effect in the catalogue and without it."""

    effect: str
    seed: int
    kind: str
    place: str
    with_it: float
    without_it: float
    found: list  # without it: "law at joint_torque 5: a*q4", "payload"
    is_placed: bool | None  # whether a law is at the right place; None where none is given

    @property
    def is_made_up_for(self):
        return self.without_it <= WORSE * self.with_it


def seeds(effect, first, count):
    """The first seeds whose single cases conceal the effect."""
    found, seed = [], first
    while len(found) < count:
        if case.SINGLES[seed * 29 % len(case.SINGLES)][0] == effect:
            found.append(seed)
        seed += 1
    return found


def _answer(task, truth, out, words):
    shutil.rmtree(out, ignore_errors=True)
    command = trial.command(task.tool, task.folder, truth, out) + words
    done = subprocess.run(command, capture_output=True, text=True, timeout=task.limit,
                          stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise RuntimeError(f"seed {task.seed}: {done.stderr.strip()}")
    return json.loads((out / "diagnosis.json").read_text())


def _error(answer, truth):
    return max(answer["final"][channel]["holdout_rms"] / noise
               for channel, noise in truth["noise_rms"].items() if channel in answer["final"])


def _told(finding):
    if finding["effect"] != "law":
        return f"{finding['effect']} {finding['joint'] or ''}".strip()
    where = finding["joint"] or finding.get("axis") or ""
    return f"law at {finding['place']} {where}".strip() + f": {finding['formula']}"


def is_at(law, effect, joint):
    """Whether a law is where an effect acts at a joint (None: on the machine)."""
    same_joint = joint is None or law["joint"] in (None, joint)
    return same_joint and law["place"] in PLACES[effect]


def compare(task):
    """Pair of a trial and the effect's name, or None where its seed gives no case of it."""
    own, effect = task
    try:
        truth = trial.prepare("single", own.seed, own.folder, own.digest)
    except case.NoCase:
        return None
    concealed = truth["effects"][0]
    if concealed["effect"] != effect:
        return None
    whole = _answer(own, truth, own.folder / "with", [])
    less = _answer(own, truth, own.folder / "without", ["--without", effect])
    laws = [finding for finding in less["findings"] if finding["effect"] == "law"]
    placed = any(is_at(law, effect, concealed["joint"]) for law in laws) if laws else None
    return Pair(effect, own.seed, truth["kind"], f"{effect} {concealed['joint'] or ''}".strip(),
                _error(whole, truth), _error(less, truth), [_told(each) for each in less["findings"]],
                placed)


def _show(pair):
    print(f"{pair.seed:8} {pair.kind:7} {pair.place:22} {pair.with_it:7.2f} {pair.without_it:7.2f}  "
          + ("; ".join(pair.found) or "nothing"), flush=True)


def made_up_for(pairs):
    """The effects of which at least half of the cases are made up for."""
    by_effect = collections.defaultdict(list)
    for pair in pairs:
        by_effect[pair.effect].append(pair.is_made_up_for)
    return {effect for effect, cases in by_effect.items() if 2 * sum(cases) >= len(cases)}


def _summary(pairs):
    """Prints the figures; whether the goals hold."""
    effects = {pair.effect for pair in pairs}
    made_up = made_up_for(pairs)
    asked = effects & set(UNDONE) or effects
    placed = [pair.is_placed for pair in pairs if pair.is_placed is not None]
    print(f"\nheld-out error at most {WORSE:g} times as large: "
          f"{sum(pair.is_made_up_for for pair in pairs)} of {len(pairs)} cases; in half of the cases or "
          f"more of {len(made_up)} of {len(effects)} effects, and of {len(made_up & asked)} of {len(asked)} "
          "that a command can undo\n"
          f"a law at the right place: {sum(placed)} of {len(placed)} cases in which one is given")
    others = sorted(effects - made_up)
    if others:
        print("not made up for: " + ", ".join(others))
    return len(made_up & asked) >= SHARE * len(asked) and sum(placed) >= PLACED * len(placed)


def score(options, folder):
    """Prints a row a case; exit code 1 where too little is made up for, or at wrong places."""
    digest = trial.generator_digest()
    effects = list(CATALOGUE) if options.without == ALL else [options.without]
    tasks = [(trial.Trial(options.tool.resolve(), "single", seed, folder / f"without-{seed}", digest,
                          options.limit, True), effect)
             for effect in effects for seed in seeds(effect, options.seed, options.single)]
    pairs = []
    with multiprocessing.Pool(options.jobs, trial.leave_interrupts_to_the_parent) as pool:
        for pair in pool.imap(compare, tasks):
            if pair:
                _show(pair)
                pairs.append(pair)
    if not pairs:
        print("no seed gives a case")
        return 1
    return 0 if _summary(pairs) else 1
