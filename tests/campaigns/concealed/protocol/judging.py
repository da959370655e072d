"""An opened truth against the answers: one Scored a case."""

import dataclasses
import json
import math

from rivals.recording import CHANNELS
from scoring import answer, judge
from scoring.parameters import NAMES, Z95

from . import trial

NOMINAL, DIAGNOSED = "nominal", "flexcomp"
BY_CHANCE = 2.0  # standard errors


@dataclasses.dataclass
class ParameterError:
    """A fitted parameter of a finding that is right."""

    case: str
    effect: str
    name: str
    truth: float
    value: float
    std: float | None  # None: without an interval

    @property
    def deviations(self):
        """Error in stated standard deviations."""
        return (self.value - self.truth) / self.std

    @property
    def covered(self):
        return abs(self.deviations) <= Z95


@dataclasses.dataclass
class Scored:
    case: str
    robot: str
    result: judge.Result
    effect_right: bool | None  # of the first finding; None: nothing is concealed
    joint_right: bool | None  # None: no concealed effect has a joint
    joints: tuple  # concealed ones
    named_joint: object  # of the first finding that can have one: 1 to 6, None, "": no finding
    parameters: list  # of ParameterError
    noise: dict  # channel -> rms
    errors: dict  # method -> region -> channel -> {"rms", "stretches"}
    failures: dict  # method -> why it has no errors
    loop: object = None  # loops.Loop, why it could not be closed, or None where it was not tried

    def error(self, method, region):
        """Error of a method in a region in units of the noise, channels weighing the same; None
        where the method failed."""
        by_channel = self.errors.get(method, {}).get(region, {})
        ratios = [entry["rms"] / self.noise[channel] for channel, entry in by_channel.items()
                  if entry["rms"] is not None and self.noise.get(channel)]
        return math.sqrt(sum(ratio**2 for ratio in ratios) / len(ratios)) if ratios else None

    def beyond_chance(self, method, other, region):
        """Whether the method's error is larger than the other's by more than the scatter between
        stretches of the recording leaves open."""
        for channel, entry in self.errors[method][region].items():
            differences = [a**2 - b**2 for a, b in zip(
                entry["stretches"], self.errors[other][region][channel]["stretches"])]
            n = len(differences)
            if n < 2:
                continue
            mean = sum(differences) / n
            spread = math.sqrt(sum((each - mean) ** 2 for each in differences) / (n - 1) / n)
            if mean > BY_CHANCE * spread:
                return True
        return False


def noise_rms(truth):
    """{channel: rms} of the noise that the truth gives as standard deviations, by channel or by
    group of columns, one number or one a component."""
    found = {}
    for name, deviation in truth["noise"].items():
        values = deviation if isinstance(deviation, list) else [deviation]
        channel = next((key for key, group in CHANNELS.items() if group == name), name)
        found[channel] = math.sqrt(sum(value**2 for value in values) / len(values))
    return found


def for_the_scorer(truth):
    """A campaign's truth as scoring.judge reads it."""
    effects = [{"equivalents": [], **effect} for effect in truth["effects"]]
    family = truth["family"]
    if family == "effect":
        family = "single" if len(effects) == 1 else "pair"
    foreign = ({"name": truth["foreign"]["effect"], "joint": truth["foreign"]["joint"]}
               if family == "foreign" else None)
    return {"family": family, "seed": truth["seed"], "kind": truth["kind"], "foreign": foreign,
            "effects": [] if foreign else effects, "noise_rms": noise_rms(truth)}


def _answer(folder):
    """(Answer or None, judge's words on a failure, seconds)."""
    run = json.loads((folder / "run.json").read_text())
    if run["code"] is None:
        return None, f"failed: no answer within {run['seconds']:.0f} s", run["seconds"]
    if run["code"] != 0:
        return None, f"failed: exit {run['code']}: {run['last_words']}", run["seconds"]
    try:
        return answer.parse((folder / trial.ANSWER).read_text()), "", run["seconds"]
    except (answer.Malformed, OSError, UnicodeDecodeError) as error:
        return None, f"failed: {error}", run["seconds"]


def _contest(folder):
    """(errors by method, failures by method)."""
    errors, failures = {}, {}
    for path in sorted((folder / "contest").glob("*.json")):
        entry = json.loads(path.read_text())
        if "errors" in entry:
            errors[entry["method"]] = entry["errors"]
        else:
            failures[entry["method"]] = entry["failed"]
    if NOMINAL in errors and DIAGNOSED not in errors:
        # Without an updated model, or one that can be simulated, the nominal one is all there is.
        errors[DIAGNOSED] = errors[NOMINAL]
    return errors, failures


def parameter_errors(name, effects, said):
    """Errors of findings that have a concealed effect's name and joint; parameters that both give as
    numbers, under the same name or one of scoring.parameters.NAMES."""
    found = []
    for place, fitted in zip(said.named, said.parameters):
        effect = next((each for each in effects if judge.match(place, each) == "exact"), None)
        for parameter, truth in (effect["parameters"] if effect else {}).items():
            names = (parameter, *NAMES.get(effect["effect"], {}).get(parameter, ()))
            entry = next((fitted[other] for other in names if other in fitted), None)
            if entry is not None and isinstance(truth, (int, float)):
                found.append(ParameterError(name, effect["effect"], parameter, float(truth),
                                            entry["value"], entry["std"] or None))
    return found


def _named_joint(named, concealed):
    """The joint of the first finding; of the second, if the first is a concealed effect that has
    none. "" without findings."""
    if len(named) > 1 and named[0][1] is None and named[0][0] in concealed:
        return named[1][1]
    return named[0][1] if named else ""


def score(name, truth, folder):
    """One case's truth (of the campaign) and the folder of its answers -> Scored."""
    adapted = for_the_scorer(truth)
    said, why_not, seconds = _answer(folder)
    result = (judge.judge(adapted, said, seconds) if said
              else judge.failed(adapted, why_not, seconds))
    effects = adapted["effects"]
    joints = tuple(effect["joint"] for effect in effects if effect["joint"] is not None)
    first = said.named[0] if said and said.named else ("", "")
    names = {effect["effect"] for effect in effects}
    named_joint = _named_joint(said.named if said else [], names)
    errors, failures = _contest(folder)
    return Scored(
        case=name, robot=truth["robot"], result=result,
        effect_right=first[0] in names if effects else None,
        joint_right=named_joint in joints if joints else None, joints=joints,
        named_joint=named_joint,
        parameters=parameter_errors(name, effects, said) if said else [],
        noise=adapted["noise_rms"], errors=errors, failures=failures)
