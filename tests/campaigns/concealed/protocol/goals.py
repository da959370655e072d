"""Figures of a campaign, and the goals that these are held to."""

import statistics

from scoring.figures import Goal, Rate, value_of

from .judging import DIAGNOSED, NOMINAL
from .loops import Loop

REFIT = "refit"
MODELS = (NOMINAL, DIAGNOSED, REFIT)
EFFECT, JOINT = "right effect named first", "right joint"
ALARMS, CLAIMS = "false alarms on clean recordings", "confident wrong findings in foreign physics"
HELD_OUT = "held-out error / noise, median"
RIVAL = "untrained region: error / best rival's, median"
WORSE = "untrained region: cases worse than the plain refit"
LOOP = "closed loop: circularity / that with the nominal model, median"

GOALS = (
    Goal(EFFECT, 0.90, True, 80),
    Goal(JOINT, 0.95, True, 60),
    Goal(ALARMS, 0.02, False, 10),
    Goal(CLAIMS, 0.05, False, 10),
    Goal(HELD_OUT, 1.2, False, 80),
    Goal(RIVAL, 0.5, False, 80),
    Goal(WORSE, 0, False, 100),
    Goal(LOOP, 0.25, False, 10),
)


def of_families(scored, *families):
    return [each for each in scored if each.result.family in families]


def _rate(values):
    values = [bool(value) for value in values]
    return Rate(sum(values), len(values))


def median(values):
    values = [value for value in values if value is not None]
    return statistics.median(values) if values else None


def rivals(scored):
    """Methods that are neither flexcomp nor its models: black boxes, and toolboxes where they were asked."""
    return sorted({method for each in scored for method in each.errors} - set(MODELS))


def best_rival(each, region):
    """(method, error in units of the noise) of the best one, or None."""
    errors = [(each.error(method, region), method) for method in rivals([each])]
    errors = [pair for pair in errors if pair[0] is not None]
    return min(errors)[::-1] if errors else None


def against_rival(each, region):
    """flexcomp's error over the best rival's; None where there is none."""
    best, own = best_rival(each, region), each.error(DIAGNOSED, region)
    return own / best[1] if best and own is not None else None


def worse_than_refit(scored, region="untrained"):
    """Cases in which the plain refit predicts better, worst first: [(Scored, ratio of errors)]."""
    found = []
    for each in scored:
        own, other = each.error(DIAGNOSED, region), each.error(REFIT, region)
        if own is not None and other is not None and own > other:
            found.append((each, own / other))
    return sorted(found, key=lambda pair: -pair[1])


def closed_loops(scored):
    """Those in which what is concealed spoils the circle."""
    return [each for each in scored if isinstance(each.loop, Loop) and each.loop.is_spoiled]


def told(scored):
    """Fitted parameters whose interval is stated."""
    return [error for each in scored for error in each.parameters if error.std is not None]


def coverage(parameters):
    return _rate(each.covered for each in parameters)


def figures(scored):
    """{name: Rate, number or None}; None where no case can tell."""
    effects = of_families(scored, "single", "pair")
    located = [each for each in effects if each.joint_right is not None]
    clean, foreign = of_families(scored, "clean"), of_families(scored, "foreign")
    refitted = any(REFIT in each.errors for each in scored)
    return {
        EFFECT: _rate(each.effect_right for each in effects),
        JOINT: _rate(each.joint_right for each in located),
        "right joint where the effect is right": _rate(
            each.joint_right for each in located if each.effect_right),
        "right effect at the right joint": _rate(
            each.effect_right and each.joint_right is not False for each in effects),
        "pairs: both named and nothing else": _rate(
            each.result.found == each.result.concealed == each.result.findings
            for each in of_families(scored, "pair")),
        ALARMS: _rate(each.result.alarm for each in clean),
        CLAIMS: _rate(each.result.claims for each in foreign),
        "foreign physics called no mismatch": _rate(
            each.result.verdict == "no_mismatch" for each in foreign),
        HELD_OUT: median(each.error(DIAGNOSED, "holdout") for each in effects),
        "the same before the diagnosis": median(each.error(NOMINAL, "holdout") for each in effects),
        "parameters within their 95 % interval": coverage(told(scored)),
        "parameters without an interval": _rate(
            error.std is None for each in scored for error in each.parameters),
        RIVAL: median(against_rival(each, "untrained") for each in effects),
        WORSE: len(worse_than_refit(scored)) if refitted else None,
        "of these, by more than chance": sum(
            each.beyond_chance(DIAGNOSED, REFIT, "untrained")
            for each, _ in worse_than_refit(scored)) if refitted else None,
        LOOP: median(each.loop.ratio for each in closed_loops(scored)),
        "closed loops in which what is concealed spoils the circle": len(closed_loops(scored)),
        "diagnoses without an answer": _rate(
            each.result.verdict.startswith("failed") for each in scored),
        "cases that could not be simulated": _rate(NOMINAL not in each.errors for each in scored),
        "seconds a diagnosis, median": median(each.result.seconds for each in scored),
    }


def judged(found):
    """[(Goal, its figure, whether it holds or None where no case can tell)]."""
    rows = []
    for goal in GOALS:
        value = value_of(found[goal.figure])
        rows.append((goal, found[goal.figure], None if value is None else goal.met(value)))
    return rows
