"""Cases of one made-up machine: torque recordings, frictions, offsets and a foreign ripple."""

import csv
import dataclasses
import math
import random

ROWS = 160
NOISE = 1.0  # N·m
NAMES = ("coulomb_friction", "viscous_friction", "torque_offset")
PARAMETERS = {"coulomb_friction": "torque", "viscous_friction": "coefficient",
              "torque_offset": "torque"}
FOREIGN = "moonlight"
JOINTS = range(1, 7)
MODEL = '{"effects": []}\n'  # JSON is YAML, and quicker to load


class Unsuitable(Exception):
    """No fair case came of the draw."""


@dataclasses.dataclass(frozen=True)
class Case:
    family: str
    effects: tuple  # of (effect, joint, size)
    seed: int


def draw(seed, count):
    """In fives: three with an effect, one clean, one foreign."""
    rng = random.Random(seed)
    drawn = []
    for number in range(count):
        family = ("effect", "effect", "effect", "clean", "foreign")[number % 5]
        effect = (NAMES[number % 3], rng.randint(1, 6), rng.uniform(10, 30))
        drawn.append(Case(family, (effect,) if family == "effect" else (), 1000 * seed + number))
    return drawn


def motion(seed, low):
    """Rows of (t, angles, velocities)."""
    rng = random.Random(seed)
    phases = [rng.uniform(0, 6) for _ in JOINTS]
    for row in range(ROWS):
        t = 0.02 * row
        yield (t, [low + math.sin((1 + 0.3 * k) * t + phases[k]) for k in range(6)],
               [(1 + 0.3 * k) * math.cos((1 + 0.3 * k) * t + phases[k]) for k in range(6)])


def torque(effects, angles, velocities):
    """(6,) N·m of the machine with effects (effect, joint, size)."""
    found = [50 * math.sin(angle) for angle in angles]
    for name, joint, size in effects:
        speed = velocities[joint - 1]
        found[joint - 1] += size * {"coulomb_friction": math.copysign(1, speed),
                                    "viscous_friction": speed, "torque_offset": 1}[name]
    return found


def _write_recording(path, case, seed, low):
    rng = random.Random(seed)
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["t", *(f"q_meas_{k}" for k in JOINTS), *(f"tau_{k}" for k in JOINTS)])
        for t, angles, velocities in motion(seed, low):
            tau = torque(case.effects, angles, velocities)
            if case.family == "foreign":
                tau[2] += 15 * math.sin(7 * angles[0] * angles[4])
            writer.writerow([f"{t:.3f}", *(f"{angle:.6f}" for angle in angles),
                             *(f"{value + rng.gauss(0, NOISE):.6f}" for value in tau)])


def write_case(case, folder):
    """As the real one: writes model/ and recordings, returns the truth."""
    (folder / "model").mkdir()
    (folder / "model" / "robot.yaml").write_text(MODEL)
    for number, (name, low) in enumerate((("train", 0), ("holdout", 0), ("untrained", 2))):
        _write_recording(folder / f"{name}.csv", case, 10 * case.seed + number, low)
    effects = [{"effect": name, "joint": joint, "parameters": {PARAMETERS[name]: size}}
               for name, joint, size in case.effects]
    foreign = {"effect": FOREIGN, "joint": None, "parameters": {}}
    return {"family": case.family, "effects": effects, "kind": "torque", "robot": "made up",
            "foreign": foreign if case.family == "foreign" else None, "seed": case.seed,
            "noise": {"joint_torque": [NOISE] * 6}}
