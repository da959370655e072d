"""Cases: a robot, what it does, what is concealed in it, and the files that tell of it."""

import dataclasses

import numpy as np

from plant import description as descriptions, recording, sensors, simulation

from . import catalogue, cell, kinds, modes, paths, strength

SHARES = {"effect": 70, "pair": 10, "clean": 10, "foreign": 10}  # of a hundred
TARGET = 5.0, 35.0  # effect over noise, drawn between
ACCEPTED = 4.0, 45.0
ROUNDS = 4  # to bring an effect to its size
ATTEMPTS = 30  # to find motions within reach, and a place where an effect shows
TWICE = "circle", "air", "static", "mixed"  # kinds of which two recordings are for training
WEIGHTY = 0.5  # share of cases with gravity, where the effect leaves the choice


class Unsuitable(Exception):
    """The draw shows too little of its effect; another one should be drawn."""


@dataclasses.dataclass(frozen=True)
class Case:
    """A case as drawn; everything else follows from it and from its seed."""

    family: str  # effect, pair, clean or foreign
    kind: str
    names: tuple  # of effects, or of the foreign physics
    seed: tuple  # of numpy's generator


def _spread(rng, entries, count):
    """`count` of (name, kind), all names about as often, all kinds of a name about as often."""
    picked = []
    while len(picked) < count:
        for name in rng.permutation(list(entries)):
            kinds_of = entries[str(name)].kinds
            before = sum(other == name for other, _ in picked)
            offset = sum(str(name).encode()) + before
            picked.append((str(name), kinds_of[offset % len(kinds_of)]))
    return picked[:count]


def _pairs(rng, count):
    """Two effects that can sit in one kind of recording."""
    picked = []
    for number in range(count):
        kind = ("circle", "torque", "static", "link", "mixed", "air")[number % 6]
        names = [name for name, entry in catalogue.SINGLE.items()
                 if kind in entry.kinds and name not in ("servo_lag", "resonance")]
        picked.append((tuple(str(name) for name in rng.choice(names, 2, replace=False)), kind))
    return picked


def draw(seed, count):
    """`count` cases in the campaign's mix, in an order that tells nothing."""
    rng = np.random.default_rng([seed, 0])
    parts = {name: count * share // 100 for name, share in SHARES.items()}
    parts["effect"] += count - sum(parts.values())
    drawn = [("effect", kind, (name,)) for name, kind in
             _spread(rng, catalogue.SINGLE, parts["effect"])]
    drawn += [("pair", kind, names) for names, kind in _pairs(rng, parts["pair"])]
    drawn += [("clean", kinds.KINDS[k % len(kinds.KINDS)], ()) for k in range(parts["clean"])]
    drawn += [("foreign", kind, (name,)) for name, kind in
              _spread(rng, catalogue.ODD, parts["foreign"])]
    order = rng.permutation(len(drawn))
    return [Case(*drawn[index], seed=(seed, 1, number)) for number, index in enumerate(order)]


def _entry(name):
    return catalogue.SINGLE.get(name) or catalogue.ODD[name]


def _course(rng, kind, description, rated, choose, slow):
    for _ in range(ATTEMPTS):
        try:
            return kinds.course(rng, kind, description, choose(), rated, slow)
        except paths.Unreachable:
            continue
    raise Unsuitable("out of reach")


def _groups(rng, case, effects):
    groups = kinds.GROUPS[case.kind]
    if "servo_lag" in case.names:
        groups = tuple("q_cmd" if name == "q_meas" else name for name in groups)
    drift = next((effect for effect in effects if effect.name == "thermal_drift"), None)
    warm = "time_constant" not in drift.parameters if drift else rng.random() < 0.2
    return groups + (("temp_c",) if warm else ())


def scale_of(kind, description, course, signals):
    """catalogue.Scale of what the unchanged robot does in a course."""
    load = (signals.q_link - signals.q_meas) / description.column("compliance")
    velocity = getattr(course, "velocity", np.zeros((1, 6)))
    return catalogue.Scale(
        kind, description, np.abs(load).max(0), np.stack([load.min(0), load.max(0)], 1),
        np.abs(signals.tau).max(0), np.abs(velocity).max(0), np.ptp(course.q, 0),
        float(np.linalg.norm(signals.wrench[:, :3], axis=1).max()), float(signals.time[-1]),
        modes.single_joint_modes(description, course.q[0]))


class _Work:
    """A case on its way: robot, motions, sensors, and what the unchanged robot does."""

    def __init__(self, case, folder, attempt):
        self.case = case
        self.rng = np.random.default_rng([*case.seed, attempt])
        entries = [_entry(name) for name in case.names]
        gravity = (any(entry.gravity for entry in entries)
                   or self.rng.random() < WEIGHTY or case.kind in ("torque", "link"))
        slow = any(entry.slow for entry in entries)
        self.robot, self.rated = cell.write_model(self.rng, folder / "model", gravity)
        self.description = descriptions.load(folder / "model" / "robot.yaml")
        center = self.center = paths.posture(self.rng)
        self.courses = {}
        for name in ("train", "train_2", "holdout") if case.kind in TWICE else ("train", "holdout"):
            self.courses[name] = _course(self.rng, case.kind, self.description, self.rated,
                                         lambda: paths.nearby(self.rng, center), slow)
        self.courses["untrained"] = _course(self.rng, case.kind, self.description, self.rated,
                                            lambda: paths.far_from(self.rng, center), slow)
        for course in self.courses.values():
            self._warm(course)
        self.clean = self.run([], "train")
        self.scale = scale_of(case.kind, self.description, self.courses["train"], self.clean)
        self.sensors = sensors.draw(self.rng, self.description, self.scale.torque)
        self.effects = []

    def _warm(self, course):
        rows = len(course.temperature)
        course.temperature[:] = kinds.warming(self.rng, np.arange(rows) / rows)

    def run(self, effects, name):
        """Signals of one of the courses."""
        rng = np.random.default_rng([*self.case.seed, ATTEMPTS, sorted(self.courses).index(name)])
        return simulation.simulate(self.description, effects, self.courses[name], rng)

    def conceal(self, name):
        """Adds an effect that stands out of the noise by a drawn ratio."""
        entry = _entry(name)
        joints = entry.joints(self.scale) if callable(entry.joints) else entry.joints
        if not joints:
            raise Unsuitable("no joint shows it")
        joint = joints[self.rng.integers(len(joints))]
        joint = None if joint is None else int(joint)
        groups = _groups(np.random.default_rng(0), self.case, [])
        without = strength.shown(self.description, self.clean, groups)
        target = float(np.exp(self.rng.uniform(*np.log(TARGET))))
        seed, size, before = self.rng.integers(2**63), 1.0, None
        for _ in range(ROUNDS):
            effect = entry.draw(np.random.default_rng(seed), joint, self.scale, size)
            if effect.parameters == before:
                break  # as large as such robots show
            before = dict(effect.parameters)
            signals = self.run([effect], "train")
            found = strength.ratio(strength.shown(self.description, signals, groups), without,
                                   self.sensors, groups, entry.local)
            if ACCEPTED[0] <= found <= ACCEPTED[1]:
                self.effects.append(effect)
                return found
            size *= float(np.clip(target / max(found, 1e-9), 0.05, 20))
        raise Unsuitable(f"{name} does not come to a fair size")


def _truth(work, ratios, groups):
    levels = sensors.noise_levels(work.sensors)
    case = work.case
    concealed = [{"effect": effect.name, "joint": effect.joint, "parameters": effect.parameters,
                  "over_noise": round(ratio, 2)} for effect, ratio in zip(work.effects, ratios)]
    for entry, effect in zip(concealed, work.effects):
        if effect.name == "time_offset":
            entry["channel"] = effect.group
    is_foreign = case.family == "foreign"
    return {"family": "effect" if case.family == "pair" else case.family,
            "effects": [] if is_foreign else concealed,
            "foreign": concealed[0] if is_foreign else None,
            "kind": case.kind, "columns": list(groups), "robot": work.robot,
            "gravity": bool(work.description.gravity.any()), "seed": list(case.seed),
            "noise": {strength.CHANNELS[group]: [float(value) for value in levels[group]]
                      for group in strength.CHANNELS if group in groups}}


def _drawn(case, folder):
    """(_Work, how far each effect stands out of the noise, signals by recording)."""
    for attempt in range(ATTEMPTS):
        try:
            work = _Work(case, folder, attempt)
            ratios = [work.conceal(name) for name in case.names]
            return work, ratios, {name: work.run(work.effects, name) for name in work.courses}
        except (Unsuitable, FloatingPointError):
            for left in (folder / "model").iterdir():
                left.unlink()
    raise Unsuitable(f"nothing fair came of {ATTEMPTS} draws from {case.seed}")


def rebuild(case, folder):
    """The same plant once more: its description, effects, rated (N), and the posture center (6,) that
    it worked about, as attributes. Raises Unsuitable."""
    return _drawn(case, folder)[0]


def write_case(case, folder):
    """Writes model/ and the recordings into a folder, and returns the truth."""
    work, ratios, signals = _drawn(case, folder)
    groups = _groups(work.rng, case, work.effects)
    for name, each in signals.items():
        course = work.courses[name]
        time, shown = sensors.record(work.rng, work.sensors, each, groups,
                                     getattr(course, "run_in", 0.0))
        recording.write(folder / f"{name}.csv", time, shown)
    return _truth(work, ratios, groups)
