"""Pictures as SVG: axes with ticks and units, points, lines; so that a report needs no tool."""

import math
from html import escape

LEFT, RIGHT, TOP, BOTTOM = 70, 20, 16, 48  # px around the axes
GREY, INK = "#d9d9d9", "#333"


def _step(span, most):
    """A round step (1, 2 or 5 times a power of ten) that makes at most so many intervals."""
    rough = max(span, 1e-300) / most
    power = 10.0 ** math.floor(math.log10(rough))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= rough * (1 - 1e-9))


def linear_ticks(low, high, most=8):
    step = _step(high - low, most)
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def decades(low, high):
    """Powers of ten, with twos and fives between them where there are few."""
    factors = (1, 2, 5) if math.log10(high / low) < 2.5 else (1,)
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    ticks = [factor * 10.0**power for power in powers for factor in factors]
    return [tick for tick in ticks if low * (1 - 1e-9) <= tick <= high * (1 + 1e-9)]


class Plot:
    """One pair of axes; everything in the data's units."""

    def __init__(self, x, y, labels, size=(760, 300), log=(False, False), ticks=None):
        """x, y: (low, high); labels: of x and y, with units; ticks: {text: x}, else numbers."""
        self._range = (x, y)
        self._log = log
        self._width, self._height = size
        self._parts = []
        self._frame(labels, ticks)

    def _share(self, value, axis):
        low, high = self._range[axis]
        if self._log[axis]:
            value, low, high = (math.log10(max(each, 1e-300)) for each in (value, low, high))
        return min(1.02, max(-0.02, (value - low) / ((high - low) or 1.0)))

    def _x(self, value):
        return LEFT + self._share(value, 0) * (self._width - LEFT - RIGHT)

    def _y(self, value):
        return self._height - BOTTOM - self._share(value, 1) * (self._height - TOP - BOTTOM)

    def _ticks(self, axis):
        low, high = self._range[axis]
        return decades(low, high) if self._log[axis] else linear_ticks(low, high)

    def _frame(self, labels, named):
        right, bottom = self._width - RIGHT, self._height - BOTTOM
        xs = named or {f"{tick:.6g}": tick for tick in self._ticks(0)}
        for text, tick in xs.items():
            x = self._x(tick)
            if not named:
                self._parts.append(f'<path d="M{x:.1f} {TOP}V{bottom}" stroke="{GREY}"/>')
            self._text(x, bottom + 16, text, "middle")
        for tick in self._ticks(1):
            y = self._y(tick)
            self._parts.append(f'<path d="M{LEFT} {y:.1f}H{right}" stroke="{GREY}"/>')
            self._text(LEFT - 6, y + 4, f"{tick:.6g}", "end")
        self._parts.append(f'<path d="M{LEFT} {TOP}V{bottom}H{right}" stroke="{INK}" fill="none"/>')
        self._text((LEFT + right) / 2, self._height - 10, labels[0], "middle")
        middle = (TOP + bottom) / 2
        self._parts.append(f'<text transform="translate(16 {middle:.0f}) rotate(-90)" '
                           f'text-anchor="middle">{escape(labels[1])}</text>')

    def _text(self, x, y, text, anchor):
        self._parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">'
                           f"{escape(text)}</text>")

    def line(self, points, colour, width=1.2, dashes=""):
        """points: (x, y) pairs, joined."""
        path = "L".join(f"{self._x(x):.1f} {self._y(y):.1f}" for x, y in points)
        if path:
            dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
            self._parts.append(f'<path d="M{path}" stroke="{colour}" stroke-width="{width}" '
                               f'fill="none"{dashed}/>')

    def level(self, y, colour, dashes="5 4"):
        self.line([(self._range[0][0], y), (self._range[0][1], y)], colour, 1.2, dashes)

    def points(self, points, colour, radius=3.0, names=None):
        """names: shown when the pointer rests on a point."""
        for k, (x, y) in enumerate(points):
            name = f"<title>{escape(names[k])}</title>" if names else ""
            self._parts.append(f'<circle cx="{self._x(x):.1f}" cy="{self._y(y):.1f}" r="{radius}" '
                               f'fill="{colour}" fill-opacity="0.75">{name}</circle>')

    def svg(self):
        return (f'<svg viewBox="0 0 {self._width} {self._height}" width="{self._width}" '
                f'role="img" font-family="sans-serif" font-size="12" fill="{INK}">'
                + "".join(self._parts) + "</svg>")


def legend(entries):
    """HTML for {text: colour}, to stand above a picture."""
    return '<p class="legend">' + "".join(
        f'<span><i style="background:{colour}"></i>{escape(text)}</span>'
        for text, colour in entries.items()) + "</p>"
