"""Pieces of HTML that a report is made of."""

from html import escape

STYLE = """
body{font-family:sans-serif;max-width:1080px;margin:2em auto;padding:0 1em;color:#222;
line-height:1.4}
table{border-collapse:collapse;margin:.6em 0}td,th{padding:.25em .7em;text-align:left;
vertical-align:top;border-bottom:1px solid #ddd}td.n,th.n{text-align:right}
.lead{font-size:1.2em}h2{margin-top:1.8em}svg{max-width:100%;height:auto}
code,pre{background:#f4f4f4}pre{padding:.8em;overflow-x:auto}
.yes{color:#1a7f37}.no{color:#b3261e;font-weight:bold}.wide{overflow-x:auto}
.grid td,.grid th{padding:.15em .3em;font-size:.8em;text-align:center;border:1px solid #eee}
.grid th.row{text-align:left;white-space:nowrap}
.grid th.up{writing-mode:vertical-rl;transform:rotate(180deg);font-weight:normal;text-align:left}
.legend span{margin-right:1.5em;font-size:.9em}
.legend i{display:inline-block;width:.9em;height:.9em;margin-right:.4em;vertical-align:-.1em}
"""


def table(header, rows, numbers=()):
    """rows of HTML cells; numbers: columns to align right."""
    def cells(row, tag):
        return "".join(f'<{tag}{" class=n" if k in numbers else ""}>{cell}</{tag}>'
                       for k, cell in enumerate(row))
    lines = [f"<tr>{cells(header, 'th')}</tr>"] + [f"<tr>{cells(row, 'td')}</tr>" for row in rows]
    return "<div class=wide><table>" + "\n".join(lines) + "</table></div>"


def _shade(count, total, right):
    if not count:
        return ""
    colour = "31,111,180" if right else "192,57,43"
    return f' style="background:rgba({colour},{0.15 + 0.6 * count / total:.2f})"'


def _heading(column):
    upright = " class=up" if len(str(column)) > 2 else ""
    return f"<th{upright}>{escape(str(column))}</th>"


def grid(rows, columns, counts, is_right):
    """A heat map of counts ({row: Counter of columns}); blue where named rightly, red where not."""
    html = "<div class=wide><table class=grid><tr><th></th>"
    html += "".join(_heading(column) for column in columns) + "</tr>\n"
    for row in rows:
        total = sum(counts[row].values())
        html += f"<tr><th class=row>{escape(str(row))} ({total})</th>"
        for column in columns:
            count = counts[row][column]
            html += f"<td{_shade(count, total, is_right(row, column))}>{count or ''}</td>"
        html += "</tr>\n"
    return html + "</table></div>"


def number(value):
    return "–" if value is None else f"{value:.3g}"


def paragraph(*sentences):
    return "<p>" + " ".join(sentences) + "</p>\n"
