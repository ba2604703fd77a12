"""Line charts as SVG, with nothing but the standard library."""
import math
from xml.sax.saxutils import escape

COLORS = ("#1f6fb4", "#d1495b", "#2e8b57", "#8a5cb8", "#c98a1b", "#4d4d4d", "#17a2a2")
WIDTH, HEIGHT = 640, 400
LEFT, RIGHT, TOP, BOTTOM = 64, 16, 36, 48


class Axis:
    """Maps values to pixels. `log` axes show 0 at their lower end, below the least positive value."""

    def __init__(self, values, low_pixel, high_pixel, log):
        self.log = log
        self.low_pixel, self.high_pixel = low_pixel, high_pixel
        positive = [v for v in values if v > 0] or [1]
        self.zero = log and any(v <= 0 for v in values)
        if log:
            self.low = math.floor(math.log10(min(positive))) - (1 if self.zero else 0)
            self.high = max(math.ceil(math.log10(max(positive))), self.low + 1)
        else:
            step = 10 ** math.floor(math.log10(max(positive)))
            self.low, self.high = 0, step * math.ceil(max(positive) / step)

    def __call__(self, value):
        if self.log:
            value = math.log10(value) if value > 0 else self.low
        share = (value - self.low) / (self.high - self.low)
        return self.low_pixel + share * (self.high_pixel - self.low_pixel)

    def ticks(self):
        if not self.log:
            return [(k * self.high / 5, f"{k * self.high / 5:g}") for k in range(6)]
        ticks = [(10.0**k, f"{10.0**k:g}") for k in range(self.low, self.high + 1)]
        if self.zero:
            ticks[0] = (0, "0")
        return ticks


def line_chart(title, x_label, y_label, series, log_x=False, log_y=False):
    """The SVG text; `series` is a list of (name, [(x, y), ...])."""
    points = [p for _, line in series for p in line]
    x = Axis([p[0] for p in points], LEFT, WIDTH - RIGHT, log_x)
    y = Axis([p[1] for p in points], HEIGHT - BOTTOM, TOP, log_y)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
           f'width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="12">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
           f'<text x="{WIDTH / 2}" y="20" text-anchor="middle" font-size="14">{escape(title)}</text>']
    for value, label in x.ticks():
        out.append(f'<line x1="{x(value):.1f}" x2="{x(value):.1f}" y1="{TOP}" '
                   f'y2="{HEIGHT - BOTTOM}" stroke="#ddd"/>')
        out.append(f'<text x="{x(value):.1f}" y="{HEIGHT - BOTTOM + 16}" '
                   f'text-anchor="middle">{label}</text>')
    for value, label in y.ticks():
        out.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y(value):.1f}" '
                   f'y2="{y(value):.1f}" stroke="#ddd"/>')
        out.append(f'<text x="{LEFT - 6}" y="{y(value) + 4:.1f}" text-anchor="end">{label}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" '
               f'text-anchor="middle">{escape(x_label)}</text>')
    out.append(f'<text x="16" y="{HEIGHT / 2}" text-anchor="middle" '
               f'transform="rotate(-90 16 {HEIGHT / 2})">{escape(y_label)}</text>')
    for k, (name, line) in enumerate(series):
        color = COLORS[k % len(COLORS)]
        path = " ".join(f"{x(a):.1f},{y(b):.1f}" for a, b in line)
        out.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.8"/>')
        if len(line) <= 20:
            out += [f'<circle cx="{x(a):.1f}" cy="{y(b):.1f}" r="3" fill="{color}"/>'
                    for a, b in line]
        out.append(f'<rect x="{WIDTH - RIGHT - 190}" y="{TOP + 8 + 18 * k}" width="14" height="4" '
                   f'fill="{color}"/>')
        out.append(f'<text x="{WIDTH - RIGHT - 170}" y="{TOP + 14 + 18 * k}">{escape(name)}</text>')
    return "\n".join(out + ["</svg>"]) + "\n"
