"""The figures of the results page and of the docs, drawn with Matplotlib from the rows that the measuring programs write.

Everything in a figure, including its text alternative, is computed from its rows. The palette is safe for colour-blind
readers (Okabe and Ito), and each method has its own marker.
"""
import io
import math
import re
from dataclasses import dataclass
from html import escape

import matplotlib
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from rows import (COLUMNS, METHOD_ORDER, METHODS, SWEEPS, WAVE_COMPONENTS, Unusable, best_rows, figure4_errors, grouped,
                  microseconds, read_rows, short_count, short_tolerance, significant, wave_table_rows)

# The same rows make the same bytes (hashsalt), and text stays text (fonttype).
matplotlib.rcParams.update({
    "svg.hashsalt": "buoyancy", "svg.fonttype": "none", "axes.grid": True, "axes.axisbelow": True, "grid.color": "#e4e4e4",
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#888888", "axes.labelcolor": "#555f69",
    "xtick.color": "#555f69", "ytick.color": "#555f69", "axes.titlesize": "medium", "figure.titleweight": "bold",
    "legend.frameon": False, "figure.constrained_layout.w_pad": 0.1, "figure.constrained_layout.h_pad": 0.08})

STYLES = {
    "plain": {"color": "#999999", "marker": "x", "linestyle": (0, (4, 3))},
    "fast": {"color": "#d55e00", "marker": "s"},
    "improved": {"color": "#e69f00", "marker": "D"},
    "fast_surface": {"color": "#009e73", "marker": "^"},
    "exact": {"color": "#0072b2", "marker": "v"},
    "exact_surface": {"color": "#56b4e9", "marker": "|", "markeredgewidth": 3},
    "hierarchical": {"color": "#000000", "marker": "o"},
    "float32_in_world": {"color": "#cc79a7", "linestyle": (0, (9, 5))},
}
TOLERANCE_MARKERS = ["+", "x", "*", "o"]
WAVE_TOLERANCES = {
    "0.01": {"color": "#cc79a7", "marker": "D"},
    "0.001": {"color": "#000000", "marker": "o"},
    "0.0001": {"color": "#d55e00", "marker": "s"},
}
SIZE_LABEL = {"xytext": (0, -13), "textcoords": "offset points", "ha": "center", "fontsize": 8, "color": "#555f69",
              "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 0.3, "alpha": 0.7}}
# Lower limit of plotted errors: below the resolution of a double relative to the whole, and 0 has no logarithm.
SMALLEST_ERROR = 1.2e-17
# Errors in waves below it are not told apart.
SMALLEST_WAVE_ERROR = 1e-9


class Drawing:
    """A figure with its title, its text alternative, and a tooltip for each of its points."""

    def __init__(self, name, title, width, height, heading=None):
        """name: of its file, and a part of its ids; width and height: in pixels of a page."""
        self.name, self.title, self.description, self.tooltips = name, title, "", []
        self.width, self.height = width, height
        self.canvas = Figure(figsize=(width / 96, height / 96), layout="constrained")
        self.canvas.suptitle(heading or title)

    def point(self, axes, x, y, tooltip, style):
        # Above the labels of sizes (3), which are above the lines (2).
        axes.plot(x, y, **{**style, "linestyle": "none"}, zorder=4, gid=f"point_{len(self.tooltips)}")
        self.tooltips.append(tooltip)

    def svg(self, attributes=""):
        """Returns the figure as a part of a page."""
        file = io.StringIO()
        self.canvas.savefig(file, format="svg", metadata={"Date": None})
        drawn = re.sub(r"<metadata>.*?</metadata>", "", file.getvalue(), flags=re.DOTALL)
        view_box, content = re.search(r"<svg [^>]*(viewBox=\"[^\"]*\")[^>]*>(.*)", drawn, re.DOTALL).groups()
        # The ids are unique in a page with several figures.
        content = re.sub(r'(\bid="|"#|url\(#)', rf"\1{self.name}-", content.replace("xlink:href", "href"))
        content = re.sub(r'<g id="[^"]*-point_(\d+)">',
                         lambda at: f"{at[0]}<title>{escape(self.tooltips[int(at[1])])}</title>", content)
        return (f'<svg {attributes}{view_box} role="img" aria-labelledby="{self.name}-title {self.name}-desc">\n'
                f'<title id="{self.name}-title">{escape(self.title)}</title>\n'
                f'<desc id="{self.name}-desc">{escape(self.description)}</desc>{content.rstrip()}')

    def save(self, path):
        """Writes the figure as a file, .svg or .png."""
        if path.suffix == ".png":
            self.canvas.savefig(path, dpi=192)
            return
        size = f'width="{self.width}" height="{self.height}"'
        path.write_text(self.svg(f'xmlns="http://www.w3.org/2000/svg" {size} ') + "\n", encoding="utf-8")


def set_up(axes, across=None, upwards=None, log="", plain_numbers=False):
    """Labels the axes. log: which of them are logarithmic; plain_numbers: 1,000 instead of a power of ten across."""
    axes.set(xlabel=across, ylabel=upwards)
    for axis in log:
        axes.set(**{f"{axis}scale": "log"})
        getattr(axes, f"{axis}axis").set_minor_locator(NullLocator())
    if plain_numbers:
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.10g}"))


def curve(axes, points, style, **changed):
    """Draws a line without markers."""
    if points:
        axes.plot(*zip(*points), **{**style, "marker": "", **changed})


# --- Time against error ----------------------------------------------------------------------------------------------

@dataclass
class Point:
    """Time and error of a method on a mesh, and the bound that was published with the result of a wave load."""
    us: float
    error: float
    triangles: int
    mesh: str
    bound: float | None = None

    def tooltip(self, label):
        told = ("" if self.bound is None else f", bound {significant(self.bound)}" if self.bound < float("inf")
                else ", no bound")
        return (f"{label}, {self.mesh} of {grouped(self.triangles)} triangles: {microseconds(self.us * 1000)} µs, "
                f"error {significant(self.error)}{told}")


def point_of(row, bound=None):
    return Point(float(row["median_ns"]) / 1000, float(row["force_error"]), int(row["triangles"]), row["mesh"], bound)


def with_tolerance(tolerance):
    return f"hierarchical, tolerance {short_tolerance(tolerance)}"


def describe(series, meshes, wanted):
    """Describes what is drawn, and lists the points of one mesh."""
    sizes = sorted(n for n, _ in meshes)
    values = "; ".join(f"{label} {microseconds(p.us * 1000)} µs with an error of {significant(p.error)}"
                       for label, _, points in series for p in points if (p.triangles, p.mesh) == wanted)
    return ("Median time of one query in microseconds, across, against the largest error of the force relative to the "
            f"whole displacement, upwards, both logarithmic, for {len(meshes)} meshes of {grouped(sizes[0])} to "
            f"{grouped(sizes[-1])} triangles. On the {wanted[1]} of {grouped(wanted[0])}: {values}.")


def time_against_error(drawing, series, smallest, is_connected, names_sizes):
    """Draws each series (label, style, points); returns the axes. is_connected, names_sizes: of a label."""
    axes = drawing.canvas.subplots()
    set_up(axes, "time of one query, µs", "error of force, relative to the whole", "xy", plain_numbers=True)
    for label, style, points in series:
        shown = [(point.us, max(point.error, smallest)) for point in points]
        axes.plot([], [], label=label, **{**style, **({} if is_connected(label) else {"linestyle": "none"})})
        if is_connected(label):
            curve(axes, shown, style)
        for point, (us, error) in zip(points, shown):
            if point.bound is not None and point.bound < float("inf"):
                axes.errorbar(us, error, [[0], [max(point.bound - error, 0)]], fmt="none", ecolor=style["color"],
                              elinewidth=1, capsize=3)
            drawing.point(axes, us, error, point.tooltip(label), style)
            if names_sizes(label):
                axes.annotate(short_count(point.triangles), (us, error), **SIZE_LABEL)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return axes


def speed_accuracy(rows, name="speed_accuracy", scanned=False):
    """scanned: plot the knot and the scanned models instead of the rocks, which are one body at increasing sizes."""
    best = best_rows(rows, "independent")
    meshes = sorted({(n, mesh) for (mesh, n, _, _) in best
                     if (mesh == "rock" if not scanned else not mesh.startswith("rock"))})
    tolerances = sorted({t for (_, _, m, t) in best if m == "hierarchical" and float(t) > 0}, key=float)
    kinds = [(m, "0", m, STYLES[m]) for m in ("plain", *METHOD_ORDER)]
    kinds += [("hierarchical", t, with_tolerance(t),
               {"color": "#aa4488", "marker": TOLERANCE_MARKERS[i % len(TOLERANCE_MARKERS)]})
              for i, t in enumerate(tolerances)]
    series = [(label, style, [point_of(best[mesh, n, method, tolerance]) for n, mesh in meshes
                              if (mesh, n, method, tolerance) in best]) for method, tolerance, label, style in kinds]
    series = [(label, style, points) for label, style, points in series if points]
    if not series:
        return None
    title = ("Time and error of every method on the torus knot and scanned models" if scanned
             else "Time and error of every method on meshes of growing size")
    drawing = Drawing(name, title, 1080, 700)
    # Scanned models are different bodies, so that no line connects them.
    axes = time_against_error(drawing, series, SMALLEST_ERROR, lambda _: not scanned,
                              lambda label: not scanned and label in ("hierarchical", "improved"))
    each = "a point per method and mesh" if scanned else "a line per method, a point per mesh"
    axes.set_title(f"lower left is better; {each}; dotted: reading the mesh once")
    axes.set_ylim(SMALLEST_ERROR / 1.2, 10)
    for n, mesh in meshes:
        if (mesh, n, "read", "0") in best:
            us = float(best[mesh, n, "read", "0"]["median_ns"]) / 1000
            axes.axvline(us, color="#999999", linestyle=":", linewidth=1)
            axes.text(us, 0.4, f"reading {short_count(n)}", transform=axes.get_xaxis_transform(), rotation=90, ha="right",
                      fontsize=8, color="#555f69")
    drawing.description = describe(series, meshes, meshes[-1])
    return drawing


def wave_speed_accuracy(rows):
    series = {}
    for row in wave_table_rows(rows):
        label, style = row["method"], STYLES[row["method"]]
        if label == "hierarchical":
            label, style = with_tolerance(row["tolerance"]), WAVE_TOLERANCES.get(row["tolerance"])
        if style:
            series.setdefault(label, (label, style, []))[2].append(point_of(row, float(row["force_bound"])))
    if not series:
        return None
    drawing = Drawing("wave_speed_accuracy", "Time and error of the loads of waves", 1080, 620,
                      f"Time and error of the load of {WAVE_COMPONENTS} waves on meshes of growing size")
    # The time of hierarchical hardly grows with the mesh, so that no line connects its points.
    axes = time_against_error(drawing, series.values(), SMALLEST_WAVE_ERROR, lambda label: label in METHODS,
                              lambda label: label in ("exact_surface", with_tolerance("0.001")))
    axes.set_title("lower left is better; the bars above the points of hierarchical: its published bound")
    meshes = {(p.triangles, p.mesh) for _, _, points in series.values() for p in points}
    drawing.description = f"A sea of {WAVE_COMPONENTS} components. " + describe(series.values(), meshes, max(meshes))
    return drawing


# --- The paper's figure 4 --------------------------------------------------------------------------------------------

def paper_figure4(rows):
    measured = {}
    for row in rows:
        measured.setdefault((row["shape"], int(row["triangles"])), {}).setdefault(row["method"], []).append(row)
    drawing = Drawing("paper_figure4", "The paper's figure 4, measured: force on a cube and a sphere, and its error", 1080,
                      850, "Buoyant force on a body lowered into the water, ρg = 1")
    for (above, below), shape in zip(drawing.canvas.subplots(2, 2).T, ("cube", "sphere")):
        first, *others = sorted(n for s, n in measured if s == shape)
        curves = measured[shape, first]
        set_up(above, "height of the centre over the water", "force")
        above.set_title(f"{shape}, {grouped(first)} triangles")
        curve(above, [(float(r["h"]), float(r["closed_form"])) for r in next(iter(curves.values()))],
              {"color": "#c4c8cc", "linewidth": 7, "label": "closed form of the paper"})
        set_up(below, "height of the centre over the water", "error, relative to the whole", "y")
        below.set_title(f"solid: {grouped(first)} triangles" + (f"; dashed: {grouped(others[-1])}" if others else ""))
        for method in METHOD_ORDER:
            curve(above, [(float(r["h"]), float(r["force"])) for r in curves.get(method, [])], STYLES[method], label=method)
            for size in (first, *others):
                curve(below, [(float(r["h"]), max(abs(float(r["error_of_whole"])), SMALLEST_ERROR))
                              for r in measured[shape, size].get(method, [])],
                      STYLES[method], linestyle="-" if size == first else "--")
        above.legend(loc="upper right")
    values = [f"{shape} of {grouped(n)} triangles: "
              + ", ".join(f"{m} {significant(errors[m])}" for m in METHOD_ORDER if m in errors)
              for (shape, n), errors in figure4_errors(rows).items()]
    drawing.description = ("Above, the force of each method and the paper's closed form over the height of the centre, for "
                           "a cube and a sphere; below, the size of the force's error, logarithmic, on a coarse and a fine "
                           f"mesh. Largest errors: {'; '.join(values)}.")
    return drawing


# --- Error under stress ----------------------------------------------------------------------------------------------

def error_under_stress(rows):
    sweeps = {}
    for row in rows:
        points = sweeps.setdefault(row["sweep"], {}).setdefault(row["method"], [])
        points.append((float(row["x"]), float(row["error_of_whole"])))
    unknown = set(sweeps) - set(SWEEPS)
    if unknown:
        raise Unusable(f"unknown sweep '{unknown.pop()}'; known: {', '.join(SWEEPS)}")
    drawing = Drawing("error_under_stress", "Error of every method over tilt, level, the mesh's origin, size and submerged "
                      "fraction", 1180, 790, "Error of the force, relative to the whole displacement")
    *panels, legend = drawing.canvas.subplots(2, 3).flat
    values = []
    for panel, sweep in zip(panels, (s for s in SWEEPS if s in sweeps)):
        title, across, _ = SWEEPS[sweep]
        low, high = (1e-27, 10.0) if sweep == "wet_share" else (1e-17, 1e9)
        set_up(panel, across, log="xy")
        panel.set_title(title)
        if sweep == "wet_share":
            xs = sorted({x for points in sweeps[sweep].values() for x, _ in points})
            panel.plot(xs, xs, color="#999999", linestyle=":")
        for method in (m for m in METHODS if m in sweeps[sweep]):
            curve(panel, [(x, min(max(error, low * 1.2), high)) for x, error in sorted(sweeps[sweep][method])],
                  STYLES[method], label=METHODS[method])
        values.append(f"{title}: " + ", ".join(f"{METHODS[m]} {significant(max(e for _, e in sweeps[sweep][m]))}"
                                               for m in METHODS if m in sweeps[sweep]))
    legend.set_axis_off()
    legend.legend(*drawing.canvas.axes[0].get_legend_handles_labels(), loc="center")
    drawing.description = ("A panel per kind of stress, both axes logarithmic. Largest errors over each: "
                           + "; ".join(values) + ".")
    return drawing


# --- A run -----------------------------------------------------------------------------------------------------------

def angles(row, up):
    """Returns roll and pitch in degrees, relative to the upright attitude of a mesh with this up axis."""
    w, x, y, z = (float(row[column]) for column in ("qw", "qx", "qy", "qz"))
    if up == "y":
        # Upright is a rotation by 90 degrees about the mesh's x axis, which is removed first.
        half = math.sqrt(0.5)
        w, x, y, z = half * (w + x), half * (x - w), half * (y + z), half * (z - y)
    return (math.degrees(math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))),
            math.degrees(math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))))


def run(rows, up="z"):
    """Heave, roll, pitch and buoyant force of one body over time."""
    rows = rows[::max(1, len(rows) // 2000)]
    seconds = [float(row["utime"]) * 1e-6 for row in rows]
    drawing = Drawing("run", "Heave, roll, pitch and buoyant force of a body over time", 960, 900)
    heave, angle, force = drawing.canvas.subplots(3, sharex=True)
    set_up(heave, upwards="heave of the mesh's origin (m)")
    heave.plot(seconds, [float(row["pz"]) for row in rows], color="#0072b2")
    set_up(angle, upwards="angle from upright (degrees)")
    for values, name, colour in zip(zip(*(angles(row, up) for row in rows)), ("roll", "pitch"), ("#0072b2", "#d55e00")):
        angle.plot(seconds, values, color=colour, label=name)
    angle.legend(loc="upper right")
    set_up(force, "time (s)", "buoyant force (N)")
    force.plot(seconds, [float(row["fz"]) for row in rows], color="#0072b2")
    drawing.description = (f"Three panels over {seconds[-1]:g} s. At the end the mesh's origin is at {float(rows[-1]['pz']):.3g} m "
                           f"and the buoyant force is {float(rows[-1]['fz']):.4g} N.")
    return drawing


# The figures that have files of their own.
DRAWN = {function.__name__: function
         for function in (speed_accuracy, wave_speed_accuracy, paper_figure4, error_under_stress, run)}


def draw(kind, source, output, *more):
    """Draws a figure from the rows of a CSV file as SVG or PNG."""
    drawing = DRAWN[kind](read_rows(source, COLUMNS[kind]), *more)
    if drawing is None:
        raise Unusable(f"{source}: no rows that the figure shows")
    drawing.save(output)
