"""The figures of a campaign for a person: goals, a row a kind of physics, a row a case."""

from . import milled
from .judge import GOAL, MOST_WRONG, SHARE


def _percent(value):
    return "–" if value is None else f"{100 * value:.0f} %"


def _of(share):
    return f"{share['count']} of {share['of']}"


def _goal(words, share, limit, at_least=True):
    if share["share"] is None:
        met = "-"
    else:
        met = "holds" if (share["share"] >= limit) == at_least or share["share"] == limit else "MISSED"
    print(f"{met:<7}{words}: {_of(share)} (goal: {'at least' if at_least else 'at most'} "
          f"{_percent(limit)})")


def _case(row):
    falls = [row["fall"].get(method, {}).get(part) for part in GOAL
             for method in ("flexcomp", "refit", "true law")]
    what = row["foreign"] or "clean"
    place = f" {row['joint']}" if row["joint"] else ""
    beside = f" + {row['known']}" if row["known"] else ""
    size = f"{row['over_noise']:.0f}" if row["over_noise"] else ""
    marks = ("law " if row["right_law"] else "") + ("WRONG " if row["wrong"] else "")
    named = "; ".join(row["named"]) or "nothing"
    print(f"{row['case']} {row['kind']:<7}{what + place + beside:<44}{size:>3} "
          + "".join(f"{_percent(each):>8}" for each in falls)
          + f" {row['seconds']:>5.0f}  {marks}{named}"
          + (f" ({row['verdict']})" if row["verdict"] else f" ({row['last_words']})"))


def _circles(rows):
    print("\nCircularity of a milled circle, mm: corrected by the nominal model, by the diagnosed one, and of "
          "the machine without what is concealed, corrected by the nominal model.\n")
    for row in (row for row in rows if row["loop"]):
        loop = row["loop"]
        what = f"{row['case']} {row['foreign']}" + (f" + {row['known']}" if row["known"] else "")
        print(f"{what:<44}" + (loop["failed"] if "failed" in loop else "".join(
            f"{1e3 * loop[key]:>9.4f}" for key in ("nominal", "diagnosed", "without"))
            + ("" if milled.is_judged(loop) else "  hardly matters")))


def show(rows, found):
    """Prints them."""
    print("\nBy which share the error beyond the noise falls: held out, then in the untrained "
          "region; by flexcomp, by the plain refit, by the true law.\n")
    print(f"{'case':<3} {'kind':<7}{'concealed':<44}{'×':>3} "
          + "".join(f"{word:>8}" for word in ("held out", "refit", "true"))
          + "".join(f"{word:>8}" for word in ("untr.", "refit", "true")) + "     s  named")
    for row in sorted(rows, key=lambda row: (row["family"], row["foreign"] or "", row["case"])):
        _case(row)
    if any(row["loop"] for row in rows):
        _circles(rows)
    print()
    for part, words in (("holdout", "held out"), ("untrained", "untrained region")):
        entry = found["fall"][part]
        _goal(f"a law exists: error {words} falls by {_percent(GOAL[part])} or more",
              entry["flexcomp"]["reached"], SHARE)
        words = f"; no worse than it: {_of(entry['better_than_refit'])}"
        for method in ("flexcomp", "refit"):
            print(f"       {method}: {_of(entry[method]['reached'])}, median "
                  f"{_percent(entry[method]['median'])}" + (words if method == "refit" else ""))
    _goal("a law exists: one is given, at the right place", found["right_law"], SHARE)
    _goal("beside a catalogue effect: both found", found["both_found"], SHARE)
    print(f"       the catalogue effect by itself: {_of(found['known_found'])}")
    _goal(f"in the loop: circularity at most {_percent(milled.GOAL)} of that with the nominal model, of "
          "circles that a command can mend", found["circles"], milled.SHARE)
    _goal("a wrong known name", found["wrong_known_name"], MOST_WRONG, at_least=False)
    print(f"       of these where no law exists: {_of(found['no_law_and_wrong_name'])}")
    print(f"no law exists: told in time, at the right place: {_of(found['no_law_and_told'])}")
    _goal("clean: a law all the same", found["laws_on_clean"], 0.01, at_least=False)
    print(f"       any finding: {_of(found['findings_on_clean'])}")
    print("       worse than the nominal model, held out or in the untrained region: "
          + ", ".join(f"{method} {_of(share)}" for method, share in found["made_worse"].items()))
    print(f"{found['answered']} of {found['cases']} answered; "
          f"{found['seconds']['median']:.1f} s in the median, {found['seconds']['max']:.0f} s at "
          f"most (processor {found['cpu']['median']:.1f}, {found['cpu']['max']:.0f} s)")
