"""Draws curves on logarithmic axes as SVG. Standard library only."""

import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 720, 460
LEFT, RIGHT, TOP, BOTTOM = 70, 190, 40, 56
# Distinct in hue and in lightness (Okabe and Ito, 2008).
COLORS = ["#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#999999"]


class _Axis:
    """Maps numbers to places, whole decades from end to end."""

    def __init__(self, values, start, end):
        self.low = math.floor(math.log10(min(values)) + 1e-9)
        self.high = max(self.low + 1, math.ceil(math.log10(max(values)) - 1e-9))
        self.start, self.end = start, end

    def at(self, value):
        return self.start + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.start)

    def decades(self):
        return [10.0**exponent for exponent in range(self.low, self.high + 1)]

    def between(self):
        """2 to 9 in every decade."""
        return [digit * decade for decade in self.decades()[:-1] for digit in range(2, 10)]


def _label(value):
    for size, unit in ((1e6, " M"), (1e3, " k")):
        if value >= size:
            return f"{value / size:g}{unit}"
    return f"{value:g}"


def log_log_svg(title, x_name, y_name, curves, guide=True):
    """`curves` is a list of (name, [(x, y), ...]), the first one drawn thick. Points that are not positive are left out.

    `guide` draws what is linear in x as a dashed line from the first point of the first curve.
    """
    curves = [(name, [(x, y) for x, y in points if x > 0 and y > 0]) for name, points in curves]
    curves = [(name, points) for name, points in curves if points]
    if not curves:
        raise ValueError("nothing to draw")
    across = _Axis([x for _, points in curves for x, _ in points], LEFT, WIDTH - RIGHT)
    up = _Axis([y for _, points in curves for _, y in points], HEIGHT - BOTTOM, TOP)
    svg = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" '
        'font-family="DejaVu Sans, Helvetica, Arial, sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        f'<text x="{LEFT}" y="22" font-size="15" font-weight="bold">{escape(title)}</text>',
    ]
    svg += _grid(across, up, x_name, y_name)
    entries = [(name, COLORS[k % len(COLORS)], "") for k, (name, _) in enumerate(curves)]
    if guide:
        svg.append(_guide(across, up, curves[0][1][0]))
        entries.append(("linear", "#777777", ' stroke-dasharray="6 4"'))
    for k, (_, points) in reversed(list(enumerate(curves))):
        svg += _curve(across, up, points, COLORS[k % len(COLORS)], 3 if k == 0 else 1.6)
    svg += _legend(entries)
    return "\n".join(svg) + "\n</svg>\n"


def _grid(across, up, x_name, y_name):
    left, right, bottom, top = across.start, across.end, up.start, up.end
    yield '<g stroke-width="1">'
    for shade, xs, ys in (("#eeeeee", across.between(), up.between()), ("#bbbbbb", across.decades(), up.decades())):
        for x in map(across.at, xs):
            yield f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{bottom}" stroke="{shade}"/>'
        for y in map(up.at, ys):
            yield f'<line x1="{left}" y1="{y:.1f}" x2="{right}" y2="{y:.1f}" stroke="{shade}"/>'
    yield "</g>"
    for value in across.decades():
        yield f'<text x="{across.at(value):.1f}" y="{bottom + 18}" text-anchor="middle">{_label(value)}</text>'
    for value in up.decades():
        yield f'<text x="{left - 8}" y="{up.at(value) + 4:.1f}" text-anchor="end">{_label(value)}</text>'
    yield f'<text x="{(left + right) / 2}" y="{bottom + 40}" text-anchor="middle">{escape(x_name)}</text>'
    middle = (top + bottom) / 2
    yield f'<text transform="translate(18 {middle}) rotate(-90)" text-anchor="middle">{escape(y_name)}</text>'


def _guide(across, up, start):
    """From `start` along y = c x until it leaves the frame."""
    x, y = start
    stretch = min(10**across.high / x, 10**up.high / y)
    ends = (across.at(x), up.at(y), across.at(x * stretch), up.at(y * stretch))
    return '<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" '.format(*ends) + (
        'stroke="#777777" stroke-dasharray="6 4"/>'
    )


def _curve(across, up, points, color, width):
    places = [(across.at(x), up.at(y)) for x, y in points]
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
    yield f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}"/>'
    for x, y in places:
        yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{width + 1.2}" fill="{color}"/>'


def _legend(entries):
    x, y = WIDTH - RIGHT + 16, TOP + 10
    for name, color, dashes in entries:
        yield f'<line x1="{x}" y1="{y}" x2="{x + 24}" y2="{y}" stroke="{color}" stroke-width="2.5"{dashes}/>'
        yield f'<text x="{x + 32}" y="{y + 4}">{escape(name)}</text>'
        y += 20
