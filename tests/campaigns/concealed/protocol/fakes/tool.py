"""Stands in for flexcomp where the protocol itself is tested. The test writes a program that sets
`manner` and `oracle` ({SHA-256 of train.csv: [[effect, joint, size]]}) and calls main."""

import csv
import hashlib
import json
import os
import pathlib
import sys
import time

from campaign import case

CHANNEL = "joint_torque"


def option(name):
    return pathlib.Path(sys.argv[sys.argv.index(name) + 1])


def finding(effect, joint, size):
    return {"effect": effect, "joint": joint, "alternatives": [], "statement": "It is so.",
            "parameters": {case.PARAMETERS[effect]: {"value": size, "std": 0.01 * size,
                                                     "unit": "1"}},
            "evidence": {"delta_bic": 100.0, "p_value": 1e-9, "holdout_rms_before": 9.0,
                         "holdout_rms_after": 1.0}}


def answer(findings, verdict):
    rms = {CHANNEL: {"train_rms": 1.0, "holdout_rms": 1.0}}
    return {"schema": "flexcomp/diagnosis/1", "verdict": verdict, "channels": [CHANNEL],
            "noise_floor_rms": {CHANNEL: 1.0}, "baseline": rms, "final": rms,
            "location": {"joints": [], "axes": [], "time": [], "frequency_hz": []},
            "findings": [finding(*each) for each in findings], "unexplained": None,
            "indistinguishable": [], "suggested_experiment": None}


def search():
    """Paths of files that are called like a truth or read like one, outside of the system's folders
    and Python's."""
    system = {"/proc", "/dev", "/sys", "/usr", "/etc", "/bin", "/lib", "/lib64", sys.prefix,
              sys.base_prefix}
    found = []
    for place, folders, files in os.walk("/"):
        folders[:] = [name for name in folders if os.path.join(place, name) not in system]
        for name in files:
            path = pathlib.Path(place, name)
            try:
                if "truth" in name or b'"family"' in path.read_bytes():
                    found.append(str(path))
            except OSError:
                continue
    return [path for path in found if path != sys.argv[0]]


def diagnose(manner, oracle):
    if manner == "crash":
        sys.exit(3)
    if manner == "slow":
        time.sleep(60)
    if manner == "open":
        for sealed in pathlib.Path(sys.argv[0]).parent.glob("*/truth.sealed"):
            sealed.read_bytes()
    train = option("--recording").read_bytes()
    truth = oracle[hashlib.sha256(train).hexdigest()]
    findings = truth
    if manner == "wrong":
        joint = 7 - truth[0][1] if truth else 1
        findings = [["torque_offset", joint, 5.0]]
    verdict = "explained" if findings else "no_mismatch"
    out = option("--out")
    out.mkdir()
    if manner == "search":
        (out / "found.json").write_text(json.dumps(search()))
    (out / "diagnosis.json").write_text(json.dumps(answer(findings, verdict)))
    model = json.loads(option("--model").read_text())
    model["effects"] = findings
    (out / "updated_model.yaml").write_text(json.dumps(model))


def simulate():
    effects = json.loads(option("--model").read_text())["effects"]
    with option("--recording").open(newline="") as file:
        rows = list(csv.DictReader(file))
    time_of = [float(row["t"]) for row in rows]
    angles = [[float(row[f"q_meas_{k}"]) for k in case.JOINTS] for row in rows]
    with option("--out").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["t", *(f"tau_{k}" for k in case.JOINTS)])
        for row in range(len(rows)):
            low, high = max(row - 1, 0), min(row + 1, len(rows) - 1)
            velocities = [(b - a) / (time_of[high] - time_of[low])
                          for a, b in zip(angles[low], angles[high])]
            writer.writerow([time_of[row], *case.torque(effects, angles[row], velocities)])


def main(manner, oracle):
    simulate() if sys.argv[1] == "simulate" else diagnose(manner, oracle)
