"""Panels of lines and points over logarithmic or linear axes, as SVG text.

Every colour is an attribute, so that a standalone figure needs no style sheet, and every element has a class, so that a
page can override the colour (dark mode). The palette is safe for colour-blind readers (Okabe and Ito), and each method
has its own marker.
"""
import math
from dataclasses import dataclass, field
from html import escape

INK, SOFT, GRID, AXIS, GROUND = "#222222", "#555f69", "#e4e4e4", "#888888", "#ffffff"


@dataclass(frozen=True)
class Style:
    label: str
    colour: str
    marker: str  # a key of MARKERS
    css: str
    dash: str = ""
    width: float = 2.0


# Outlines about the origin, of about equal area.
MARKERS = {
    "circle": "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z",
    "square": "M-3.6 -3.6h7.2v7.2h-7.2z",
    "triangle": "M0 -4.8L4.6 3.4H-4.6z",
    "triangle_down": "M0 4.8L4.6 -3.4H-4.6z",
    "diamond": "M0 -5.2L5.2 0L0 5.2L-5.2 0z",
    "cross": "M-4 -4L4 4M-4 4L4 -4",
    "plus": "M0 -5V5M-5 0H5",
    "star": "M0 -5V5M-4.4 -2.6L4.4 2.6M-4.4 2.6L4.4 -2.6",
    "bar": "M-1.6 -5h3.2v10h-3.2z",
}
STROKED_MARKERS = {"cross", "plus", "star"}

METHODS = {
    "plain": Style("plain", "#999999", "cross", "m-plain", "4 3"),
    "fast": Style("fast", "#d55e00", "square", "m-fast"),
    "improved": Style("improved", "#e69f00", "diamond", "m-improved"),
    "fast_surface": Style("fast_surface", "#009e73", "triangle", "m-fast_surface"),
    "exact": Style("exact", "#0072b2", "triangle_down", "m-exact"),
    "exact_surface": Style("exact_surface", "#56b4e9", "bar", "m-exact_surface"),
    "hierarchical": Style("hierarchical", "#000000", "circle", "m-hierarchical"),
    "float32_in_world": Style("single precision, in the world", "#cc79a7", "cross", "m-float32", "9 5"),
}
TOLERANCE_MARKERS = ["plus", "cross", "star", "circle"]


def tolerance_style(tolerance, index):
    label = f"hierarchical, tolerance {float(tolerance):.0e}".replace("e-0", "e-")
    return Style(label, "#aa4488", TOLERANCE_MARKERS[index % len(TOLERANCE_MARKERS)], "m-tolerance")


def number(value):
    """Formats a coordinate with a resolution of a tenth of a unit."""
    return f"{round(value, 1) + 0.0:.1f}".removesuffix(".0")


def text(x, y, content, *, css="ink", anchor="start", size=13, weight="", halo=False, rotate=None, colour=INK):
    """content: escaped markup."""
    extra = f' font-weight="{weight}"' if weight else ""
    if halo:  # keeps a label readable on top of a line
        extra += f' paint-order="stroke" stroke="{GROUND}" stroke-width="4" stroke-linejoin="round"'
        css += " halo"
    if rotate is not None:
        extra += f' transform="rotate({rotate} {number(x)} {number(y)})"'
    return (f'<text class="{css}" x="{number(x)}" y="{number(y)}" text-anchor="{anchor}" font-size="{size}" '
            f'fill="{colour}"{extra}>{content}</text>')


def note(x, y, content, *, anchor="middle", size=12, halo=False, rotate=None):
    """Returns text in a softer colour, for ticks, sizes and explanations."""
    return text(x, y, content, css="soft", anchor=anchor, size=size, halo=halo, rotate=rotate, colour=SOFT)


def heading(width, title):
    return text(width / 2, 24, escape(title), anchor="middle", size=17, weight="600")


def grid_line(path):
    return f'<path class="grid" d="{path}" stroke="{GRID}"/>'


def marker(x, y, style, tooltip=""):
    painted = (f'fill="none" stroke="{style.colour}" stroke-width="2"' if style.marker in STROKED_MARKERS
               else f'fill="{style.colour}"')
    kind = "stroked" if style.marker in STROKED_MARKERS else "filled"
    inner = f"<title>{escape(tooltip)}</title>" if tooltip else ""
    return (f'<path class="{style.css} {kind}" transform="translate({number(x)} {number(y)})" '
            f'd="{MARKERS[style.marker]}" {painted}>{inner}</path>')


def line(points, style, width=None, dash=None):
    width = style.width if width is None else width
    dash = style.dash if dash is None else dash
    coordinates = "L".join(f"{number(x)} {number(y)}" for x, y in points)
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    return (f'<path class="{style.css} stroked" d="M{coordinates}" fill="none" stroke="{style.colour}" '
            f'stroke-width="{width}" stroke-linejoin="round"{dashes}/>')


def power_of_ten(exponent):
    sign = "−" if exponent < 0 else ""
    return f'10<tspan dy="-5" font-size="10">{sign}{abs(exponent)}</tspan>'


@dataclass
class Scale:
    low: float
    high: float
    log: bool = False
    every: float = 1.0  # distance of ticks; log: in decades
    plain: bool = False  # log: 0.1, 1, 1,000 instead of powers of ten
    label: str = ""

    def share(self, value):
        """Returns 0 at low, 1 at high; values outside are clamped."""
        if self.log:
            value = math.log10(max(value, self.low))
            low, high = math.log10(self.low), math.log10(self.high)
        else:
            low, high = self.low, self.high
        return min(1.0, max(0.0, (value - low) / (high - low)))

    def ticks(self):
        """Returns pairs of value and markup."""
        if not self.log:
            first = math.ceil(self.low / self.every - 1e-9)
            last = math.floor(self.high / self.every + 1e-9)
            return [(i * self.every, f"{i * self.every:.6g}".replace("-", "−")) for i in range(first, last + 1)]
        first = math.ceil(math.log10(self.low) - 1e-9)
        last = math.floor(math.log10(self.high) + 1e-9)
        exponents = [e for e in range(first, last + 1) if e % int(self.every) == 0]
        return [(10.0**e, f"{10.0**e:,.10g}" if self.plain and e > -5 else power_of_ten(e)) for e in exponents]


@dataclass
class Panel:
    left: float
    top: float
    width: float
    height: float
    x: Scale
    y: Scale | None  # None: no vertical axis
    title: str = ""
    parts: list = field(default_factory=list)

    def __post_init__(self):
        bottom, right = self.top + self.height, self.left + self.width
        for value, label in self.y.ticks() if self.y else []:
            at = self.at_y(value)
            self.parts.append(grid_line(f"M{number(self.left)} {number(at)}H{number(right)}"))
            self.parts.append(note(self.left - 7, at + 4, label, anchor="end"))
        for value, label in self.x.ticks():
            at = self.at_x(value)
            self.parts.append(grid_line(f"M{number(at)} {number(self.top)}V{number(bottom)}"))
            self.parts.append(note(at, bottom + 18, label))
        self.parts.append(f'<path class="axis" d="M{number(self.left)} {number(self.top)}V{number(bottom)}'
                          f'H{number(right)}" fill="none" stroke="{AXIS}"/>')
        middle = self.left + self.width / 2
        if self.title:
            self.parts.append(text(middle, self.top - 10, escape(self.title), anchor="middle", size=14, weight="600"))
        if self.x.label:
            self.parts.append(note(middle, bottom + 38, escape(self.x.label), size=13))
        if self.y and self.y.label:
            across = self.left - 48
            self.parts.append(note(across, self.top + self.height / 2, escape(self.y.label), size=13, rotate=-90))

    def at_x(self, value):
        return self.left + self.width * self.x.share(value)

    def at_y(self, value):
        return self.top + self.height * (1.0 - self.y.share(value))

    def at(self, point):
        return self.at_x(point[0]), self.at_y(point[1])

    def curve(self, points, style, **how):
        if points:
            self.parts.append(line([self.at(p) for p in points], style, **how))


def legend(styles, left, top, width, with_markers):
    """Lays out labels in rows of at most the given width; returns parts and the height used."""
    parts, x, y = [], left, top
    for style in styles:
        needed = 44 + 7.4 * len(style.label)
        if x > left and x + needed > left + width:
            x, y = left, y + 24
        parts.append(line([(x, y), (x + 26, y)], style))
        if with_markers:
            parts.append(marker(x + 13, y, style))
        parts.append(text(x + 33, y + 4.5, escape(style.label)))
        x += needed + 12
    return parts, y - top + 24


@dataclass
class Figure:
    name: str  # file name; part of its ids
    title: str
    description: str  # text alternative
    width: float
    height: float
    parts: list

    def svg(self, attributes="", ground=()):
        """Returns the figure as a part of a page."""
        return "\n".join([
            f'<svg {attributes}viewBox="0 0 {self.width:g} {self.height:g}" role="img" '
            f'aria-labelledby="{self.name}-title {self.name}-desc" font-family="system-ui, \'DejaVu Sans\', sans-serif">',
            f'<title id="{self.name}-title">{escape(self.title)}</title>',
            f'<desc id="{self.name}-desc">{escape(self.description)}</desc>', *ground, *self.parts, "</svg>"
        ])

    def standalone(self):
        """Returns the figure as a file, with a white background."""
        return self.svg(f'xmlns="http://www.w3.org/2000/svg" width="{self.width:g}" height="{self.height:g}" ',
                        [f'<rect width="100%" height="100%" fill="{GROUND}"/>']) + "\n"
