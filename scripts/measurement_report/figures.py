"""The figures of the results page and of the docs, drawn from the rows that the measuring programs write.

Everything in a figure, including its text alternative, is computed from its rows.
"""
import csv
from dataclasses import dataclass

from plot import METHODS, Figure, Panel, Scale, Style, heading, legend, marker, note, text, tolerance_style

METHOD_ORDER = ["fast", "improved", "fast_surface", "exact", "exact_surface", "hierarchical"]
# Lower limit of plotted errors: below the resolution of a double relative to the whole, and 0 has no logarithm.
SMALLEST_ERROR = 1.2e-17


class Unusable(Exception):
    """An input file that the measuring program did not write; the text names the file and the reason."""


def read_rows(path, columns):
    """Returns the rows of a CSV file as dictionaries. columns: the required columns."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            missing = [c for c in columns if c not in (reader.fieldnames or [])]
            rows = list(reader)
    except (OSError, UnicodeDecodeError) as error:
        raise Unusable(f"{path}: {error}") from error
    if missing:
        raise Unusable(f"{path}: no column '{missing[0]}' in its first line; expected the output of the measuring "
                       "program. Another version may have written it; measure again.")
    if not rows or any(None in row or None in row.values() for row in rows):
        raise Unusable(f"{path}: no rows, or incomplete rows. The run may have been interrupted; measure again.")
    return rows


def significant(value, digits=2):
    """Formats a number like the errors in the project's tables: 4.2e-16, 0.00053."""
    return f"{value:.{digits}g}"


def microseconds(ns):
    us = ns / 1000
    return f"{us:.2f}" if us < 10 else f"{us:.1f}" if us < 100 else f"{us:.0f}"


def grouped(count):
    return f"{int(count):,}"


def short_count(triangles):
    if triangles >= 1e6:
        return f"{triangles / 1e6:.0f} M"
    return f"{triangles / 1e3:.1f} k" if triangles < 3e3 else f"{triangles / 1e3:.0f} k"


def largest(rows, key, column):
    """Returns the largest absolute value of a column per key; key(row): a tuple, or None to leave the row out."""
    found = {}
    for row in rows:
        if (at := key(row)) is not None:
            found[at] = max(abs(float(row[column])), found.get(at, 0.0))
    return found


# --- Time against error ----------------------------------------------------------------------------------------------

SPEED_ACCURACY_COLUMNS = ["mesh", "triangles", "method", "tolerance", "target", "regime", "median_ns", "force_error",
                          "torque_error", "bound"]


def best_rows(rows, regime):
    """Returns the first row, that of the best instruction set, per mesh, size, method and tolerance."""
    best = {}
    for row in rows:
        if row["regime"] == regime:
            best.setdefault((row["mesh"], int(row["triangles"]), row["method"], row["tolerance"]), row)
    return best


@dataclass
class Point:
    """Time and error of a method on a mesh, and the bound that was published with the result of a wave load."""
    us: float
    error: float
    triangles: int
    mesh: str
    bound: float | None = None

    def shown(self, smallest=SMALLEST_ERROR):
        return self.us, max(self.error, smallest)

    def tooltip(self, style):
        told = ("" if self.bound is None else f", bound {significant(self.bound)}" if self.bound < float("inf")
                else ", no bound")
        return (f"{style.label}, {self.mesh} of {grouped(self.triangles)} triangles: {microseconds(self.us * 1000)} µs, "
                f"error {significant(self.error)}{told}")


def point_of(row, bound=None):
    return Point(float(row["median_ns"]) / 1000, float(row["force_error"]), int(row["triangles"]), row["mesh"], bound)


def values_of(series, wanted):
    """Describes the points of one mesh."""
    return "; ".join(f"{style.label} {microseconds(p.us * 1000)} µs with an error of {significant(p.error)}"
                     for style, points in series for p in points if wanted(p))


def series(best, meshes):
    """Returns pairs of style and points: the methods, then hierarchical with its tolerances."""
    tolerances = sorted({t for (_, _, m, t) in best if m == "hierarchical" and float(t) > 0}, key=float)
    kinds = [(m, "0", METHODS[m]) for m in ("plain", *METHOD_ORDER)]
    kinds += [("hierarchical", t, tolerance_style(t, i)) for i, t in enumerate(tolerances)]
    made = [(style, [point_of(best[mesh, n, method, tolerance]) for n, mesh in meshes
                     if (mesh, n, method, tolerance) in best]) for method, tolerance, style in kinds]
    return [(style, points) for style, points in made if points]


def name_beside(panel, style, points):
    """Labels a line with its method: left of the first point of the fast ones, above the last point of the others."""
    if style.css == "m-tolerance":
        # At the fastest point at which it has an effect: on small meshes a small tolerance changes nothing.
        active = [point.shown() for point in points if point.error > 1e-12]
        if not active:
            return []
        x, y = panel.at(min(active))
        return [text(x - 10, y + 4, style.label, css=style.css, anchor="end", colour=style.colour, halo=True)]
    if style is METHODS["hierarchical"]:
        x, y = panel.at(points[0].shown())
        return [text(x - 28, y + 4, style.label, css=style.css, anchor="end", weight="600", colour=style.colour,
                     halo=True)]
    # The lines of exact and exact_surface coincide: one label is below, one above.
    x, y = panel.at(points[-1].shown())
    y += 26 if style is METHODS["exact"] else -13
    return [text(x, y, style.label, css=style.css, anchor="middle", colour=style.colour, halo=True)]


def reading_lines(panel, best, meshes):
    """Draws a line at the time of reading each mesh once."""
    floor = panel.top + panel.height
    for n, mesh in meshes:
        if (mesh, n, "read", "0") not in best:
            continue
        at = panel.at_x(float(best[mesh, n, "read", "0"]["median_ns"]) / 1000)
        yield f'<path class="axis" d="M{at:.1f} {floor}V{panel.top}" stroke="#999999" stroke-dasharray="2 5"/>'
        yield note(at - 5, panel.top + 0.6 * panel.height, f"reading {short_count(n)}", size=11, rotate=-90, halo=True)


def speed_accuracy(rows, name="speed_accuracy", scanned=False):
    """scanned: plot the knot and the scanned models instead of the rocks, which are one body at increasing sizes."""
    best = best_rows(rows, "independent")
    meshes = sorted({(n, mesh) for (mesh, n, _, _) in best
                     if (mesh == "rock" if not scanned else not mesh.startswith("rock"))})
    drawn = series(best, meshes)
    if not drawn:
        return None
    times = [point.us for _, points in drawn for point in points]
    times += [float(row["median_ns"]) / 1000 for (mesh, n, method, _), row in best.items()
              if method == "read" and (n, mesh) in meshes]
    # There is space for labels on the left of the fastest points.
    panel = Panel(86, 58, 964, 580,
                  Scale(max(min(times), 0.01) / 20.0, max(times) * 2.0, log=True, plain=True, label="time of one query, µs"),
                  Scale(1e-17, 10, log=True, every=2, label="error of force, relative to the whole"))
    title = ("Time and error of every method on the torus knot and scanned models" if scanned
             else "Time and error of every method on meshes of growing size")
    each = "a point per method and mesh" if scanned else "a line per method, a point per mesh"
    panel.parts += [heading(1080, title),
                    note(540, 43, f"lower left is better; {each}; dotted: reading the mesh once", size=13),
                    *reading_lines(panel, best, meshes)]
    names = []
    for style, points in drawn:
        # Scanned models are different bodies, so that no line connects them.
        if not scanned:
            panel.curve([point.shown() for point in points], style)
        for point in points:
            at_x, at_y = panel.at(point.shown())
            panel.parts.append(marker(at_x, at_y, style, point.tooltip(style)))
            if not scanned and style in (METHODS["hierarchical"], METHODS["improved"]):
                names.append(note(at_x, at_y + 19, short_count(point.triangles), size=11, halo=True))
        names += name_beside(panel, style, points)

    n, mesh = meshes[-1]
    description = ("Median time of one query in microseconds, across, against the largest error of the force relative "
                   f"to the whole displacement, upwards, both logarithmic, for {len(meshes)} meshes of "
                   f"{grouped(meshes[0][0])} to {grouped(n)} triangles. On the {mesh} of {grouped(n)}: "
                   + values_of(drawn, lambda p: (p.triangles, p.mesh) == (n, mesh)) + ".")
    return Figure(name, title, description, 1080, 700, panel.parts + names)


# --- Time against error in waves -------------------------------------------------------------------------------------

WAVE_COLUMNS = ["mesh", "triangles", "pressure", "components", "method", "tolerance", "median_ns", "force_error",
                "force_bound"]
COMPONENTS = 200
# Errors below it are not told apart: 0 has no logarithm.
SMALLEST_WAVE_ERROR = 1e-9
TOLERANCES = {
    "0.01": Style("hierarchical, tolerance 1e-2", "#cc79a7", "diamond", "m-tolerance"),
    "0.001": Style("hierarchical, tolerance 1e-3", "#000000", "circle", "m-hierarchical"),
    "0.0001": Style("hierarchical, tolerance 1e-4", "#d55e00", "square", "m-tolerance"),
}


def wave_table_rows(rows):
    """Returns the rows of one pressure with the tables' number of components."""
    return [r for r in rows if r["pressure"] == "wheeler" and int(r["components"]) == COMPONENTS]


def wave_speed_accuracy(rows):
    drawn = {}
    for row in wave_table_rows(rows):
        style = TOLERANCES.get(row["tolerance"]) if row["method"] == "hierarchical" else METHODS[row["method"]]
        if style:
            drawn.setdefault(style, []).append(point_of(row, float(row["force_bound"])))
    if not drawn:
        return None
    points_of_all = [point for points in drawn.values() for point in points]
    times = [point.us for point in points_of_all]
    panel = Panel(86, 58, 964, 500,
                  Scale(min(times) / 2.0, max(times) * 2.0, log=True, plain=True, label="time of one query, µs"),
                  Scale(SMALLEST_WAVE_ERROR / 10, 1, log=True, label="error of force, relative to the whole"))
    panel.parts += [heading(1080, f"Time and error of the load of {COMPONENTS} waves on meshes of growing size"),
                    note(540, 43, "lower left is better; the bars above the points of hierarchical: its published bound",
                         size=13)]
    names = []
    for style, points in drawn.items():
        # The time of hierarchical hardly grows with the mesh, so that no line connects its points.
        if style in METHODS.values():
            panel.curve([point.shown(SMALLEST_WAVE_ERROR) for point in points], style)
        for point in points:
            at_x, at_y = panel.at(point.shown(SMALLEST_WAVE_ERROR))
            if point.bound < float("inf"):
                top = panel.at_y(point.bound)
                panel.parts.append(f'<path class="{style.css} stroked" d="M{at_x:.1f} {at_y:.1f}V{top:.1f}M{at_x - 5:.1f} '
                                   f'{top:.1f}h10" fill="none" stroke="{style.colour}" stroke-width="1"/>')
            panel.parts.append(marker(at_x, at_y, style, point.tooltip(style)))
            if style in (METHODS["exact_surface"], TOLERANCES["0.001"]):
                names.append(note(at_x, at_y + 19, grouped(point.triangles) if point.triangles < 1000
                                  else short_count(point.triangles), size=11, halo=True))
    below, taken = legend(list(drawn), 86, 616, 960, True)
    smallest, largest_mesh = (of(point.triangles for point in points_of_all) for of in (min, max))
    description = (f"Median time of one query in microseconds, across, against the largest error of the force relative to "
                   f"the whole displacement, upwards, both logarithmic, for {COMPONENTS} wave components on meshes of "
                   f"{grouped(smallest)} to {grouped(largest_mesh)} triangles. On the largest: "
                   + values_of(drawn.items(), lambda p: p.triangles == largest_mesh) + ".")
    return Figure("wave_speed_accuracy", "Time and error of the loads of waves", description, 1080, 616 + taken + 10,
                  panel.parts + names + below)


# --- The paper's figure 4 --------------------------------------------------------------------------------------------

FIGURE4_COLUMNS = ["shape", "triangles", "method", "h", "force", "closed_form", "error_of_whole"]


def figure4_errors(rows):
    """Returns {(shape, triangles): {method: largest error}}."""
    errors = {}
    for (*mesh, method), error in largest(rows, lambda r: (r["shape"], int(r["triangles"]), r["method"]),
                                          "error_of_whole").items():
        errors.setdefault(tuple(mesh), {})[method] = error
    return errors


def paper_figure4(rows):
    measured = {}
    for row in rows:
        measured.setdefault((row["shape"], int(row["triangles"])), {}).setdefault(row["method"], []).append(row)
    closed = Style("closed form of the paper", "#c4c8cc", "circle", "m-closed", width=9.0)
    tops, bottoms = [heading(1080, "Buoyant force on a body lowered into the water, ρg = 1")], []
    for column, (shape, reach) in enumerate((("cube", 0.5), ("sphere", 1.0))):
        first, *others = sorted(n for s, n in measured if s == shape)
        across = Scale(-reach, reach, every=reach / 2, label="height of the centre over the water")
        curves = measured[shape, first]
        forces = [float(r["force"]) for curve in curves.values() for r in curve]
        upwards = Scale(min(0.0, min(forces)), max(forces) * 1.03, every=0.2 if max(forces) < 2 else 1.0, label="force")
        left = 72 + column * 540
        above = Panel(left, 74, 460, 285, across, upwards, f"{shape}, {grouped(first)} triangles")
        above.curve([(float(r["h"]), float(r["closed_form"])) for r in next(iter(curves.values()))], closed)
        for method in METHOD_ORDER:
            above.curve([(float(r["h"]), float(r["force"])) for r in curves.get(method, [])], METHODS[method])
        below = Panel(left, 451, 460, 285, across, Scale(1e-17, 1, log=True, every=4, label="error, relative to the whole"),
                      f"solid: {grouped(first)} triangles" + (f"; dashed: {grouped(others[-1])}" if others else ""))
        for size in (first, *others):
            for method in METHOD_ORDER:
                curve = measured[shape, size].get(method, [])
                points = [(float(r["h"]), max(abs(float(r["error_of_whole"])), SMALLEST_ERROR)) for r in curve]
                below.curve(points, METHODS[method], dash="" if size == first else "5 4", width=1.6)
        tops += above.parts
        bottoms += below.parts
    names, taken = legend([closed] + [METHODS[m] for m in METHOD_ORDER], 72, 822, 980, False)
    values = [f"{shape} of {grouped(n)} triangles: "
              + ", ".join(f"{m} {significant(errors[m])}" for m in METHOD_ORDER if m in errors)
              for (shape, n), errors in figure4_errors(rows).items()]
    return Figure("paper_figure4", "The paper's figure 4, measured: force on a cube and a sphere, and its error",
                  "Above, the force of each method and the paper's closed form over the height of the centre, for a "
                  "cube and a sphere; below, the size of the force's error, logarithmic, on a coarse and a fine mesh. "
                  "Largest errors: " + "; ".join(values) + ".", 1080, 828 + taken, tops + bottoms + names)


# --- Error under stress ----------------------------------------------------------------------------------------------

STRESS_COLUMNS = ["sweep", "x", "method", "error_of_whole"]
# Title, label of the horizontal axis, decades per tick, name in a table.
SWEEPS = {
    "tilt": ("tilt of a box of flat faces", "rad", 3, "tilt, 1e-12 to 1 rad"),
    "level": ("level and position, far up", "m", 3, "level and position, 1 to 1e9 m up"),
    "origin": ("mesh far from its own origin", "m", 2, "mesh 1 to 1e7 m from its origin"),
    "scale": ("size of the body", "m", 3, "size, 1e-6 to 1e6 m"),
    "wet_share": ("submerged fraction; dotted: all of it missed", "of the whole displacement", 3,
                  "submerged fraction, 1e-9 to 1"),
}


def error_under_stress(rows):
    sweeps = {}
    for row in rows:
        points = sweeps.setdefault(row["sweep"], {}).setdefault(row["method"], [])
        points.append((float(row["x"]), float(row["error_of_whole"])))
    unknown = set(sweeps) - set(SWEEPS)
    if unknown:
        raise Unusable(f"unknown sweep '{unknown.pop()}'; known: {', '.join(SWEEPS)}")
    parts = [heading(1180, "Error of the force, relative to the whole displacement")]
    methods = [m for m in METHODS if any(m in of_sweep for of_sweep in sweeps.values())]
    shown = [s for s in SWEEPS if s in sweeps]
    values = []
    for place, sweep in enumerate(shown):
        title, across, decades, _ = SWEEPS[sweep]
        xs = [x for points in sweeps[sweep].values() for x, _ in points]
        low, high = (1e-27, 10.0) if sweep == "wet_share" else (1e-17, 1e9)
        panel = Panel(62 + place % 3 * 388, 74 + place // 3 * 362, 312, 270,
                      Scale(min(xs), max(xs), log=True, every=decades, label=across),
                      Scale(low, high, log=True, every=4), title)
        if sweep == "wet_share":
            missed = Style("", "#999999", "circle", "axis", dash="2 4", width=1.5)
            panel.curve([(x, x) for x in sorted(set(xs))], missed)
        for method in methods:
            points = sorted(sweeps[sweep].get(method, []))
            panel.curve([(x, min(max(error, low * 1.2), high)) for x, error in points], METHODS[method])
        parts += panel.parts
        values.append(f"{title}: " + ", ".join(
            f"{METHODS[m].label} {significant(max(e for _, e in sweeps[sweep][m]))}" for m in methods if m in sweeps[sweep]))
    # The legend takes the place after the last panel.
    left, top = 62 + len(shown) % 3 * 388, 74 + len(shown) // 3 * 362
    names, _ = legend([METHODS[m] for m in methods], left + 20, top + 46, 100, False)
    return Figure("error_under_stress", "Error of every method over tilt, level, the mesh's origin, size and submerged "
                  "fraction",
                  "A panel per kind of stress, both axes logarithmic. Largest errors over each: "
                  + "; ".join(values) + ".", 1180, top + 356, parts + names)


# The figures that have files of their own: what draws each, and the columns that it needs.
DRAWN = {
    "speed_accuracy": (speed_accuracy, SPEED_ACCURACY_COLUMNS),
    "wave_speed_accuracy": (wave_speed_accuracy, WAVE_COLUMNS),
    "paper_figure4": (paper_figure4, FIGURE4_COLUMNS),
    "error_under_stress": (error_under_stress, STRESS_COLUMNS),
}


def draw(kind, source, output):
    """Draws a figure from the rows of a CSV file as SVG."""
    drawn, columns = DRAWN[kind]
    figure = drawn(read_rows(source, columns))
    if figure is None:
        raise Unusable(f"{source}: no rows that the figure shows")
    output.write_text(figure.standalone(), encoding="utf-8")
