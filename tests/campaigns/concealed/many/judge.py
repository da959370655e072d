"""What flexcomp made of a case, beside the oracle and the best plain refit."""

import json
import math

import numpy as np

from . import cases, intervals, plausible

NEAR = 1.1  # times another's error
BY_CHANCE = 2.0  # standard errors of the difference over the blocks of a recording


def beyond_chance(one, other):
    """Whether an error is larger than another by more than the blocks' scatter leaves open."""
    differences = np.subtract(np.square(one["blocks"]), np.square(other["blocks"])) \
        if len(one["blocks"]) == len(other["blocks"]) else np.array([one["rms"]**2 - other["rms"]**2])
    if len(differences) < 2:
        return bool(differences[0] > 0)
    spread = differences.std(ddof=1) / math.sqrt(len(differences))
    return bool(differences.mean() > BY_CHANCE * spread)


def _ratio(one, other):
    return one["rms"] / other["rms"] if one and other and other["rms"] else None


def judged(name, truth, case, answers):
    """One case's row: ratios, findings that cannot be, wrong names, intervals."""
    others = json.loads((case / "refit.json").read_text())
    run = json.loads((answers / "run.json").read_text())
    row = {"case": name, "class": truth["class"], "robot": truth["robot"], "code": run["code"],
           "seconds": run["seconds"], "cpu": run["cpu"], "failures": run["failures"]}
    ours = run["errors"]["flexcomp"] or run["errors"]["nominal"]
    row["errors"] = {part: {"nominal": run["errors"]["nominal"].get(part, {}).get("rms"),
                            "nominal_own": others["nominal"][part]["rms"],
                            "flexcomp": ours.get(part, {}).get("rms"),
                            "plain": others["plain"][part]["rms"],
                            "oracle": others["oracle"][part]["rms"]} for part in cases.PARTS}
    for part in ("holdout", "untrained"):
        mine = ours.get(part)
        low = [entry.get("low_passed") for entry in (mine or {}, others["oracle"][part])]
        row[part] = {"low_passed_over_oracle": low[0] / low[1] if all(low) else None,
                     "over_oracle": _ratio(mine, others["oracle"][part]),
                     "over_plain": _ratio(mine, others["plain"][part]),
                     "plain_over_oracle": _ratio(others["plain"][part], others["oracle"][part]),
                     "worse_than_plain_beyond_chance":
                         beyond_chance(mine, others["plain"][part]) if mine else True}
    row |= _said(truth, answers, ours)
    return row


def _said(truth, answers, ours):
    path = answers / "diagnosis.json"
    if not path.is_file():
        return {"verdict": None, "findings": 0, "impossible": [], "wrong": [], "intervals": [],
                "stated_over_measured": None}
    answer = json.loads(path.read_text())
    findings = answer["findings"]
    stated = answer["final"].get(cases.CHANNEL[truth["class"]], {}).get("holdout_rms")
    measured = ours.get("holdout", {})
    # The tool may count other rows than those in motion.
    near = [stated / measured[key] for key in ("rms", "all_rows") if stated and measured.get(key)]
    model = answers / "updated_model.yaml"
    return {"verdict": answer["verdict"], "findings": len(findings),
            "named": [f"{each['effect']} {each.get('joint') or ''}".strip() for each in findings],
            "impossible": plausible.impossible(findings, model.read_text() if model.is_file() else "{}",
                                               truth),
            "wrong": plausible.wrong_names(findings, truth),
            "intervals": intervals.compared(findings, truth),
            "stated_over_measured": min(near, key=lambda ratio: abs(ratio - 1)) if near else None}


def _share(values):
    values = list(values)
    return {"of": len(values), "count": int(sum(values)),
            "share": sum(values) / len(values) if values else None}


def _quantiles(values):
    values = [value for value in values if value is not None]
    if not values:
        return None
    return dict(zip(("min", "median", "p90", "max"),
                    map(float, np.quantile(values, [0, 0.5, 0.9, 1]))))


def _worst(entry, *keys):
    """The largest of some ratios; infinite where one is missing."""
    return max(math.inf if entry[key] is None else entry[key] for key in keys)


def figures(rows):
    """The summary of one class' rows."""
    done = [row for row in rows if row["code"] == 0]
    inside = [each["inside"] for row in rows for each in row["intervals"]]
    found = {"cases": len(rows), "answered": len(done), "seconds": _quantiles(
        row["seconds"] for row in rows), "cpu": _quantiles(row["cpu"] for row in rows)}
    for part in ("holdout", "untrained"):
        def near(*keys, part=part):
            return _share(_worst(row[part], *keys) <= NEAR for row in rows)
        found[part] = {
            "within_oracle": near("over_oracle"), "within_plain": near("over_plain"),
            "within_both": near("over_oracle", "over_plain"),
            "not_worse_than_plain_beyond_chance": _share(
                not row[part]["worse_than_plain_beyond_chance"] for row in rows),
            "over_oracle": _quantiles(row[part]["over_oracle"] for row in rows),
            "low_passed_over_oracle": _quantiles(row[part]["low_passed_over_oracle"] for row in rows),
            "over_plain": _quantiles(row[part]["over_plain"] for row in rows),
            "plain_over_oracle": _quantiles(row[part]["plain_over_oracle"] for row in rows)}
    found |= {"intervals": _share(inside),
              "cases_with_impossible": _share(bool(row["impossible"]) for row in rows),
              "findings": sum(row["findings"] for row in rows),
              "wrong_names": sum(len(row["wrong"]) for row in rows),
              "stated_over_measured": _quantiles(row["stated_over_measured"] for row in rows),
              "verdicts": {verdict: sum(row["verdict"] == verdict for row in rows)
                           for verdict in sorted({str(row["verdict"]) for row in rows})}}
    return found
