"""The pictures of the results page and of the docs, from the rows that the measuring programs write.

Each is drawn for a wide page and for a narrow one. What a picture shows is computed from its rows, its text alternative
included.
"""
import csv
import math

from plot import INK, METHODS, SOFT, Figure, Panel, Scale, Style, legend, line, marker, text, tolerance_style

METHOD_ORDER = ["fast", "improved", "fast_surface", "exact", "exact_surface", "hierarchical"]
# A double knows no error of less than this beside the whole; and 0 has no logarithm.
SMALLEST_ERROR = 1.2e-17


class Unusable(Exception):
    """A file that is not what the measuring program writes; its text says which and why."""


def read_rows(path, columns):
    """A CSV file's rows as dictionaries. columns: those that it has to have."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            missing = [c for c in columns if c not in (reader.fieldnames or [])]
            rows = list(reader)
    except (OSError, UnicodeDecodeError) as error:
        raise Unusable(f"{path}: {error}") from error
    if missing:
        raise Unusable(f"{path}: no column '{missing[0]}' in its first line; expected the CSV of scripts/results' own "
                       "measurements. Measure again without --reuse.")
    if not rows or any(None in row or None in row.values() for row in rows):
        raise Unusable(f"{path}: no rows, or rows that end early. Was the run cut short? Measure again without --reuse.")
    return rows


def significant(value, digits=2):
    """As the tables of this project print errors: 4.2e-16, 0.00053."""
    return f"{value:.{digits}g}"


def microseconds(ns):
    us = ns / 1000
    return f"{us:.2f}" if us < 10 else f"{us:.1f}" if us < 100 else f"{us:.0f}"


def grouped(count):
    return f"{int(count):,}"


def short_count(triangles):
    return f"{triangles / 1e3:.1f} k" if triangles < 3e3 else f"{triangles / 1e3:.0f} k" if triangles < 1e6 else f"{triangles / 1e6:.0f} M"


# --- Time against error ----------------------------------------------------------------------------------------------

TIME_AND_ERROR_COLUMNS = ["mesh", "triangles", "method", "tolerance", "target", "regime", "median_ns", "force_error",
                          "torque_error", "bound"]


def best_rows(rows, regime):
    """A row per mesh, size, method and tolerance: the first, which is on the best instruction set."""
    best = {}
    for row in rows:
        if row["regime"] == regime:
            best.setdefault((row["mesh"], int(row["triangles"]), row["method"], row["tolerance"]), row)
    return best


def time_and_error(rows, wide, name="time_and_error", scanned=False):
    """scanned: the knot and the scanned models in place of the rocks, which are one body at growing sizes."""
    best = best_rows(rows, "independent")
    tolerances = sorted({t for (_, _, m, t) in best if m == "hierarchical" and float(t) > 0}, key=float)
    kinds = [("read", "0", None)] + [(m, "0", METHODS[m]) for m in METHOD_ORDER]
    kinds += [("hierarchical", t, tolerance_style(t, i)) for i, t in enumerate(tolerances)]
    meshes = sorted({(n, mesh) for (mesh, n, _, _) in best
                     if (mesh == "rock" if not scanned else not mesh.startswith("rock"))})
    if not meshes:
        return None

    times = [float(best[mesh, n, m, t]["median_ns"]) / 1000 for n, mesh in meshes for m, t, _ in kinds
             if (mesh, n, m, t) in best]
    # On the left of the fastest points stand their names.
    low, high = max(min(times), 0.01) / (20.0 if wide else 2.0), max(times) * 2.0
    width, height = (1080, 700) if wide else (420, 560)
    top = 58
    # Names stand beside the lines where there is room, else under the plot.
    names, taken = ([], 0) if wide else legend([s for _, _, s in kinds[1:]], 16, 508, 390, True)
    panel = Panel(86 if wide else 66, top, width - (116 if wide else 80), (height - top - 62) if wide else 370,
                  Scale(low, high, log=True, plain=True, label="time of one query, µs"),
                  Scale(1e-17, 10, log=True, every=2 if wide else 4, label="error of force, relative to the whole"))
    parts = panel.parts
    title = ("Time and error of every method on the torus knot and scanned models" if scanned
             else "Time and error of every method on meshes of growing size")
    parts.append(text(width / 2, 22, title if wide else "Time and error of every method", anchor="middle",
                      size=17 if wide else 15, weight="600"))
    each = "a point per method and mesh" if scanned else "a line per method, a point per mesh"
    parts.append(text(width / 2, 42, f"lower left is better; {each}; dotted: reading the mesh once"
                      if wide else "lower left is better; dotted: reading a mesh once", css="soft", anchor="middle",
                      size=13 if wide else 12, colour=SOFT))
    for n, mesh in meshes:
        row = best.get((mesh, n, "read", "0"))
        if row is None:
            continue
        at = panel.at_x(float(row["median_ns"]) / 1000)
        floor = panel.top + panel.height
        parts.append(f'<path class="axis stroked" d="M{at:.1f} {floor}V{panel.top}" stroke="#999999" stroke-dasharray="2 5"/>')
        if wide:
            parts.append(text(at - 5, panel.top + 0.6 * panel.height, f"reading {short_count(n)}", css="soft", anchor="middle", size=11,
                              rotate=-90, colour=SOFT, halo=True))
    labels = []
    for method, tolerance, style in kinds[1:]:
        points, active = [], []
        for n, mesh in meshes:
            row = best.get((mesh, n, method, tolerance))
            if row is None:
                continue
            us, error = float(row["median_ns"]) / 1000, float(row["force_error"])
            points.append((us, max(error, SMALLEST_ERROR), n, mesh, error))
            if tolerance == "0" or error > 1e-12:
                active.append(points[-1])
        if not points:
            continue
        # Scanned models are not one body: no line joins what does not grow into each other.
        if not scanned:
            panel.curve([p[:2] for p in points], style)
        for us, shown, n, mesh, error in points:
            x, y = panel.at((us, shown))
            parts.append(marker(x, y, style, f"{style.label}, {mesh} of {grouped(n)} triangles: "
                                f"{microseconds(us * 1000)} µs, error {significant(error)}"))
        if tolerance == "0" and method in ("hierarchical", "improved") and not scanned:
            for us, shown, n, *_ in points:
                x, y = panel.at((us, shown))
                labels.append(text(x, y + 19, short_count(n), css="soft", anchor="middle", size=11, colour=SOFT, halo=True))
        if not wide:
            continue
        if tolerance != "0":
            if active:
                x, y = panel.at(min(active)[:2])
                labels.append(text(x - 10, y + 4, style.label, css=style.css, anchor="end", colour=style.colour, halo=True))
        elif method == "hierarchical":
            x, y = panel.at(points[0][:2])
            labels.append(text(x - 22, y + 4, style.label, css=style.css, anchor="end", weight="600",
                               colour=style.colour, halo=True))
        else:
            # exact and exact_surface lie on each other: one is named below, one above.
            x, y = panel.at(points[-1][:2])
            labels.append(text(x, y + (26 if method == "exact" else -13), style.label, css=style.css, anchor="middle",
                               colour=style.colour, halo=True))
    parts += labels + names

    largest, mesh = meshes[-1]
    said = [f"{s.label} {microseconds(float(best[mesh, largest, m, t]['median_ns']))} µs with an error of "
            f"{significant(float(best[mesh, largest, m, t]['force_error']))}"
            for m, t, s in kinds[1:] if (mesh, largest, m, t) in best]
    description = (f"Median time of one query in microseconds, across, against the largest error of the force relative to the whole "
                   f"displacement, upwards, both logarithmic, for {len(meshes)} meshes of {grouped(meshes[0][0])} to "
                   f"{grouped(largest)} triangles. On the {mesh} of {grouped(largest)}: " + "; ".join(said) + ".")
    return Figure(name, title, description, width, height if wide else 508 + taken, parts)


# --- The paper's figure 4 --------------------------------------------------------------------------------------------

FIGURE4_COLUMNS = ["shape", "triangles", "method", "h", "force", "closed_form", "error_of_whole"]


def largest_figure4_errors(rows):
    """By (shape, triangles), by method."""
    largest = {}
    for row in rows:
        of_mesh = largest.setdefault((row["shape"], int(row["triangles"])), {})
        error = abs(float(row["error_of_whole"]))
        of_mesh[row["method"]] = max(error, of_mesh.get(row["method"], 0.0))
    return largest


def paper_figure4(rows, wide):
    series = {}
    for row in rows:
        series.setdefault((row["shape"], int(row["triangles"]), row["method"]), []).append(row)
    sizes = {shape: sorted({n for (s, n, _) in series if s == shape}) for shape in ("cube", "sphere")}
    closed = Style("closed form of the paper", "#c4c8cc", "circle", "m-closed", width=9.0)
    columns = 2 if wide else 1
    width = 1080 if wide else 420
    panel_width = 430 if wide else 342
    panel_height = 285 if wide else 250
    parts = [text(width / 2, 24, "Buoyant force on a body lowered into the water, ρg = 1" if wide else "Force on a body lowered, ρg = 1",
                  anchor="middle", size=17 if wide else 15, weight="600")]
    place = 0

    def next_panel(**scales):
        nonlocal place
        column, row = place % columns, place // columns
        place += 1
        return Panel(72 + column * 540 if wide else 66, 74 + row * (panel_height + 92), panel_width + (30 if wide else 0),
                     panel_height, **scales)

    reach = {"cube": (0.5, 0.25), "sphere": (1.0, 0.5)}
    for shape in ("cube", "sphere"):
        coarse = sizes[shape][0]
        curves = {m: series[shape, coarse, m] for m in METHOD_ORDER if (shape, coarse, m) in series}
        forces = [float(r["force"]) for rs in curves.values() for r in rs]
        step = 0.2 if max(forces) < 2 else 1.0
        panel = next_panel(x=Scale(-reach[shape][0], reach[shape][0], every=reach[shape][1], label="height of the centre over the water"),
                           y=Scale(min(0.0, min(forces)), max(forces) * 1.03, every=step, label="force"),
                           title=f"{shape}, {grouped(coarse)} triangles")
        any_curve = next(iter(curves.values()))
        panel.curve([(float(r["h"]), float(r["closed_form"])) for r in any_curve], closed)
        for method, curve in curves.items():
            panel.curve([(float(r["h"]), float(r["force"])) for r in curve], METHODS[method])
        parts += panel.parts
    for shape in ("cube", "sphere"):
        first, *others = sizes[shape]
        subtitle = f"solid: {grouped(first)} triangles" + (f"; dashed: {grouped(others[-1])}" if others else "")
        panel = next_panel(x=Scale(-reach[shape][0], reach[shape][0], every=reach[shape][1], label="height of the centre over the water"),
                           y=Scale(1e-17, 1, log=True, every=4, label="error, relative to the whole"), title=subtitle)
        for size in sizes[shape]:
            for method in METHOD_ORDER:
                curve = series.get((shape, size, method), [])
                panel.curve([(float(r["h"]), max(abs(float(r["error_of_whole"])), SMALLEST_ERROR)) for r in curve],
                            METHODS[method], dash="" if size == first else "5 4", width=1.6)
        parts += panel.parts
    bottom = 74 + (4 // columns) * (panel_height + 92) - 6
    names, taken = legend([closed] + [METHODS[m] for m in METHOD_ORDER], 72 if wide else 16, bottom, width - (100 if wide else 30), False)
    parts += names
    said = []
    for (shape, n), errors in largest_figure4_errors(rows).items():
        said.append(f"{shape} of {grouped(n)} triangles: " + ", ".join(
            f"{m} {significant(errors[m])}" for m in METHOD_ORDER if m in errors))
    return Figure("paper_figure4", "The paper's figure 4, measured: force on a cube and a sphere, and its error",
                  "Above, the force of each method and the paper's closed form over the height of the centre, for a cube and a "
                  "sphere; below, the size of the force's error, logarithmic, on a coarse and a fine mesh. Largest errors: "
                  + "; ".join(said) + ".", width, bottom + taken + 6, parts)


# --- Error under stress ----------------------------------------------------------------------------------------------

STRESS_COLUMNS = ["sweep", "x", "method", "error_of_whole"]
# Title, what is across, decades from tick to tick.
SWEEPS = {
    "tilt": ("tilt of a box of flat faces", "rad", 3),
    "level": ("level and position, far up", "m", 3),
    "origin": ("mesh far from its own origin", "m", 2),
    "scale": ("size of the body", "m", 3),
    "wet_share": ("share that is wet; dotted: all of it missed", "of the whole displacement", 3),
}


def error_under_stress(rows, wide):
    sweeps = {}
    for row in rows:
        sweeps.setdefault(row["sweep"], {}).setdefault(row["method"], []).append((float(row["x"]), float(row["error_of_whole"])))
    unknown = set(sweeps) - set(SWEEPS)
    if unknown:
        raise Unusable(f"a sweep called '{unknown.pop()}', which no picture is drawn of; known: {', '.join(SWEEPS)}")
    columns = 3 if wide else 1
    width = 1180 if wide else 420
    panel_width, panel_height = (312, 270) if wide else (336, 240)
    parts = [text(width / 2, 24, "Error of the force, relative to the whole displacement" if wide else "Error of force, relative to the whole",
                  anchor="middle", size=17 if wide else 15, weight="600")]
    methods = [m for m in METHODS if any(m in of_sweep for of_sweep in sweeps.values())]
    shown = [s for s in SWEEPS if s in sweeps]
    said = []
    for place, sweep in enumerate(shown):
        title, across, decades = SWEEPS[sweep]
        xs = [x for points in sweeps[sweep].values() for x, _ in points]
        low, high = (1e-27, 10.0) if sweep == "wet_share" else (1e-17, 1e9)
        panel = Panel((62 + (place % columns) * 388) if wide else 66, 74 + (place // columns) * (panel_height + 92), panel_width,
                      panel_height, Scale(min(xs), max(xs), log=True, every=decades, label=across),
                      Scale(low, high, log=True, every=4), title)
        if sweep == "wet_share":
            panel.curve([(x, x) for x in sorted(set(xs))], Style("", "#999999", "circle", "axis"), width=1.5, dash="2 4")
        for method in methods:
            points = sorted(sweeps[sweep].get(method, []))
            panel.curve([(x, min(max(error, low * 1.2), high)) for x, error in points], METHODS[method])
        parts += panel.parts
        said.append(f"{title}: " + ", ".join(
            f"{METHODS[m].label} {significant(max(e for _, e in sweeps[sweep][m]))}" for m in methods if m in sweeps[sweep]))
    rows_of_panels = -(-len(shown) // columns)
    bottom = 74 + rows_of_panels * (panel_height + 92) - 6
    if wide and len(shown) % columns:
        # The free place of the last row holds the names.
        left = 62 + (len(shown) % columns) * 388
        names, _ = legend([METHODS[m] for m in methods], left + 20, bottom - panel_height - 40, 100, False)
        taken = 0
    else:
        names, taken = legend([METHODS[m] for m in methods], 62 if wide else 16, bottom, width - 60, False)
    parts += names
    return Figure("error_under_stress", "Error of every method over tilt, level, the mesh's origin, size and wet share",
                  "A panel per kind of stress, both axes logarithmic. Largest errors over each: " + "; ".join(said) + ".", width,
                  bottom + taken + (0 if taken == 0 else 6), parts)


DRAWN = {
    "time_and_error": (time_and_error, TIME_AND_ERROR_COLUMNS),
    "paper_figure4": (paper_figure4, FIGURE4_COLUMNS),
    "error_under_stress": (error_under_stress, STRESS_COLUMNS),
}
