"""diagnosis.json, held to its contract."""

import dataclasses
import json
import re

VERDICTS = ("no_mismatch", "explained", "partly_explained", "unexplained")
KEYS = ("schema", "verdict", "channels", "noise_floor_rms", "baseline", "final", "location", "findings",
        "unexplained", "indistinguishable", "suggested_experiment")
FINDING_KEYS = ("effect", "joint", "parameters", "evidence", "alternatives", "statement")
EVIDENCE_KEYS = ("delta_bic", "p_value", "holdout_rms_before", "holdout_rms_after")


class Malformed(Exception):
    """The answer is not what the contract promises; says where."""


@dataclasses.dataclass
class Answer:
    verdict: str
    named: list  # (effect, joint), the strongest first
    parameters: list  # of the findings: {name: {"value":, "std":, "unit":}}
    groups: list  # of sets of (effect, joint); joint "any" where the tool gives none
    holdout_rms: dict  # channel -> rms after the fit


def _require(condition, what):
    if not condition:
        raise Malformed(what)


def _keys(thing, keys, where):
    _require(isinstance(thing, dict), f"{where} is no object")
    for key in keys:
        _require(key in thing, f"{where} lacks '{key}'")


def _place(thing, where):
    joint = thing["joint"]
    _require(joint is None or joint in (1, 2, 3, 4, 5, 6), f"{where}.joint is {joint!r}")
    return thing["effect"], joint


def _member(thing):
    """The contract leaves open how a member of a group is written: object, or name with a joint."""
    if isinstance(thing, dict):
        return thing.get("effect"), thing.get("joint", "any")
    name, number = re.match(r"([a-z_]+)\D*(\d)?", str(thing)).groups()
    return name, int(number) if number else "any"


def _group(thing):
    if isinstance(thing, dict):
        thing = thing.get("effects", [])
    return {_member(member) for member in thing}


def parse(text):
    """diagnosis.json's text -> Answer. Raises Malformed."""
    try:
        answer = json.loads(text)
    except ValueError as error:
        raise Malformed(f"no JSON: {error}") from error
    _keys(answer, KEYS, "diagnosis")
    _require(answer["schema"] == "flexcomp/diagnosis/1", f"schema is {answer['schema']!r}")
    _require(answer["verdict"] in VERDICTS, f"verdict is {answer['verdict']!r}")
    _keys(answer["location"], ("joints", "axes", "time", "frequency_hz"), "location")
    for channel in answer["channels"]:
        for stage in ("baseline", "final"):
            _keys(answer[stage], (channel,), stage)
            _keys(answer[stage][channel], ("train_rms", "holdout_rms"), f"{stage}.{channel}")
    for number, finding in enumerate(answer["findings"]):
        where = f"findings[{number}]"
        _keys(finding, FINDING_KEYS, where)
        _keys(finding["evidence"], EVIDENCE_KEYS, f"{where}.evidence")
        for name, entry in finding["parameters"].items():
            _keys(entry, ("value", "std", "unit"), f"{where}.parameters.{name}")
        for other in finding["alternatives"]:
            _keys(other, ("effect", "joint", "delta_bic"), f"{where}.alternatives")
    if answer["verdict"] in ("no_mismatch", "unexplained"):
        _require(not answer["findings"], f"verdict {answer['verdict']} with findings")
    return Answer(
        verdict=answer["verdict"],
        named=[_place(finding, f"findings[{k}]") for k, finding in enumerate(answer["findings"])],
        parameters=[finding["parameters"] for finding in answer["findings"]],
        groups=[_group(group) for group in answer["indistinguishable"]],
        holdout_rms={channel: answer["final"][channel]["holdout_rms"]
                     for channel in answer["channels"]})
