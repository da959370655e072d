"""The confusion table: what is concealed against what is named first."""

import collections

NOTHING = "(nothing)"


def _place(text):
    """'backlash@2' -> ('backlash', '2')."""
    name, _, joint = text.partition("@")
    return name, joint


def confusion(results):
    """{row: {effect named first: count}}, and {row: how often the effect is right, its joint wrong}.
    A row is an effect alone, 'clean', or a foreign one."""
    table, elsewhere = collections.defaultdict(collections.Counter), collections.Counter()
    for result in results:
        if result.family == "pair":
            continue
        truth, joint = _place(result.truth)
        row = f"foreign {truth}" if result.family == "foreign" else truth
        named, named_joint = _place(result.named.split("+")[0]) if result.named else (NOTHING, "")
        table[row][named] += 1
        elsewhere[row] += named == truth and joint != named_joint
    return table, elsewhere


def render(results, order):
    """The table as text. order: effect names, in which rows and columns come."""
    table, elsewhere = confusion(results)
    columns = [name for name in order if any(name in row for row in table.values())]
    columns += sorted({name for row in table.values() for name in row} - set(columns) - {NOTHING})
    columns.append(NOTHING)
    rows = [name for name in order if name in table]
    rows += sorted(set(table) - set(rows))
    width = max([len(row) for row in rows], default=10) + 1
    lines = ["Concealed (rows) against named first (columns, numbered as listed below):",
             " " * (width + 4) + "".join(f"{k:4d}" for k in range(1, len(columns) + 1))
             + "  joint wrong"]
    for row in rows:
        counts = "".join(f"{table[row][name] or '.':>4}" for name in columns)
        total = sum(table[row].values())
        lines.append(f"{row:<{width}}{total:4d}{counts}  {elsewhere[row] or ''}".rstrip())
    lines.append("")
    lines += [f"{k:4d}  {name}" for k, name in enumerate(columns, 1)]
    return "\n".join(lines)
