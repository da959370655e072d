"""The part of the report on circles milled with the nominal and with the diagnosed model."""

from html import escape

from . import goals, loops
from .markup import number, paragraph, table


def _row(each):
    text = [each.case, escape(each.result.truth), escape(each.result.kind),
            escape(each.result.named or "–")]
    loop = each.loop
    if not isinstance(loop, loops.Loop):
        return text + ["", "", "", "", escape(loop)]
    sizes = [f"{1e6 * size:.0f}" for size in
             (loop.uncorrected, loop.without, loop.nominal, loop.diagnosed)]
    return text + sizes + [f"{loop.ratio:.2f}" if loop.is_spoiled else "hardly matters"]


def section(scored):
    """HTML."""
    tried = [each for each in scored if each.loop is not None]
    if not tried:
        return "<p>The loop was not closed (<code>--no-loop</code>).</p>"
    judged = goals.closed_loops(scored)
    ratio = goals.median(each.loop.ratio for each in judged)
    tried.sort(key=lambda each: (each not in judged, each.loop.ratio if each in judged else 0))
    return paragraph(
        "The first case of every effect mills another circle on its concealed plant. The program is",
        "corrected tick by tick by the core, with a table made from the nominal model and with one",
        "made from the diagnosed model, by <code>flexcomp table</code> and <code>flexcomp",
        "compensate</code>; the wrench is what the plant's own sensor reads. Circularity (minimum",
        "zone, µm) of where the TCP went:"
    ) + table(("case", "concealed", "kind", "named", "uncorrected", "nothing concealed", "nominal",
               "diagnosed", "diagnosed / nominal"), [_row(each) for each in tried],
              range(4, 9)) + paragraph(
        f"Median of the last column, over {len(judged)} cases in which what is concealed makes the",
        f"circle more than {loops.CLEARLY:g} times as bad: {number(ratio)}.")
