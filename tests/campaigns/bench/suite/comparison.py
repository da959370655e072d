"""What became worse since the figures of tests/campaigns/bench/README.md were written.

Instructions, bytes and ratios can be compared with those of another day; times cannot, because machines are noisy
and differ. A ratio counts where its goal says which way is better.
"""

from . import result

COUNT_TOLERANCE = 1.02
RATIO_TOLERANCE = 1.1  # two runs differ by about a tenth
_TOPIC = "`tools/bench --only "


def figures_of(page):
    """Topic to name to text, of all tables of figures and ratios in a page."""
    found = {}
    rows = {}
    for line in page.splitlines():
        if line.startswith(_TOPIC):
            rows = found.setdefault(line.removeprefix(_TOPIC).rstrip("`"), {})
        elif line.startswith("| "):
            name, text = [cell.strip() for cell in line.strip("|").split("|")][:2]
            rows[name] = text
    return found


def number(text):
    try:
        return float(text.split()[0].replace(",", ""))
    except (IndexError, ValueError):
        return None


def worse(before, topic):
    """A sentence for each figure of a topic that is worse than the text it had."""
    sentences = []
    for figure in topic.figures:
        old = number(before.get(figure.name, ""))
        if figure.unit in result.COUNTS and old and figure.value > COUNT_TOLERANCE * old:
            sentences.append(f"{figure.name}: {figure.text()}, was {before[figure.name]}")
    for ratio in topic.ratios:
        old = number(before.get(ratio.name, ""))
        if ratio.goal is None or not old:
            continue
        factor = ratio.value / old if ratio.at_most else old / ratio.value
        if factor > RATIO_TOLERANCE:
            sentences.append(f"{ratio.name}: {result.digits(ratio.value)}, was {before[ratio.name]}")
    return sentences
