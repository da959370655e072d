"""An opened truth against the answers: what fell, which names were given, which laws."""

import json
import math

import numpy as np

from . import milled
from .trial import JUDGED

SHOWS = 1.0  # excess from which what is concealed counts as shown by a recording
GOAL = {"holdout": 0.8, "untrained": 0.6}  # share of the error beyond the noise that shall fall
SHARE = 0.7  # of the cases with a law
MOST_WRONG = 0.03  # of all cases
RISE = 1.05  # times the error, from which a model counts as worse


# Effects that say the same of the same joint, None: of the last one, or of the machine.
SAME = {("payload", "link_mass"): (None, 6), ("tcp_offset", "link_offset"): (None, 6),
        ("joint_offset", "base_frame"): (1, None)}
SAME_AT_JOINT = {("link_length", "link_offset"), ("coulomb_friction", "friction_hysteresis")}


def fall(errors, method, part):
    """By which share a method brings down the error beyond what the machine shows without what is
    concealed; None where nothing shows or the method gave none. Negative where it rose."""
    if method not in errors:
        return None
    floor, before = errors["floor"][part], errors["nominal"][part]
    if before - floor < SHOWS:
        return None
    return 1 - math.sqrt(max(errors[method][part] - floor, 0.0) / (before - floor))


def _place_of(finding):
    """(place, joint or axis) of a law, as the truth says it."""
    place, joint = finding.get("place") or "", finding.get("joint")
    return place, joint or finding.get("axis") or None


def name_of(finding):
    """For a person."""
    if finding["effect"] == "law":
        place, where = _place_of(finding)
        return f"law at {place} {where or ''}".strip() + f": {finding.get('formula', '')}"
    return f"{finding['effect']} {finding.get('joint') or ''}".strip()


def _is_known(finding, truth):
    known = truth["known"]
    if not known:
        return False
    pair, joints = (known["effect"], finding["effect"]), (known["joint"], finding.get("joint"))
    if pair[0] == pair[1] or pair in SAME_AT_JOINT:
        return joints[0] == joints[1]
    return SAME.get(pair) == joints


def _is_kin(finding, truth):
    foreign = truth["foreign"]
    names = {finding["effect"], f"{finding['effect']}/{finding.get('form')}"}
    return (bool(foreign) and not names.isdisjoint(foreign["kin"])
            and finding.get("joint") == foreign["joint"]
            and bool(finding.get("when")) == foreign.get("begins", False))


def _is_right_law(finding, truth):
    foreign = truth["foreign"]
    return (bool(foreign) and finding["effect"] == "law"
            and _place_of(finding) in [tuple(place) for place in foreign["places"]])


def _is_worse(errors, method, part):
    """Whether a method's model leaves clearly more than the nominal one."""
    return method in errors and errors[method][part] - errors["nominal"][part] > max(
        SHOWS, (RISE**2 - 1) * max(errors["nominal"][part], 0.0))


def judged(name, truth, answers):
    """One case's row."""
    run = json.loads((answers / "run.json").read_text())
    measured = json.loads((answers / "errors.json").read_text())
    path = answers / "diagnosis.json"
    answer = json.loads(path.read_text()) if path.is_file() else {}
    findings = answer.get("findings", [])
    foreign = truth["foreign"] or {}
    loop = answers / "loop.json"
    laws = [finding for finding in findings if finding["effect"] == "law"]
    wrong = [finding for finding in findings if finding["effect"] != "law"
             and not _is_known(finding, truth) and not _is_kin(finding, truth)]
    errors = measured["errors"]
    return {
        "case": name, "family": truth["family"], "kind": truth["kind"], "robot": truth["robot"],
        "foreign": foreign.get("effect"), "joint": foreign.get("joint"),
        "exists": foreign.get("exists"), "undone": foreign.get("undone"),
        "known": truth["known"] and name_of(truth["known"]),
        "over_noise": foreign.get("over_noise"),
        "code": run["code"], "seconds": run["seconds"], "cpu": run["cpu"],
        "last_words": run["last_words"] if run["code"] != 0 else "",
        "verdict": answer.get("verdict"), "named": [name_of(finding) for finding in findings],
        "statements": [finding.get("statement", "") for finding in findings],
        "wrong": [name_of(finding) for finding in wrong], "laws": len(laws),
        "right_law": any(_is_right_law(finding, truth) for finding in findings),
        "kin": any(_is_kin(finding, truth) for finding in findings),
        "known_found": any(_is_known(finding, truth) for finding in findings),
        "loop": json.loads(loop.read_text()) if loop.is_file() else {},
        "excess": errors, "failures": measured["failures"],
        "worse": {method: [part for part in JUDGED if _is_worse(errors, method, part)]
                  for method in ("flexcomp", "refit")},
        "fall": {method: {part: fall(errors, method, part) for part in JUDGED}
                 for method in ("flexcomp", "refit", "true law") if method in errors}}


def _share(values):
    values = list(values)
    return {"of": len(values), "count": int(sum(values)),
            "share": sum(values) / len(values) if values else None}


def _falls(rows, method, part):
    """Of the rows in which something shows; a method without a model changes nothing. Nothing of a
    refit that nobody asked for."""
    if method == "refit" and not any(method in row["excess"] for row in rows):
        return []
    found = []
    for row in rows:
        if row["excess"]["nominal"][part] - row["excess"]["floor"][part] >= SHOWS:
            found.append(row["fall"].get(method, {}).get(part) or 0.0)
    return found


def _fell(rows, part):
    found = {}
    for method in ("flexcomp", "refit"):
        falls = _falls(rows, method, part)
        found[method] = {"reached": _share(each >= GOAL[part] for each in falls),
                         "median": float(np.median(falls)) if falls else None}
    flexcomp, refit = (_falls(rows, method, part) for method in ("flexcomp", "refit"))
    found["better_than_refit"] = _share(ours >= theirs - 0.02
                                        for ours, theirs in zip(flexcomp, refit))
    return found


def figures(rows):
    """The summary of all rows."""
    law = [row for row in rows if row["exists"]]
    alone = [row for row in law if row["family"] == "alone"]
    beside = [row for row in law if row["family"] == "beside"]
    clean = [row for row in rows if row["family"] == "clean"]
    unseen = [row for row in rows if row["exists"] is False]
    seconds = [row["seconds"] for row in rows]
    circles = [row["loop"] for row in rows if milled.is_judged(row["loop"])]
    return {
        "cases": len(rows), "answered": sum(row["code"] == 0 for row in rows),
        "fall": {part: _fell(law, part) for part in JUDGED},
        "fall_alone": {part: _fell(alone, part) for part in JUDGED},
        "right_law": _share(row["right_law"] or row["kin"] for row in law),
        "both_found": _share((row["right_law"] or row["kin"]) and row["known_found"]
                             for row in beside),
        "known_found": _share(row["known_found"] for row in beside),
        "wrong_known_name": _share(bool(row["wrong"]) for row in rows),
        "no_law_and_wrong_name": _share(bool(row["wrong"]) for row in unseen),
        "no_law_and_told": _share(row["right_law"] or row["kin"] for row in unseen),
        "made_worse": {method: _share(bool(row["worse"][method]) for row in rows)
                       for method in ("flexcomp", "refit")},
        "circles": _share(milled.left(circle) <= milled.GOAL for circle in circles),
        "laws_on_clean": _share(row["laws"] > 0 for row in clean),
        "findings_on_clean": _share(bool(row["named"]) for row in clean),
        "seconds": {"median": float(np.median(seconds)), "max": max(seconds)},
        "cpu": {"median": float(np.median([row["cpu"] for row in rows])),
                "max": max(row["cpu"] for row in rows)}}
