"""Rewrites the figures in README.md and those in tests/campaigns/bench/README.md, between their markers."""

from . import result
from .programs import SOURCE, Failed

BEGIN = "<!-- written by tools/bench --update-readme: {} -->"
END = "<!-- end of {} -->"
FIGURES = SOURCE / "tests" / "campaigns" / "bench" / "README.md"


def _replace(path, name, lines):
    text = path.read_text()
    begin, end = BEGIN.format(name), END.format(name)
    if text.count(begin) != 1 or text.count(end) != 1:
        raise Failed(f"{path.name}: expected the markers of {name} once")
    head, rest = text.split(begin)
    tail = rest.split(end)[1]
    path.write_text(head + "\n".join([begin, *lines, end]) + tail)


def _speed(measured):
    tick = measured["tick"]
    figures = {figure.name: figure.text() for figure in tick.figures}
    ratios = {ratio.name: result.digits(ratio.value) for ratio in tick.ratios}
    by_tick, by_look_up = (ratios[f"Pinocchio's time / a {of}'s"] for of in ("guarded tick", "look-up"))
    return [f"- **How fast.** A guarded control tick takes {figures['full guarded tick']}, a table look-up "
            f"{figures['look-up with deflection and correction']}.",
            f"  Pinocchio takes {by_tick} and {by_look_up} times as long from the model "
            "([all figures](tests/campaigns/bench/README.md), `tools/bench --only tick`)."]


def lines_of_figures(machine, measured):
    lines = [f"{machine['processor']}, {machine['cores']} cores; {machine['compiler']}; {machine['flexcomp']}."]
    for name, topic in measured.items():
        lines += ["", f"### {topic.title}", "", f"`tools/bench --only {name}`", "", "| | |", "|---|---|"]
        lines += [f"| {figure.name} | {figure.text()} |" for figure in topic.figures]
        if topic.ratios:
            lines += ["", "| ratio | | goal | |", "|---|---|---|---|"]
            lines += [f"| {ratio.name} | {result.digits(ratio.value)} | {ratio.goal_text()} | {ratio.verdict()} |"
                      for ratio in topic.ratios]
        lines += [line for note in topic.notes for line in ("", note)]
    return lines


def update(machine, measured):
    _replace(SOURCE / "README.md", "speed", _speed(measured))
    _replace(FIGURES, "figures", lines_of_figures(machine, measured))
