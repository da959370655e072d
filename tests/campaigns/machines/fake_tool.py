"""Stands in for flexcomp where what is around it is tested. FAKE_ANSWER says how it answers:

silent   a valid answer without findings, and a model that predicts no torque and no place
perfect  the findings of FAKE_FINDINGS (JSON), and an updated model that predicts what was measured
broken   no JSON; absent: exit code 3
"""

import csv
import json
import os
import pathlib
import sys

SIMULATED = ("tau", "q_link", "x", "y", "z")


def option(words, name):
    return pathlib.Path(words[words.index(name) + 1])


def finding(effect, joint, parameters):
    return {"effect": effect, "joint": joint, "statement": "It is so.",
            "parameters": {name: {"value": value, "std": 0.01, "unit": "1"}
                           for name, value in parameters.items()}}


def diagnose(words, manner):
    out, model = option(words, "--out"), option(words, "--model")
    out.mkdir(parents=True)
    findings = json.loads(os.environ.get("FAKE_FINDINGS", "[]")) if manner == "perfect" else []
    answer = {"verdict": "explained" if findings else "unexplained",
              "findings": [finding(*each) for each in findings],
              "unexplained": None if findings else {"reason": "it is unknown", "nearest": []}}
    (out / "diagnosis.json").write_text("no JSON" if manner == "broken" else json.dumps(answer))
    (out / "updated_model.yaml").write_text(
        model.read_text() + ("learnt: true\n" if findings else ""))


def simulate(words):
    is_right = "learnt: true" in option(words, "--model").read_text()
    with option(words, "--recording").open(newline="") as file:
        rows = list(csv.DictReader(file))
    names = ["t"] + [name for name in rows[0] if name.startswith(SIMULATED)]
    with option(words, "--out").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        for row in rows:
            writer.writerow([row[name] if is_right or name == "t" or not row[name] else "0"
                             for name in names])


def main():
    manner, words = os.environ["FAKE_ANSWER"], sys.argv[1:]
    if manner == "absent":
        print("flexcomp: an internal fault", file=sys.stderr)
        sys.exit(3)
    if words[0] == "diagnose":
        diagnose(words, manner)
    else:
        simulate(words)


if __name__ == "__main__":
    main()
