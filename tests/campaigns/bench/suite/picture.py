"""A topic as a picture, by gnuplot: its figures as bars, and beside them how the cost grows."""

import math
import subprocess

SIZE = (1300, 520)


def _quoted(text):
    return '"' + text.replace('"', "'") + '"'


def _decades(least, step=1):
    """Tics at powers of ten: left to itself gnuplot begins anywhere, and the label has the power alone."""
    return f"{10.0 ** math.floor(math.log10(least)):g},{10**step}"


def _bars(topic):
    unit = topic.figures[0].unit
    figures = [figure for figure in topic.figures if figure.unit == unit][::-1]
    least = min(figure.value for figure in figures) / 3
    most = max(figure.value for figure in figures)
    room = max(6, (most / least) ** 0.7)  # for the text behind the longest bar
    # In labels of tics a percent sign begins a format.
    ticks = ", ".join(f"{_quoted(figure.name.replace('%', '%%'))} {place}" for place, figure in enumerate(figures))
    decades = math.ceil(math.log10(room * most / least) / 8)  # from one label to the next
    rows = "\n".join(f"{least:g} {place} {least:g} {figure.value:g} {place - 0.35} {place + 0.35} "
                     f"{_quoted(figure.text())}" for place, figure in enumerate(figures))
    return f"""
$bars << END
{rows}
END
set logscale x
unset logscale y
set xrange [{least:g}:{room * most:g}]
set yrange [-0.7:{len(figures) - 0.3}]
set ytics ({ticks})
set xtics {_decades(least, decades)}
set format x "10^{{%T}}"
set xlabel {_quoted(unit or "figure")}
unset ylabel
unset key
set style fill solid 0.6
plot $bars using 1:2:3:4:5:6 with boxxyerror lc rgb "#3465a4", \\
     $bars using 4:2:7 with labels left offset 0.6,0
"""


def _styles(names):
    """A colour for each first word of a name, a dash and a mark for each rest of one."""
    colours, dashes = {}, {}
    for name in names:
        first, _, rest = name.partition(" ")
        colour = colours.setdefault(first, len(colours) + 1)
        dash = dashes.setdefault(rest, len(dashes) + 1)
        yield f"lc {colour} dt {dash} pt {2 * dash + 2} lw 1.5"


def _range(values):
    return f"[{min(values) / 2:g}:{max(values) * 2:g}]"


def _curves(topic):
    blocks = "\n".join(f"$curve{number} << END\n" + "\n".join(f"{x:.9g} {y:.9g}" for x, y in curve.points) + "\nEND"
                       for number, curve in enumerate(topic.curves))
    xs = [x for curve in topic.curves for x, _ in curve.points]
    ys = [y for curve in topic.curves for _, y in curve.points]
    styles = _styles([curve.name for curve in topic.curves])
    plots = ", ".join(f"$curve{number} using 1:2 with linespoints {style} title {_quoted(curve.name)}"
                      for number, (curve, style) in enumerate(zip(topic.curves, styles)))
    return f"""
{blocks}
set logscale xy
set xrange {_range(xs)}
set yrange {_range(ys)}
set xtics {_decades(min(xs))}
set ytics {_decades(min(ys))}
set format y "10^{{%T}}"
set xlabel {_quoted(topic.axes[0])}
set ylabel {_quoted(topic.axes[1])}
set key above
plot {plots}
"""


def draw(topic, path):
    """Writes a PNG."""
    script = f"""set encoding utf8
set terminal pngcairo size {SIZE[0]},{SIZE[1]} font "sans-serif,11" background "#ffffff"
set output {_quoted(str(path))}
set grid
set multiplot layout 1,{2 if topic.curves else 1} title {_quoted(topic.title)} font ",13" noenhanced
set tics nomirror
""" + _bars(topic) + (_curves(topic) if topic.curves else "") + "unset multiplot\n"
    subprocess.run(["gnuplot"], input=script, text=True, check=True)
