"""The figures of the results page and of the docs, drawn from the rows that the measuring programs write.

Each figure has a wide and a narrow form. Everything in a figure, including its text alternative, is computed from its
rows.
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
    """Time and error of a method on a mesh."""
    us: float
    error: float
    triangles: int
    mesh: str

    def shown(self):
        return self.us, max(self.error, SMALLEST_ERROR)


def series(best, meshes):
    """Returns pairs of style and points: the methods, then hierarchical with its tolerances."""
    tolerances = sorted({t for (_, _, m, t) in best if m == "hierarchical" and float(t) > 0}, key=float)
    kinds = [(m, "0", METHODS[m]) for m in ("plain", *METHOD_ORDER)]
    kinds += [("hierarchical", t, tolerance_style(t, i)) for i, t in enumerate(tolerances)]
    made = []
    for method, tolerance, style in kinds:
        points = []
        for n, mesh in meshes:
            row = best.get((mesh, n, method, tolerance))
            if row:
                points.append(Point(float(row["median_ns"]) / 1000, float(row["force_error"]), n, mesh))
        if points:
            made.append((style, points))
    return made


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


def reading_lines(panel, best, meshes, named):
    """Draws a line at the time of reading each mesh once."""
    floor = panel.top + panel.height
    for n, mesh in meshes:
        if (mesh, n, "read", "0") not in best:
            continue
        at = panel.at_x(float(best[mesh, n, "read", "0"]["median_ns"]) / 1000)
        yield f'<path class="axis" d="M{at:.1f} {floor}V{panel.top}" stroke="#999999" stroke-dasharray="2 5"/>'
        if named:
            yield note(at - 5, panel.top + 0.6 * panel.height, f"reading {short_count(n)}", size=11, rotate=-90,
                       halo=True)


def speed_accuracy(rows, wide, name="speed_accuracy", scanned=False):
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
    # Wide: space for labels on the left of the fastest points. Narrow: all labels are below the plot.
    x = Scale(max(min(times), 0.01) / (20.0 if wide else 2.0), max(times) * 2.0, log=True, plain=True,
              label="time of one query, µs")
    y = Scale(1e-17, 10, log=True, every=2 if wide else 4, label="error of force, relative to the whole")
    width, height = (1080, 700) if wide else (420, 508)
    panel = Panel(86, 58, 964, 580, x, y) if wide else Panel(66, 58, 340, 370, x, y)

    title = ("Time and error of every method on the torus knot and scanned models" if scanned
             else "Time and error of every method on meshes of growing size")
    each = "a point per method and mesh; " if scanned else "a line per method, a point per mesh; "
    panel.parts += [heading(width, wide, title, "Time and error of every method"),
                    note(width / 2, 43, f"lower left is better; {each if wide else ''}dotted: reading the mesh once",
                         size=13 if wide else 12)]
    panel.parts += reading_lines(panel, best, meshes, wide)
    names = []
    for style, points in drawn:
        # Scanned models are different bodies, so that no line connects them.
        if not scanned:
            panel.curve([point.shown() for point in points], style)
        for point in points:
            at_x, at_y = panel.at(point.shown())
            panel.parts.append(marker(at_x, at_y, style, f"{style.label}, {point.mesh} of {grouped(point.triangles)} "
                                      f"triangles: {microseconds(point.us * 1000)} µs, "
                                      f"error {significant(point.error)}"))
            if not scanned and style in (METHODS["hierarchical"], METHODS["improved"]):
                names.append(note(at_x, at_y + 19, short_count(point.triangles), size=11, halo=True))
        if wide:
            names += name_beside(panel, style, points)
    if not wide:
        below, taken = legend([style for style, _ in drawn], 16, height, 390, True)
        names += below
        height += taken

    n, mesh = meshes[-1]
    values = [f"{style.label} {microseconds(p.us * 1000)} µs with an error of {significant(p.error)}"
              for style, points in drawn for p in points if (p.triangles, p.mesh) == (n, mesh)]
    description = ("Median time of one query in microseconds, across, against the largest error of the force relative "
                   f"to the whole displacement, upwards, both logarithmic, for {len(meshes)} meshes of "
                   f"{grouped(meshes[0][0])} to {grouped(n)} triangles. On the {mesh} of {grouped(n)}: "
                   + "; ".join(values) + ".")
    return Figure(name, title, description, width, height, panel.parts + names)


# --- The paper's figure 4 --------------------------------------------------------------------------------------------

FIGURE4_COLUMNS = ["shape", "triangles", "method", "h", "force", "closed_form", "error_of_whole"]


def largest_figure4_errors(rows):
    """Returns {(shape, triangles): {method: largest error}}."""
    largest = {}
    for row in rows:
        of_mesh = largest.setdefault((row["shape"], int(row["triangles"])), {})
        error = abs(float(row["error_of_whole"]))
        of_mesh[row["method"]] = max(error, of_mesh.get(row["method"], 0.0))
    return largest


def paper_figure4(rows, wide):
    measured = {}
    for row in rows:
        measured.setdefault((row["shape"], int(row["triangles"]), row["method"]), []).append(row)
    sizes = {shape: sorted({n for (s, n, _) in measured if s == shape}) for shape in ("cube", "sphere")}
    closed = Style("closed form of the paper", "#c4c8cc", "circle", "m-closed", width=9.0)
    columns = 2 if wide else 1
    width = 1080 if wide else 420
    panel_width = 460 if wide else 342
    panel_height = 285 if wide else 250
    parts = [heading(width, wide, "Buoyant force on a body lowered into the water, ρg = 1",
                     "Force on a body lowered, ρg = 1")]
    place = 0

    def next_panel(**scales):
        nonlocal place
        column, row = place % columns, place // columns
        place += 1
        return Panel(72 + column * 540 if wide else 66, 74 + row * (panel_height + 92), panel_width, panel_height,
                     **scales)

    across = {shape: Scale(-reach, reach, every=reach / 2, label="height of the centre over the water")
              for shape, reach in (("cube", 0.5), ("sphere", 1.0))}
    for shape in ("cube", "sphere"):
        coarse = sizes[shape][0]
        curves = {m: measured[shape, coarse, m] for m in METHOD_ORDER if (shape, coarse, m) in measured}
        forces = [float(r["force"]) for rs in curves.values() for r in rs]
        step = 0.2 if max(forces) < 2 else 1.0
        upwards = Scale(min(0.0, min(forces)), max(forces) * 1.03, every=step, label="force")
        panel = next_panel(x=across[shape], y=upwards, title=f"{shape}, {grouped(coarse)} triangles")
        any_curve = next(iter(curves.values()))
        panel.curve([(float(r["h"]), float(r["closed_form"])) for r in any_curve], closed)
        for method, curve in curves.items():
            panel.curve([(float(r["h"]), float(r["force"])) for r in curve], METHODS[method])
        parts += panel.parts
    for shape in ("cube", "sphere"):
        first, *others = sizes[shape]
        subtitle = f"solid: {grouped(first)} triangles" + (f"; dashed: {grouped(others[-1])}" if others else "")
        panel = next_panel(x=across[shape], y=Scale(1e-17, 1, log=True, every=4, label="error, relative to the whole"),
                           title=subtitle)
        for size in sizes[shape]:
            for method in METHOD_ORDER:
                curve = measured.get((shape, size, method), [])
                points = [(float(r["h"]), max(abs(float(r["error_of_whole"])), SMALLEST_ERROR)) for r in curve]
                panel.curve(points, METHODS[method], dash="" if size == first else "5 4", width=1.6)
        parts += panel.parts
    bottom = 74 + (4 // columns) * (panel_height + 92) - 6
    names, taken = legend([closed] + [METHODS[m] for m in METHOD_ORDER], 72 if wide else 16, bottom,
                          width - (100 if wide else 30), False)
    parts += names
    values = []
    for (shape, n), errors in largest_figure4_errors(rows).items():
        values.append(f"{shape} of {grouped(n)} triangles: " + ", ".join(
            f"{m} {significant(errors[m])}" for m in METHOD_ORDER if m in errors))
    return Figure("paper_figure4", "The paper's figure 4, measured: force on a cube and a sphere, and its error",
                  "Above, the force of each method and the paper's closed form over the height of the centre, for a "
                  "cube and a sphere; below, the size of the force's error, logarithmic, on a coarse and a fine mesh. "
                  "Largest errors: " + "; ".join(values) + ".", width, bottom + taken + 6, parts)


# --- Error under stress ----------------------------------------------------------------------------------------------

STRESS_COLUMNS = ["sweep", "x", "method", "error_of_whole"]
# Title, label of the horizontal axis, decades per tick.
SWEEPS = {
    "tilt": ("tilt of a box of flat faces", "rad", 3),
    "level": ("level and position, far up", "m", 3),
    "origin": ("mesh far from its own origin", "m", 2),
    "scale": ("size of the body", "m", 3),
    "wet_share": ("submerged fraction; dotted: all of it missed", "of the whole displacement", 3),
}


def error_under_stress(rows, wide):
    sweeps = {}
    for row in rows:
        points = sweeps.setdefault(row["sweep"], {}).setdefault(row["method"], [])
        points.append((float(row["x"]), float(row["error_of_whole"])))
    unknown = set(sweeps) - set(SWEEPS)
    if unknown:
        raise Unusable(f"unknown sweep '{unknown.pop()}'; known: {', '.join(SWEEPS)}")
    columns = 3 if wide else 1
    width = 1180 if wide else 420
    panel_width, panel_height = (312, 270) if wide else (336, 240)
    parts = [heading(width, wide, "Error of the force, relative to the whole displacement",
                     "Error of force, relative to the whole")]
    methods = [m for m in METHODS if any(m in of_sweep for of_sweep in sweeps.values())]
    shown = [s for s in SWEEPS if s in sweeps]
    values = []
    for place, sweep in enumerate(shown):
        title, across, decades = SWEEPS[sweep]
        xs = [x for points in sweeps[sweep].values() for x, _ in points]
        low, high = (1e-27, 10.0) if sweep == "wet_share" else (1e-17, 1e9)
        column, row = place % columns, place // columns
        panel = Panel(62 + column * 388 if wide else 66, 74 + row * (panel_height + 92), panel_width, panel_height,
                      Scale(min(xs), max(xs), log=True, every=decades, label=across),
                      Scale(low, high, log=True, every=4), title)
        if sweep == "wet_share":
            missed = Style("", "#999999", "circle", "axis", dash="2 4", width=1.5)
            panel.curve([(x, x) for x in sorted(set(xs))], missed)
        for method in methods:
            points = sorted(sweeps[sweep].get(method, []))
            panel.curve([(x, min(max(error, low * 1.2), high)) for x, error in points], METHODS[method])
        parts += panel.parts
        largest = {METHODS[m].label: max(e for _, e in sweeps[sweep][m]) for m in methods if m in sweeps[sweep]}
        values.append(f"{title}: " + ", ".join(f"{label} {significant(error)}" for label, error in largest.items()))
    rows_of_panels = -(-len(shown) // columns)
    bottom = 74 + rows_of_panels * (panel_height + 92) - 6
    if wide and len(shown) % columns:
        # The legend uses the free space of the last row.
        left = 62 + (len(shown) % columns) * 388
        names, _ = legend([METHODS[m] for m in methods], left + 20, bottom - panel_height - 40, 100, False)
        taken = 0
    else:
        names, taken = legend([METHODS[m] for m in methods], 62 if wide else 16, bottom, width - 60, False)
    parts += names
    return Figure("error_under_stress", "Error of every method over tilt, level, the mesh's origin, size and submerged "
                  "fraction",
                  "A panel per kind of stress, both axes logarithmic. Largest errors over each: "
                  + "; ".join(values) + ".", width, bottom + taken + (0 if taken == 0 else 6), parts)


DRAWN = {
    "speed_accuracy": (speed_accuracy, SPEED_ACCURACY_COLUMNS),
    "paper_figure4": (paper_figure4, FIGURE4_COLUMNS),
    "error_under_stress": (error_under_stress, STRESS_COLUMNS),
}
