"""One answer against its truth.

How a concealed effect counts as named:
  exact       the finding has its effect and joint
  equivalent  the finding is one that the recording cannot tell from it: its trace correlates with
              the concealed one's by more than 0.999, as the generator computed
  group       the tool itself says that the finding and the truth cannot be told apart: right place,
              counted apart from the figures
"""

import dataclasses

from . import parameters

RIGHT = ("exact", "equivalent")


@dataclasses.dataclass
class Result:
    """A row of cases.csv."""

    family: str
    seed: int
    kind: str
    truth: str
    verdict: str = ""  # the tool's, or what went wrong
    named: str = ""
    first: str = ""  # how the strongest finding stands to the truth: exact, ..., wrong, nothing
    found: int = 0  # concealed effects that some finding names
    concealed: int = 0
    findings: int = 0
    right_findings: int = 0
    alarm: bool = False  # anything but no_mismatch
    claims: bool = False  # any finding by a name of the catalogue but that of the physics itself
    holdout_ratio: dict = dataclasses.field(default_factory=dict)  # channel -> rms / noise
    covered: int = 0  # parameters whose 95 % interval holds the truth
    compared: int = 0
    seconds: float = 0.0


def _same(place, other):
    return place[0] == other[0] and (place[1] == other[1] or "any" in (place[1], other[1]))


def match(named, effect, groups=()):
    """How a finding (effect, joint) stands to one effect of the truth file: exact, equivalent, group
    or None."""
    truth = (effect["effect"], effect["joint"])
    if _same(named, truth):
        return "exact"
    if any(_same(named, (other["effect"], other["joint"])) for other in effect["equivalents"]):
        return "equivalent"
    for group in groups:
        if any(_same(truth, member) for member in group) and any(
                _same(named, member) for member in group):
            return "group"
    return None


def _first(answer, effects):
    if not answer.named:
        return "nothing"
    ways = [match(answer.named[0], effect, answer.groups) for effect in effects]
    return next((way for way in ("exact", "equivalent", "group") if way in ways), "wrong")


def label(place):
    return f"{place[0]}@{place[1]}" if place[1] is not None else place[0]


def _with_form(effect):
    return f"{effect['effect']} ({effect['form']})" if effect.get("form") else effect["effect"]


def blank(truth):
    """The result of a case before it has an answer."""
    effects = truth["effects"]
    name = "+".join(label((_with_form(effect), effect["joint"])) for effect in effects)
    foreign = truth["foreign"]
    return Result(truth["family"], truth["seed"], truth["kind"],
                  foreign["name"] if foreign else name or "clean", concealed=len(effects))


def failed(truth, why, seconds):
    """No answer counts as the worst answer of its family."""
    result = blank(truth)
    result.verdict, result.first, result.seconds = why, "nothing", seconds
    result.alarm = result.claims = True
    return result


def judge(truth, answer, seconds):
    """Truth file and Answer -> Result."""
    result = blank(truth)
    effects = truth["effects"]
    result.verdict, result.seconds = answer.verdict, seconds
    result.named = "+".join(label(place) for place in answer.named)
    result.alarm = answer.verdict != "no_mismatch"
    own = truth["foreign"] and (truth["foreign"]["name"], truth["foreign"].get("joint"))
    result.claims = any(place[0] != "law" and not (own and _same(place, own))
                        for place in answer.named)
    result.findings = len(answer.named)
    result.first = _first(answer, effects) if effects else ("wrong" if answer.named else "nothing")
    result.found = sum(any(match(place, effect) in RIGHT for place in answer.named)
                       for effect in effects)
    result.right_findings = min(result.found, sum(
        any(match(place, effect) in RIGHT for effect in effects) for place in answer.named))
    result.holdout_ratio = {channel: rms / truth["noise_rms"][channel]
                            for channel, rms in answer.holdout_rms.items()
                            if channel in truth["noise_rms"]}
    for place, fitted in zip(answer.named, answer.parameters):
        for effect in effects:
            if match(place, effect) == "exact":
                covered, compared = parameters.coverage(effect, fitted)
                result.covered += covered
                result.compared += compared
    return result
