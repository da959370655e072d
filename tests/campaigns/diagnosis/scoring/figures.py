"""Rates, their confidence, and the goals they are held to."""

import dataclasses
import statistics

from scipy import stats

from .judge import RIGHT

CONFIDENCE = 0.95


@dataclasses.dataclass
class Rate:
    """k of n, with the interval of Clopper and Pearson."""

    k: int
    n: int

    @property
    def value(self):
        return self.k / self.n if self.n else None

    @property
    def interval(self):
        tail = (1 - CONFIDENCE) / 2
        low = stats.beta.ppf(tail, self.k, self.n - self.k + 1) if self.k else 0.0
        high = stats.beta.ppf(1 - tail, self.k + 1, self.n - self.k) if self.k < self.n else 1.0
        return float(low), float(high)

    def as_json(self):
        return {"k": self.k, "n": self.n, "rate": self.value,
                "interval_95": list(self.interval) if self.n else None}

    def __str__(self):
        if not self.n:
            return "no case"
        low, high = self.interval
        return (f"{100 * self.value:6.1f} %  ({self.k} of {self.n}; "
                f"95 %: {100 * low:.1f} to {100 * high:.1f} %)")


@dataclasses.dataclass
class Goal:
    figure: str
    limit: float
    at_least: bool
    cases: int  # that the goal asks for

    def met(self, value):
        return value >= self.limit if self.at_least else value <= self.limit


GOALS = (
    Goal("single: right effect and joint first", 0.95, True, 200),
    Goal("pair: recall", 0.90, True, 100),
    Goal("pair: precision", 0.95, True, 100),
    Goal("clean: false alarms", 0.01, False, 200),
    Goal("foreign: confident wrong findings", 0.05, False, 60),
    Goal("held-out rms / noise, median", 1.15, False, 0),
)


def _count(results, test):
    return Rate(sum(bool(test(result)) for result in results), len(results))


def figures(results):
    """Results -> {name: Rate or number or None}."""
    family = {name: [result for result in results if result.family == name]
              for name in ("single", "pair", "clean", "foreign", "variant")}
    single, pair = family["single"], family["pair"]
    found = {
        "single: right effect and joint first": _count(single, lambda r: r.first in RIGHT),
        "single: exactly": _count(single, lambda r: r.first == "exact"),
        "single: by an equivalent (correlation > 0.999)": _count(
            single, lambda r: r.first == "equivalent"),
        "single: only in a group the tool cannot tell apart": _count(
            single, lambda r: r.first == "group"),
        "single: findings that are wrong": Rate(
            sum(r.findings - r.right_findings for r in single), sum(r.findings for r in single)),
        "pair: recall": Rate(sum(r.found for r in pair), sum(r.concealed for r in pair)),
        "pair: precision": Rate(sum(r.right_findings for r in pair), sum(r.findings for r in pair)),
        "pair: both found and nothing else": _count(
            pair, lambda r: r.found == r.concealed == r.findings),
        "clean: false alarms": _count(family["clean"], lambda r: r.alarm),
        "foreign: confident wrong findings": _count(family["foreign"], lambda r: r.claims),
        "foreign: of these called explained": _count(
            family["foreign"], lambda r: r.claims and r.verdict == "explained"),
        "foreign: mismatch missed (no_mismatch)": _count(
            family["foreign"], lambda r: r.verdict == "no_mismatch"),
        "variant: right effect, or a law": _count(family["variant"], lambda r: r.first in RIGHT),
        "variant: nothing named": _count(family["variant"], lambda r: r.first == "nothing"),
        "variant: findings that are wrong": Rate(
            sum(r.findings - r.right_findings for r in family["variant"]),
            sum(r.findings for r in family["variant"])),
        "parameters in their 95 % interval": Rate(*(
            sum(getattr(r, name) for r in results if r.family != "variant")
            for name in ("covered", "compared"))),
        "runs without an answer": _count(results, lambda r: r.verdict.startswith("failed")),
    }
    ratios = [(channel, ratio) for r in single + pair for channel, ratio in r.holdout_ratio.items()]
    found["held-out rms / noise, median"] = _median(ratio for _, ratio in ratios)
    for name in sorted({channel for channel, _ in ratios}):
        found[f"  {name}"] = _median(ratio for channel, ratio in ratios if channel == name)
    found["seconds a case, median"] = _median(r.seconds for r in results)
    found["seconds a case, longest"] = max((r.seconds for r in results), default=None)
    return found


def _median(values):
    values = list(values)
    return statistics.median(values) if values else None


def value_of(figure):
    return figure.value if isinstance(figure, Rate) else figure


def unmet(found):
    """The goals that do not hold; those without a case are not judged, except the precision of a tool
    that names nothing."""
    missed = []
    for goal in GOALS:
        value = value_of(found[goal.figure])
        if value is not None and not goal.met(value):
            missed.append(goal)
    return missed
