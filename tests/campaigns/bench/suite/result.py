"""Result of a topic: figures, ratios with their goals, and how a cost grows."""

import dataclasses

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
COUNTS = ("", "bytes", "instructions")  # units that take no prefix


@dataclasses.dataclass
class Figure:
    name: str
    value: float
    unit: str

    def text(self):
        return quantity(self.value, self.unit)


@dataclasses.dataclass
class Ratio:
    name: str
    value: float
    goal: float | None = None
    at_most: bool = False  # is the goal an upper limit?

    def reached(self):
        if self.goal is None:
            return None
        return self.value <= self.goal if self.at_most else self.value >= self.goal

    def goal_text(self):
        return "" if self.goal is None else f"{'at most' if self.at_most else 'at least'} {self.goal:g}"

    def verdict(self):
        return {None: "", True: "reached", False: "not reached"}[self.reached()]


@dataclasses.dataclass
class Curve:
    name: str
    points: list  # [x, y]


@dataclasses.dataclass
class Topic:
    title: str
    figures: list
    ratios: list
    curves: list
    axes: tuple  # of the curves: x, y
    notes: list = dataclasses.field(default_factory=list)

    def as_json(self):
        found = dataclasses.asdict(self)
        for ratio, entry in zip(self.ratios, found["ratios"]):
            entry["reached"] = ratio.reached()
        return found


def quantity(value, unit):
    """Three digits, with a prefix where the unit takes one."""
    if unit in COUNTS:
        return f"{value:,.0f} {unit}".strip() if value >= 100 else f"{value:.3g} {unit}".strip()
    for factor, prefix in PREFIXES:
        if abs(value) >= factor:
            return f"{digits(value / factor)} {prefix}{unit}"
    return f"{value:.2e} {unit}"


def digits(value):
    """Three of them, without an exponent."""
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}"
