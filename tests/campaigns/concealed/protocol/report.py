"""The report of a campaign: one page of HTML that needs no other file."""

import collections
import math
from html import escape

from generator.effects import CATALOGUE
from scoring import table as confusion_table

from . import goals, loop_section, pictures, rivals_section, wording
from .judging import DIAGNOSED, NOMINAL
from .markup import STYLE, grid, number, paragraph, table

WORST = 6


def _goals(found):
    words = {True: '<span class="yes">reached</span>', False: '<span class="no">not reached</span>',
             None: "not judged"}
    rows = [[escape(goal.figure), wording.limit_text(goal), escape(wording.figure_text(figure)),
             words[met]] for goal, figure, met in goals.judged(found)]
    return table(("", "goal", "this campaign", ""), rows)


def _how(campaign):
    if campaign["isolated"]:
        shield = ("Each diagnosis ran in mount and process namespaces of its own, whose files were "
                  "the system's, the tool, and copies of that case alone; without network.")
    else:
        shield = (f"<b>The kernel refused namespaces ({escape(campaign['why_not_isolated'])})</b>: "
                  "runs had a private folder and a bare environment; the truth was protected by "
                  "its seal and the watch.")
    if campaign["watched"]:
        watch = ("The sealed file was watched (inotify): nobody opened, read or changed it until "
                 "the seal was opened.")
    else:
        watch = ("<b>The sealed file could not be watched "
                 f"({escape(campaign['why_not_watched'])}).</b>")
    return paragraph(
        f"{campaign['cases']} cases were drawn from seed {campaign['seed']} and simulated by an",
        "independent physics engine. Their truth and the SHA-256 of every file of every case were",
        "written down with 32 random bytes, the text's own SHA-256 was printed and stored, and the",
        f"text was kept unreadable until the last answer was in. {shield} {watch} Then the seal",
        "was opened and its hash and the cases' files checked."
    ) + paragraph(
        f"SHA-256 of the truth: <code>{campaign['sha256']}</code><br>",
        f"SHA-256 of the tool: <code>{campaign['tool_sha256']}</code>"
    ) + paragraph(
        "To check the seal, and to do it all again (with a seed of your own: the truth follows",
        "from the seed, so choose one that nobody knew):"
    ) + ("<pre>sha256sum -c seal.sha256   # in this folder: truth.json is what was committed to\n"
         f"{escape(campaign['command'])}</pre>")


def _ordered(names):
    known = [name for name in CATALOGUE if name in names]
    return known + sorted(set(names) - set(known))


def _confusion(scored):
    nothing = confusion_table.NOTHING
    counts, _ = confusion_table.confusion([each.result for each in scored])
    named = {name for row in counts.values() for name in row} - {nothing}
    columns = _ordered(named | (set(counts) & set(CATALOGUE))) + [nothing]

    def is_right(row, column):
        return row == column or (column == nothing and row not in CATALOGUE)
    return paragraph(
        "Rows: what was concealed (number of cases); columns: the first finding. Blue is right.",
        "Pairs are in the list of cases below."
    ) + grid(_ordered(counts), columns, counts, is_right)


def _places(scored):
    """Concealed joint against the first finding's; of a pair, the one that was named, if any."""
    counts = collections.defaultdict(collections.Counter)
    words = {None: "none in the finding", "": "no finding"}
    for each in goals.of_families(scored, "single", "pair"):
        if each.joints:
            concealed = each.named_joint if each.joint_right else each.joints[0]
            counts[concealed][words.get(each.named_joint, each.named_joint)] += 1
    columns = [1, 2, 3, 4, 5, 6, *words.values()]
    return paragraph(
        "Rows: the joint of the concealed effect; columns: the first finding's."
    ) + grid(sorted(counts), columns, counts, lambda row, column: row == column)


def is_wrong(each):
    if each.result.family == "clean":
        return each.result.alarm
    if each.result.family == "foreign":
        return each.result.claims
    return not each.effect_right or each.joint_right is False


def worst(scored):
    """Wrong ones first, before all those that name what is not there; then by the error that is
    left on the held-out recording. Foreign physics left alone is right, however large its error."""
    chosen = [each for each in scored if is_wrong(each) or each.effect_right is not None]
    return sorted(chosen, key=lambda each: (
        not is_wrong(each), each.effect_right is not None,
        -(each.error(DIAGNOSED, "holdout") or math.inf)))[:WORST]


def _worst(scored, answers):
    html = ""
    for each in worst(scored):
        result = each.result
        html += f"<h3>Case {each.case}: {escape(result.truth)}, {escape(result.kind)}</h3>"
        html += paragraph(
            f"Named: {escape(result.named or 'nothing')}; verdict: {escape(result.verdict)}.",
            "Error on the held-out recording (rms over the components of a few rows at a time):")
        html += pictures.residual_pictures(each, answers / each.case)
    return html


def _parameters(scored):
    groups = collections.defaultdict(list)
    for error in goals.told(scored):
        groups[error.effect, error.name].append(error)
    rows = []
    for (effect, name), errors in sorted(groups.items()):
        rate = goals.coverage(errors)
        relative = goals.median(abs(error.value / error.truth - 1) for error in errors
                                if error.truth)
        farthest = max((error.deviations for error in errors), key=abs)
        rows.append([effect, name, f"{rate.k} of {rate.n}",
                     "–" if relative is None else f"{100 * relative:.2g} %", f"{farthest:+.1f}"])
    everything = [error for errors in groups.values() for error in errors]
    return paragraph(
        "Of findings with the right effect and joint: is the truth within value ± 1.96 std? Without "
        "parameters that have no interval."
    ) + pictures.coverage_picture(everything) + table(
        ("effect", "parameter", "within 95 %", "median error", "largest error / std"), rows,
        (2, 3, 4))


def _cases(scored):
    rows = []
    for each in scored:
        result = each.result
        errors = [number(each.error(method, region)) for method, region in (
            (NOMINAL, "holdout"), (DIAGNOSED, "holdout"), (DIAGNOSED, "untrained"))]
        rows.append([each.case, escape(result.kind), escape(each.robot), escape(result.truth),
                     escape(result.named or "–"), escape(result.verdict), *errors,
                     f"{result.seconds:.0f}"])
    return paragraph(
        "Errors in units of the noise: held-out before and after, untrained after."
    ) + table(("case", "kind", "robot", "concealed", "named", "verdict", "before", "after",
               "untrained", "s"), rows, (6, 7, 8, 9))


def _sections(scored, found, campaign, answers):
    yield "Goals", _goals(found)
    yield "How it was done", _how(campaign)
    yield "What was concealed and what was named first", _confusion(scored)
    yield "Where", _places(scored)
    yield "Held-out error", paragraph(
        "By simulating the held-out recording with the nominal and with the diagnosed model; in",
        "units of the sensors' noise, all channels of a recording together."
    ) + pictures.errors_picture(goals.of_families(scored, "single", "pair"))
    yield "Parameters and their stated uncertainty", _parameters(scored)
    yield "Rivals", rivals_section.section(scored)
    yield "The loop closed", loop_section.section(scored)
    yield "The worst cases", _worst(scored, answers)
    yield "All figures", table(("figure", "value"), [
        [escape(name), escape(wording.figure_text(figure))] for name, figure in found.items()])
    yield "All cases", _cases(scored)


def html(scored, found, campaign, answers):
    """The page. campaign: facts on what was run; answers: folder of the answers."""
    title = f"Concealed physics: a blind campaign, seed {campaign['seed']}"
    body = "\n".join(f"<h2>{heading}</h2>\n{text}"
                     for heading, text in _sections(scored, found, campaign, answers))
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>\n'
            f"<style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n"
            f'<p class="lead">{escape(wording.headline(found))}</p>\n{body}\n</body></html>\n')
