"""Stands in for flexcomp where the scorer itself is tested: looks into truth.json beside the model and
answers as FAKE_ANSWER says: perfect, empty, broken (no JSON) or absent (exit code 3)."""

import json
import os
import pathlib
import sys

CHANNELS = {"xyz": "tcp_position", "tau": "joint_torque", "q_link": "joint_deflection"}


def finding(effect):
    parameters = {
        name: {"value": value, "std": 0.01 * abs(value), "unit": effect["units"].get(name, "1")}
        for name, value in effect["parameters"].items() if isinstance(value, float)}
    return {"effect": effect["effect"], "joint": effect["joint"], "parameters": parameters,
            "evidence": {"delta_bic": 100.0, "p_value": 1e-9, "holdout_rms_before": 1e-4,
                         "holdout_rms_after": 1e-5},
            "alternatives": [], "statement": "It is so."}


def answer(truth, manner):
    findings = [finding(effect) for effect in truth["effects"]] if manner == "perfect" else []
    verdict = "explained" if findings else "no_mismatch"
    if manner == "perfect" and truth["foreign"]:
        verdict = "unexplained"
    channels = [channel for group, channel in CHANNELS.items() if group in truth["columns"]]
    noise = truth["noise_rms"]
    rms = {channel: {"train_rms": noise[channel], "holdout_rms": noise[channel]}
           for channel in channels}
    return {"schema": "flexcomp/diagnosis/1", "verdict": verdict, "channels": channels,
            "noise_floor_rms": truth["noise_rms"], "baseline": rms, "final": rms,
            "location": {"joints": [], "axes": [], "time": [], "frequency_hz": []},
            "findings": findings, "unexplained": None, "indistinguishable": [],
            "suggested_experiment": None}


def main():
    manner = os.environ["FAKE_ANSWER"]
    if manner == "absent":
        sys.exit(3)
    words = sys.argv[1:]
    folder = pathlib.Path(words[words.index("--model") + 1]).parent
    truth = json.loads((folder / "truth.json").read_text())
    out = pathlib.Path(words[words.index("--out") + 1])
    out.mkdir(parents=True)
    text = "not JSON" if manner == "broken" else json.dumps(answer(truth, manner))
    (out / "diagnosis.json").write_text(text)


if __name__ == "__main__":
    main()
