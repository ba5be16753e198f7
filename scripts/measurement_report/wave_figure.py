"""The figure of time against error of the loads of waves, from the rows of scripts/bench --waves."""
from figures import Point, grouped, microseconds, short_count, significant
from plot import METHODS, Figure, Panel, Scale, Style, heading, legend, marker, note

WAVE_COLUMNS = ["mesh", "triangles", "pressure", "components", "method", "tolerance", "median_ns", "force_error",
                "force_bound"]
COMPONENTS = 200
# Errors below it are not told apart: 0 has no logarithm.
SMALLEST_ERROR = 1e-9

HIERARCHICAL = {
    "0.01": Style("hierarchical, tolerance 1e-2", "#cc79a7", "diamond", "m-tolerance"),
    "0.001": Style("hierarchical, tolerance 1e-3", "#000000", "circle", "m-hierarchical"),
    "0.0001": Style("hierarchical, tolerance 1e-4", "#d55e00", "square", "m-tolerance"),
}


def style_of(row):
    return HIERARCHICAL.get(row["tolerance"]) if row["method"] == "hierarchical" else METHODS[row["method"]]


def table_rows(rows, pressure="wheeler"):
    """Returns the rows of one pressure with the tables' number of components."""
    return [r for r in rows if r["pressure"] == pressure and int(r["components"]) == COMPONENTS]


def wave_speed_accuracy(rows, wide):
    drawn = [r for r in table_rows(rows) if style_of(r)]
    if not drawn:
        return None
    series = {}
    for row in drawn:
        point = Point(float(row["median_ns"]) / 1000, float(row["force_error"]), int(row["triangles"]), row["mesh"])
        series.setdefault(style_of(row), []).append((point, float(row["force_bound"])))
    times = [float(r["median_ns"]) / 1000 for r in drawn]
    x = Scale(min(times) / 2.0, max(times) * 2.0, log=True, plain=True, label="time of one query, µs")
    y = Scale(SMALLEST_ERROR / 10, 1, log=True, every=1 if wide else 2, label="error of force, relative to the whole")
    width, height = (1080, 650) if wide else (420, 508)
    panel = Panel(86, 58, 964, 500, x, y) if wide else Panel(66, 58, 340, 370, x, y)
    panel.parts += [heading(width, wide, f"Time and error of the load of {COMPONENTS} waves on meshes of growing size",
                            f"Time and error, {COMPONENTS} waves"),
                    note(width / 2, 43, "lower left is better; the bars above the points of hierarchical: its published "
                         "bound" if wide else "lower left is better; bars: published bound", size=13 if wide else 12)]
    names = []
    for style, points in series.items():
        # The time of hierarchical hardly grows with the mesh, so that no line connects its points.
        if style in METHODS.values():
            panel.curve([(p.us, max(p.error, SMALLEST_ERROR)) for p, _ in points], style)
        for point, bound in points:
            at_x, at_y = panel.at((point.us, max(point.error, SMALLEST_ERROR)))
            told = f", bound {significant(bound)}" if bound < float("inf") else ", no bound"
            if bound < float("inf"):
                top = panel.at_y(bound)
                panel.parts.append(f'<path class="{style.css} stroked" d="M{at_x:.1f} {at_y:.1f}V{top:.1f}M{at_x - 5:.1f} '
                                   f'{top:.1f}h10" fill="none" stroke="{style.colour}" stroke-width="1"/>')
            panel.parts.append(marker(at_x, at_y, style, f"{style.label}, {point.mesh} of {grouped(point.triangles)} "
                                      f"triangles: {microseconds(point.us * 1000)} µs, "
                                      f"error {significant(point.error)}{told}"))
            if style in (METHODS["exact_surface"], HIERARCHICAL["0.001"]):
                names.append(note(at_x, at_y + 19, grouped(point.triangles) if point.triangles < 1000
                                  else short_count(point.triangles), size=11, halo=True))
    below, taken = legend(list(series), 86 if wide else 16, height - 34 if wide else height - 20, width - 120, True)
    largest = max(point.triangles for points in series.values() for point, _ in points)
    values = [f"{style.label} {microseconds(p.us * 1000)} µs with an error of {significant(p.error)}"
              for style, points in series.items() for p, _ in points if p.triangles == largest]
    description = (f"Median time of one query in microseconds, across, against the largest error of the force relative to "
                   f"the whole displacement, upwards, both logarithmic, for {COMPONENTS} wave components on meshes of "
                   f"{grouped(min(p.triangles for points in series.values() for p, _ in points))} to {grouped(largest)} "
                   f"triangles. On the largest: " + "; ".join(values) + ".")
    return Figure("wave_speed_accuracy", "Time and error of the loads of waves", description, width,
                  height - 34 + taken + (10 if wide else 24), panel.parts + names + below)


DRAWN = {"wave_speed_accuracy": (wave_speed_accuracy, WAVE_COLUMNS)}
