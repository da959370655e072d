"""Cases: half of them one foreign law, a quarter one beside an effect of the catalogue, a quarter
clean; each with a recording to learn from, one held out, and one of a region that nobody trained in.
"""

import dataclasses

import numpy as np

from campaign import case as campaign, catalogue, cell, kinds, paths, strength
from plant import description as descriptions, recording, sensors
from plant.motion import LoadTest

from . import menu, steady

PARTS = "train", "holdout", "untrained"
POSES, LOADS = 40, 2
WIDE = np.array([0.6, 0.3, 0.35, 0.8, 0.5, 1.2])  # rad either way
LEVER = 0.3  # m: the moment of a load over its force
GROUPS = kinds.GROUPS | {"poses": ("q_meas", "wrench", "xyz")}
CLEAN = "poses", "air", "torque", "circle", "link", "mixed"  # kinds of clean cases
DRAWS = 200  # of a posture, until it is within the limits


@dataclasses.dataclass(frozen=True)
class Case:
    """A case as drawn; everything else follows from it and from its seed."""

    family: str  # alone, beside or clean
    kind: str
    foreign: str | None  # name in menu.MENU
    known: str | None  # name in campaign.catalogue.SINGLE
    seed: tuple


def told(truth):
    """The Case of a truth."""
    foreign, known = (truth[key] and truth[key]["effect"] for key in ("foreign", "known"))
    return Case(truth["family"], truth["kind"], foreign, known, tuple(truth["seed"]))


def draw(seed, count):
    """`count` cases in the mix above; all kinds of physics about as often."""
    rng = np.random.default_rng([seed, 3])
    alone, beside = count - count // 4 - count // 4, count // 4
    names = []
    while len(names) < alone + beside:
        names += [str(name) for name in rng.permutation(list(menu.MENU))]
    found, before = [], {}
    for number in range(count):
        drawn = (seed, 3, number)
        if number >= alone + beside:
            kind = CLEAN[int(rng.integers(len(CLEAN)))]
            found.append(Case("clean", kind, None, None, drawn))
            continue
        name = names[number]
        able = menu.MENU[name].kinds
        kind = able[(before.get(name, 0) + sum(name.encode())) % len(able)]
        before[name] = before.get(name, 0) + 1
        known = str(rng.choice(menu.BESIDE[kind])) if number >= alone else None
        found.append(Case("beside" if known else "alone", kind, name, known, drawn))
    return [found[index] for index in rng.permutation(count)]


def _poses(rng, arm, center, force):
    """A LoadTest of a wide region: in each posture two loads."""
    postures = []
    for _ in range(DRAWS):
        try:
            q = center + rng.uniform(-1, 1, 6) * WIDE
            arm.check(q[None])
            postures.append(q)
        except paths.Unreachable:
            continue
        if len(postures) == POSES:
            break
    else:
        raise paths.Unreachable("joint limits")
    loads = rng.normal(size=(POSES, LOADS, 6))
    for half, size in ((slice(0, 3), force), (slice(3, 6), LEVER * force)):
        length = np.linalg.norm(loads[:, :, half], axis=2, keepdims=True)
        loads[:, :, half] *= size * rng.uniform(0.2, 1.0, (POSES, LOADS, 1)) / length
    return LoadTest(np.array(postures), loads, np.full(POSES * LOADS, kinds.ROOM))


class Work:
    """A case on its way: robot, motions, sensors, and what the robot does with some effects."""

    def __init__(self, case, folder, attempt):
        self.case, self._shown = case, {}
        self.rng = rng = np.random.default_rng([*case.seed, attempt])
        self.entries = [menu.MENU[case.foreign]] if case.foreign else []
        self.entries += [catalogue.SINGLE[case.known]] if case.known else []
        gravity = (case.kind in ("torque", "link") or any(each.gravity for each in self.entries)
                   or rng.random() < campaign.WEIGHTY)
        self.robot, self.rated = cell.write_model(rng, folder / "model", gravity)
        self.description = descriptions.load(folder / "model" / "robot.yaml")
        self.center = paths.posture(rng)
        self.courses = {part: self._course(paths.far_from if part == "untrained" else paths.nearby,
                                           self.center) for part in PARTS}
        self.groups = GROUPS[case.kind]
        clean, course = self.run((), "train"), self.courses["train"]
        scale = campaign.scale_of(case.kind, self.description, course, clean)
        self.scale = menu.Scale(**vars(scale), q=course.q, place=clean.xyz,
                                moment=float(np.linalg.norm(clean.wrench[:, 3:], axis=1).max()))
        self.sensors = sensors.draw(rng, self.description, self.scale.torque)

    def _course(self, choose, center):
        arm = paths.Arm(self.description)
        for _ in range(campaign.ATTEMPTS):
            try:
                start = choose(self.rng, center)
                if self.case.kind == "poses":
                    return _poses(self.rng, arm, start, self.rated * self.rng.uniform(0.5, 0.9))
                return kinds.course(self.rng, self.case.kind, self.description, start, self.rated)
            except paths.Unreachable:
                continue
        raise campaign.Unsuitable("out of reach")

    def run(self, effects, part):
        """Signals of one of the courses."""
        if (effects, part) not in self._shown:
            rng = np.random.default_rng([*self.case.seed, PARTS.index(part)])
            self._shown[effects, part] = steady.simulate(self.description, effects,
                                                         self.courses[part], rng)
        return self._shown[effects, part]

    def conceal(self, entry):
        """(effect, over the noise): one that stands out of the noise by a drawn ratio."""
        joints = entry.joints(self.scale) if callable(entry.joints) else entry.joints
        if not joints:
            raise campaign.Unsuitable("no joint shows it")
        joint = joints[self.rng.integers(len(joints))]
        joint = None if joint is None else int(joint)
        without = strength.shown(self.description, self.run((), "train"), self.groups)
        target = float(np.exp(self.rng.uniform(*np.log(campaign.TARGET))))
        seed, size = self.rng.integers(2**63), 1.0
        for _ in range(campaign.ROUNDS):
            effect = entry.draw(np.random.default_rng(seed), joint, self.scale, size)
            shown = strength.shown(self.description, self.run((effect,), "train"), self.groups)
            found = strength.ratio(shown, without, self.sensors, self.groups, entry.local)
            if campaign.ACCEPTED[0] <= found <= campaign.ACCEPTED[1]:
                return effect, found
            size *= float(np.clip(target / max(found, 1e-9), 0.02, 50))
        raise campaign.Unsuitable("it does not come to a fair size")

    def write(self, path, signals, part):
        """A recording, with the sensors' errors, which are the same for what the robot does with and
        without what is concealed."""
        rng = np.random.default_rng([*self.case.seed, len(PARTS), PARTS.index(part)])
        run_in = getattr(self.courses[part], "run_in", 0.0)
        time, shown = sensors.record(rng, self.sensors, signals, self.groups, run_in)
        recording.write(path, time, shown)


def _told(effect, ratio):
    return {"effect": effect.name, "joint": effect.joint, "parameters": effect.parameters,
            "over_noise": round(ratio, 2)}


def _truth(work, concealed):
    case, levels = work.case, sensors.noise_levels(work.sensors)
    told = [(effect, _told(effect, ratio)) for effect, ratio in concealed]
    foreign = None
    if case.foreign:
        law, foreign = told.pop(0)
        foreign |= {"exists": law.exists, "undone": law.undone, "kin": list(law.kin), "begins": law.begins,
                    "places": [list(place) for place in law.places()], "laws": law.laws()}
    return {"family": case.family, "kind": case.kind, "robot": work.robot,
            "gravity": bool(work.description.gravity.any()), "seed": list(case.seed),
            "foreign": foreign, "known": told[0][1] if told else None,
            "noise": {strength.CHANNELS[group]: np.broadcast_to(
                levels[group], 3 if group == "xyz" else 6).tolist()
                for group in strength.CHANNELS if group in work.groups}}


def _recorded(work, effects):
    """({part: signals}, {part: the same without what is concealed})"""
    return ({part: work.run(effects, part) for part in PARTS},
            {part: work.run((), part) for part in PARTS[1:]})


def _fair(case, folder):
    """(Work, [(effect, over the noise)], recorded) of the first draw that comes to a fair size; its model is
    in folder/model. Raises campaign.Unsuitable."""
    for attempt in range(campaign.ATTEMPTS):
        try:
            work = Work(case, folder, attempt)
            concealed = [work.conceal(entry) for entry in work.entries]
            return work, concealed, _recorded(work, tuple(effect for effect, _ in concealed))
        except (campaign.Unsuitable, FloatingPointError) as error:
            for left in (folder / "model").iterdir():
                left.unlink()
            last = error
    raise campaign.Unsuitable(f"nothing fair came of {campaign.ATTEMPTS} draws: {last}")


def rebuild(case, folder):
    """(Work, effects) of a case that was written before."""
    work, concealed, _ = _fair(case, folder)
    return work, [effect for effect, _ in concealed]


def write(case, folder, floors):
    """Writes model/ and the recordings of a case, and into the folder floors what the machine would
    have shown without what is concealed. Returns the truth. Raises campaign.Unsuitable."""
    work, concealed, (signals, clean) = _fair(case, folder)
    floors.mkdir(parents=True, exist_ok=True)
    for part in PARTS:
        work.write(folder / f"{part}.csv", signals[part], part)
        if part in clean:
            work.write(floors / f"{part}.csv", clean[part], part)
    return _truth(work, concealed)
