"""A case on disk: what the tool is given, and what others make of the same recordings."""

import json

import numpy as np
from plant import description as descriptions
from rivals import recording

from . import arm, frame_refit, frames, friction, friction_refit

CLASSES = {"frames": frames, "friction": friction}
CHANNEL = {"frames": "tcp_position", "friction": "joint_torque"}
GROUP = {"frames": "xyz", "friction": "tau"}
PARTS = "train", "holdout", "untrained"
BLOCKS = 20


def chosen(kind, read):
    """(n, columns) bool: the samples that everybody is judged on; of torques, those in motion."""
    values = read.groups[GROUP[kind]]
    return np.isfinite(values) if kind == "frames" else friction_refit.moving(read)


def error(kind, read, predicted):
    """{"rms", "all_rows", "low_passed", "blocks"} of what a prediction (n, columns) leaves. blocks: rms of
    each twentieth of the recording, for what is chance; low_passed: of torques, what is left below
    the frequency at which rows are judged."""
    left = read.groups[GROUP[kind]] - predicted
    counted = chosen(kind, read) & np.isfinite(left)

    def rms(values):
        return float(np.sqrt(np.mean(values**2))) if values.size else None

    blocks = [rms(a[b]) for a, b in zip(np.array_split(left, BLOCKS), np.array_split(counted, BLOCKS))]
    low = None
    if kind == "friction" and np.isfinite(left).all():
        rate = 1 / np.median(np.diff(read.time))
        low = rms(friction_refit.smooth(left, rate, friction_refit.JUDGED_AT)[counted])
    return {"rms": rms(left[counted]), "all_rows": rms(left[np.isfinite(left)]), "low_passed": low,
            "blocks": [each for each in blocks if each is not None]}


def _frame_predictions(read, description, truth):
    training = read["train"]
    clock = not training.is_static
    machines = {"plain": frame_refit.Machine(description, clock=clock), "oracle": None}
    base = None
    if truth["has_base_compliance"]:
        base = frame_refit.base_tolerance(truth["base_compliance"])
    machines["oracle"] = frame_refit.Machine(description, clock=clock, base=base)
    numbers = {"plain": frame_refit.fit(machines["plain"], training)}
    numbers["oracle"] = (numbers["plain"] if base is None
                         else frame_refit.fit(machines["oracle"], training))
    nominal = machines["plain"]
    yield "nominal", "", lambda each: nominal.places(np.zeros(len(nominal.tolerance)),
                                                     frame_refit.Rows.of(each))
    for name, machine in machines.items():
        yield name, "all link frames", lambda each, m=machine, n=name: m.places(
            numbers[n], frame_refit.Rows.of(each))


def _friction_predictions(read, description, truth):
    def nominal(each):
        motion = friction_refit.Motion.of(each, friction_refit.JUDGED_AT)
        bodies = arm.lumped(description.chain)
        return arm.regressor(description.chain, description.gravity, motion.q, motion.velocity,
                             motion.acceleration) @ bodies.ravel()

    yield "nominal", "", nominal
    for name, fitted in (("plain", friction_refit.plain(read["train"], description)),
                         ("oracle", friction_refit.oracle(read["train"], description, truth))):
        kind, model, cutoff = fitted
        yield name, f"{kind}, {cutoff:g} Hz", lambda each, m=model, c=cutoff: m.predict(
            friction_refit.Motion.of(each, c))


def others(kind, folder, truth):
    """{method: {"what", part: error}} of the nominal model, the best plain refit and the oracle."""
    description = descriptions.load(folder / "robot.yaml")
    read = {part: recording.read(folder / f"{part}.csv") for part in PARTS}
    predictions = _frame_predictions if kind == "frames" else _friction_predictions
    return {name: {"what": what} | {part: error(kind, each, predict(each))
                                    for part, each in read.items()}
            for name, what, predict in predictions(read, description, truth)}


def write_others(kind, folder, truth):
    """Writes refit.json beside a case's recordings."""
    text = {"channel": CHANNEL[kind], "unit": "m" if kind == "frames" else "N·m",
            "rows": "all" if kind == "frames" else
            f"in motion: faster than {friction_refit.CREEPING:g} of the joint's largest speed, angles "
            f"low-passed at {friction_refit.JUDGED_AT:g} Hz (Butterworth, 2nd order, both ways)",
            **others(kind, folder, truth)}
    (folder / "refit.json").write_text(json.dumps(text, indent=1) + "\n")


def write(kind, seed, number, folder):
    """Writes a case and refit.json into a folder; returns its truth."""
    folder.mkdir(parents=True, exist_ok=True)
    truth = CLASSES[kind].write_case(seed, number, folder)
    write_others(kind, folder, truth)
    return truth
