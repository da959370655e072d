"""Pictures, by gnuplot."""

import dataclasses
import subprocess

import numpy as np

from .study import speed_of

GREY, RED, BLUE = "#909090", "#c03020", "#2050b0"


@dataclasses.dataclass
class Curve:
    """x, y: (n,); dots instead of a line where wanted."""

    label: str
    x: np.ndarray
    y: np.ndarray
    color: str
    dots: bool = False


class NoPicture(Exception):
    """gnuplot is not there or refuses."""


def draw(path, title, x, y, curves):
    """A PNG with curves over the axes' texts x and y."""
    lines = ["set terminal pngcairo size 800,420 font 'sans,10'", f'set output "{path}"',
             f'set title "{title}"', f'set xlabel "{x}"', f'set ylabel "{y}"', "set grid",
             "set key outside top center horizontal"]
    for number, curve in enumerate(curves):
        known = np.isfinite(curve.x) & np.isfinite(curve.y)
        rows = [f"{a:.7g} {b:.7g}" for a, b in zip(curve.x[known], curve.y[known])]
        lines += [f"$curve{number} << END", *rows, "END"]
    styles = [f'$curve{number} with {"points pt 7 ps 0.3" if curve.dots else "lines"} '
              f'lc rgb "{curve.color}" '
              f'title "{curve.label}"' for number, curve in enumerate(curves)]
    lines.append("plot " + ", ".join(styles))
    try:
        done = subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", capture_output=True,
                              text=True)
    except OSError as error:
        raise NoPicture(f"pictures need gnuplot: {error.strerror}") from error
    if done.returncode != 0:
        raise NoPicture(f"gnuplot: {' '.join(done.stderr.split())}")


def torque_error(path, outcome, joint, title, unit="N·m"):
    """Residuals that the models leave of a joint's measured torque, over time."""
    name, time = f"tau_{joint}", outcome.measured["t"]
    draw(path, title, "s", f"measured less simulated, {unit}", [
        Curve("model that lacks it", time, outcome.measured[name] - outcome.before[name], RED),
        Curve("with what the diagnosis found", time, outcome.measured[name] - outcome.after[name],
              BLUE)])


def missing_torque_over_speed(path, outcome, joint, title, x="rad/s", y="N·m"):
    """The nominal model's residual of a joint's torque, and what was found for it."""
    name, speed = f"tau_{joint}", speed_of(outcome.measured, joint)
    draw(path, title, x, y, [
        Curve("measured less model that lacks it", speed,
              outcome.measured[name] - outcome.before[name], GREY, True),
        Curve("what the diagnosis found", speed, outcome.after[name] - outcome.before[name], BLUE,
              True)])


def sorted_errors(path, outcome, title):
    """Lengths of the TCP's errors, held out, by share of poses."""
    curves = []
    for label, simulated, color in (("model that lacks it", outcome.before, RED),
                                    ("with what the diagnosis found", outcome.after, BLUE)):
        length = np.sort(np.linalg.norm(outcome.errors(simulated, "xyz"), axis=1)) * 1e3
        share = (np.arange(len(length)) + 0.5) / len(length) * 100
        curves.append(Curve(label, length, share, color))
    draw(path, title, "error at the TCP, mm", "share of poses below, %", curves)
