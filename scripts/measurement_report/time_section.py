"""Time and error: the results of scripts/bench."""
import math

import figures
import markdown
from figures import Unusable, best_rows, grouped, microseconds, significant
from markdown import Table
from parts import card, details, file_of, not_measured, picture, read_text, source_line
from plot import METHODS


# The methods that visit the whole mesh and are exact to rounding.
LINEAR_EXACT = ("plain", "exact", "exact_surface")


def bench_rows(part):
    return figures.read_rows(file_of(part, "speed_accuracy.csv"), figures.SPEED_ACCURACY_COLUMNS)


def accuracy_card(part):
    claim = "Accurate: largest error of the exact methods' force"
    if not part.measured():
        return card(claim, None, "", "", part)
    rows = [r for r in bench_rows(part)
            if r["method"] in ("exact", "exact_surface", "hierarchical") and float(r["tolerance"]) == 0]
    meshes = {(r["mesh"], r["triangles"]) for r in rows}
    targets = {r["target"] for r in rows if r["target"] != "-"}
    worst = max(float(r["force_error"]) for r in rows)
    sizes = sorted(int(n) for _, n in meshes)
    return card(claim, significant(worst), "of the whole",
                f"{len(meshes)} meshes of {grouped(sizes[0])} to {grouped(sizes[-1])} triangles, two kinds of pose "
                f"sequences, {len(targets)} instruction sets; compared with extended precision.", part)


def speed_card(part):
    claim = "Fast: a query of the largest mesh, exact to rounding"
    if not part.measured():
        return card(claim, None, "", "", part)
    best = best_rows(bench_rows(part), "independent")
    triangles, mesh = max((n, mesh) for mesh, n, m, t in best if m == "hierarchical" and "shuffled" not in mesh)
    time = {m: float(best[mesh, triangles, m, "0"]["median_ns"]) for m in ("read", *LINEAR_EXACT, "hierarchical")}
    linear = min(LINEAR_EXACT, key=time.get)
    return card(claim, microseconds(time["hierarchical"]), "µs",
                f"{grouped(triangles)} triangles, median over independent poses, caches warm, one thread. In the same run "
                f"the fastest exact method that visits the whole mesh, {linear}, takes {microseconds(time[linear])} µs, "
                f"{time[linear] / time['hierarchical']:.0f} "
                f"times as long, and reading the mesh once {microseconds(time['read'])} µs.", part)


def time_table(rows):
    best = best_rows(rows, "independent")
    others = [best_rows(rows, regime) for regime in ("coherent", "cold")]
    table = Table(["mesh", "triangles", "method", "tolerance", "instruction set", "time, µs",
                   "time on a trajectory, µs", "caches flushed, µs", "force error", "torque error", "bound"],
                  [False, True, False, True, False] + [True] * 6, [])
    order = ["read", *METHODS]
    for key in sorted(best, key=lambda k: (k[1], k[0], order.index(k[2]), float(k[3]))):
        mesh, triangles, method, tolerance = key
        row = best[key]
        other_times = [microseconds(float(of[key]["median_ns"])) if key in of else "" for of in others]
        errors = [float(row[column]) for column in ("force_error", "torque_error", "bound")]
        table.rows.append([mesh, grouped(triangles), f"`{method}`", tolerance, row["target"],
                           microseconds(float(row["median_ns"])), *other_times,
                           *("" if math.isnan(error) else significant(error) for error in errors)])
    return table


def time_section(part):
    if not part.measured():
        return not_measured(part)
    rows = bench_rows(part)
    made = []
    if figures.speed_accuracy(rows, True):
        made.append(picture(
            lambda wide: figures.speed_accuracy(rows, wide),
            "Rocks of growing size. The accuracy and cost of an approximation grow with the mesh; the cost of "
            "<code>hierarchical</code> grows with the waterline only, and with a tolerance even less."))
    if figures.speed_accuracy(rows, True, scanned=True):
        made.append(picture(lambda wide: figures.speed_accuracy(rows, wide, "speed_accuracy_models", scanned=True),
                            "The same for the torus knot and the available scanned models."))
    if not made:
        raise Unusable(f"{file_of(part, 'speed_accuracy.csv')}: no mesh that a figure shows")
    made.append(details("The numbers: every mesh, method and tolerance",
                        "<p>Medians over independent poses; errors and bounds are the largest, relative to the whole "
                        "displacement, on the processor's best instruction set. <code>plain</code> is the paper's "
                        "exact method as a user would write it, in 40 lines of C++.</p>"
                        + markdown.table_html(time_table(rows), "time and error of every mesh, method and tolerance")))
    made.append(details("The report of the run: goals, growth, instruction sets, the tree, many bodies",
                        markdown.html(read_text(file_of(part, "report.md")), 4)))
    return "\n".join(made) + source_line(part)
