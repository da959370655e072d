"""The pictures of a campaign's report."""

import csv
import math
import statistics

from . import svg
from .goals import rivals
from .judging import DIAGNOSED, NOMINAL

BEFORE, AFTER, NOISE = "#c0392b", "#1f6fb4", "#222222"
UNITS = {"tcp_position": (1e6, "µm"), "joint_torque": (1.0, "N·m"),
         "joint_deflection": (1e6, "µrad")}


def _around(values):
    """Limits of a logarithmic axis: a little more than the values, and at least from 0.5 to 2."""
    return min(0.5, min(values) / 1.3), max(2.0, max(values) * 1.3)


def _label(each):
    return f"case {each.case}: {each.result.truth}, {each.result.kind}"


def errors_picture(scored):
    """Held-out error before and after, a column a case, the worst first."""
    rows = [(each.error(NOMINAL, "holdout"), each.error(DIAGNOSED, "holdout"), each)
            for each in scored]
    rows = sorted((row for row in rows if row[0] and row[1]), key=lambda row: (-row[1], -row[0]))
    if not rows:
        return "<p>No case was simulated.</p>"
    plot = svg.Plot((0, len(rows) + 1), _around([value for row in rows for value in row[:2]]),
                    ("cases with concealed effects, in the order of the error after",
                     "held-out error / noise"), log=(False, True),
                    ticks={str(k): k for k in range(1, len(rows) + 1, -(-len(rows) // 20))})
    plot.level(1.0, NOISE)
    for k, (before, after, _) in enumerate(rows, 1):
        plot.line([(k, before), (k, after)], svg.GREY)
    names = [_label(each) for *_, each in rows]
    plot.points([(k, row[0]) for k, row in enumerate(rows, 1)], BEFORE, names=names)
    plot.points([(k, row[1]) for k, row in enumerate(rows, 1)], AFTER, names=names)
    legend = svg.legend({"nominal model": BEFORE, "diagnosed model": AFTER, "noise": NOISE})
    return legend + plot.svg()


def coverage_picture(parameters):
    """Share of the parameters that lie in their interval, for each stated level."""
    if not parameters:
        return "<p>No parameter can be compared.</p>"
    normal = statistics.NormalDist()
    levels = [k / 50 for k in range(1, 50)]
    sizes = [abs(error.deviations) for error in parameters]
    observed = [sum(size <= normal.inv_cdf((1 + level) / 2) for size in sizes) / len(sizes)
                for level in levels]
    plot = svg.Plot((0, 100), (0, 100), ("stated confidence, %", "parameters in their interval, %"),
                    size=(420, 380))
    plot.line([(0, 0), (100, 100)], NOISE, dashes="5 4")
    # Pointwise 95 % range of the observed share if the statement is right (normal approximation).
    for side in (-1, 1):
        plot.line([(100 * level, 100 * min(1, max(0, level + side * 1.96 * math.sqrt(
            level * (1 - level) / len(sizes))))) for level in levels], svg.GREY)
    plot.line([(100 * level, 100 * share) for level, share in zip(levels, observed)], AFTER, 2)
    return svg.legend({"observed": AFTER, "as stated": NOISE,
                       "95 % of campaigns lie between, if as stated": svg.GREY}) + plot.svg()


def rivals_picture(scored, region):
    """Error of each method in each case, and the median as a bar."""
    methods = [NOMINAL, *rivals(scored), "refit", DIAGNOSED]
    columns = {}
    for method in methods:
        pairs = [(each.error(method, region), each) for each in scored]
        pairs = [pair for pair in pairs if pair[0]]
        if pairs:
            columns[method] = pairs
    if not columns:
        return "<p>No case was simulated.</p>"
    plot = svg.Plot((0.3, len(columns) + 0.7),
                    _around([value for pairs in columns.values() for value, _ in pairs]),
                    ("", "error / noise"), log=(False, True),
                    ticks={method: k for k, method in enumerate(columns, 1)})
    plot.level(1.0, NOISE)
    for k, (method, pairs) in enumerate(columns.items(), 1):
        colour = AFTER if method == DIAGNOSED else BEFORE if method == NOMINAL else "#8e6bb0"
        spread = [k + 0.5 * ((7 * i) % 11 - 5) / 11 for i in range(len(pairs))]
        plot.points([(x, value) for x, (value, _) in zip(spread, pairs)], colour, 2.5,
                    [_label(each) for _, each in pairs])
        middle = statistics.median(value for value, _ in pairs)
        plot.line([(k - 0.35, middle), (k + 0.35, middle)], "#000", 2.5)
    return plot.svg()


def residual_pictures(each, folder):
    """Error over time on the held-out recording, before and after: rms over the components of a few
    rows at a time. A picture for each channel."""
    path = folder / "contest" / "curves.csv"
    if not path.is_file():
        return "<p>There is no updated model to simulate.</p>"
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    html = ""
    for channel in dict.fromkeys(row["channel"] for row in rows):
        scale, unit = UNITS[channel]
        mine = [row for row in rows if row["channel"] == channel]
        curves = {method: [(float(row["t"]), scale * float(row[method])) for row in mine]
                  for method in (NOMINAL, DIAGNOSED)}
        html += _residual_picture(curves, channel, unit, scale * each.noise.get(channel, 0.0))
    return svg.legend({"nominal model": BEFORE, "diagnosed model": AFTER,
                       "noise": NOISE}) + html


def _residual_picture(curves, channel, unit, noise):
    points = [point for curve in curves.values() for point in curve]
    times, largest = [x for x, _ in points], max(y for _, y in points)
    static = all(x == int(x) for x in times)
    plot = svg.Plot((min(times), max(times) + (min(times) == max(times))),
                    (0, 1.05 * max(largest, noise) or 1.0),
                    ("row (pose and load)" if static else "time, s",
                     f"{channel.replace('_', ' ')} error, {unit}"), size=(760, 240))
    for method, colour in ((NOMINAL, BEFORE), (DIAGNOSED, AFTER)):
        if static:
            plot.points(curves[method], colour, 2.5)
        else:
            plot.line(curves[method], colour, 1.0)
    plot.level(noise, NOISE)
    return plot.svg()
