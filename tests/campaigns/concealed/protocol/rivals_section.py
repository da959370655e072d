"""The part of the report that sets the rivals beside the diagnosis."""

from html import escape

from . import goals, pictures
from .judging import DIAGNOSED, NOMINAL
from .markup import number, paragraph, table


def _medians(scored):
    families = (goals.of_families(scored, "single", "pair"), goals.of_families(scored, "clean"),
                goals.of_families(scored, "foreign"))
    rows = []
    for method in (NOMINAL, *goals.rivals(scored), goals.REFIT, DIAGNOSED):
        cells = [number(goals.median(each.error(method, region) for each in family))
                 for family in families for region in ("holdout", "untrained")]
        failed = sum(method in each.failures for each in scored)
        rows.append([method, *cells, failed or ""])
    return table(("method", "concealed: held out", "untrained", "clean: held out", "untrained",
                  "foreign: held out", "untrained", "failed or too slow"), rows, range(1, 8))


def _lost_to_refit(scored):
    rows = []
    for each, ratio in goals.worse_than_refit(scored):
        errors = [number(each.error(method, "untrained"))
                  for method in (NOMINAL, DIAGNOSED, goals.REFIT)]
        by_more = each.beyond_chance(DIAGNOSED, goals.REFIT, "untrained")
        rows.append([each.case, escape(each.result.truth), escape(each.result.kind),
                     escape(each.result.named or "–"), *errors, f"{ratio:.4g}",
                     "yes" if by_more else "within chance"])
    if not rows:
        return "<p>Nowhere.</p>"
    return table(("case", "concealed", "kind", "named", "nominal", "flexcomp", "refit",
                  "flexcomp / refit", "more than chance"), rows, range(4, 8))


def section(scored):
    """HTML."""
    if not goals.rivals(scored):
        return "<p>The rivals were not asked (<code>--no-rivals</code>).</p>"
    html = paragraph(
        "All learn from the training recordings alone; the untrained recording does the same",
        "work with the arm elsewhere. The diagnosis has seen the held-out recording (it takes no",
        "finding that does not prove itself there), the rivals have not; nobody has seen the",
        "untrained one.",
        "Medians of error / noise:")
    html += _medians(scored)
    effects = goals.of_families(scored, "single", "pair")
    for region, words in (("holdout", "Held out, in the region of the training"),
                          ("untrained", "The untrained region")):
        html += f"<h3>{words}: cases with concealed effects</h3>"
        html += pictures.rivals_picture(effects, region)
    return (f"{html}<h3>Where the plain refit predicts the untrained region better</h3>"
            + _lost_to_refit(scored))
