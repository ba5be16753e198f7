"""The paper's figure 4 and table 1 next to the results here."""
import math
from pathlib import Path
from typing import NamedTuple

from figures import SIZE_LABEL, STYLES, Drawing, set_up
from rows import METHOD_ORDER, figure4_errors, grouped, read_rows, significant
from tables import Table

NUMBERS = Path(__file__).resolve().parents[2] / "bench" / "paper_numbers.csv"


class Compared(NamedTuple):
    """A model and method that the paper and this run measured; hierarchical has no time of the paper."""
    model: str
    triangles: int
    method: str
    paper_ms: float | None
    us: float
    error: str


def rows(place=None):
    numbers = read_rows(NUMBERS, ["place", "quantity", "model", "triangles", "method", "value", "unit"])
    return [r for r in numbers if place in (None, r["place"])]


def compared(part):
    paper = {(r["model"], int(r["triangles"]), r["method"]): float(r["value"]) for r in rows("table 1")}
    ours = part.table("table1.md", "model").dictionaries()
    measured = {(r["model"], int(r["triangles"]), r["method"]): r for r in ours}
    found = [(*of_model, method) for of_model in dict.fromkeys((m, n) for m, n, _ in paper) for method in METHOD_ORDER]
    return [Compared(*key, paper.get(key), float(measured[key]["processor time, us"]), measured[key]["force error"])
            for key in found if key in measured]


def claim(part):
    exact = [c for c in compared(part) if c.method in ("exact", "hierarchical")]
    if not exact:
        return None
    largest = max(c.triangles for c in exact)
    exact, ours = ([c for c in exact if (c.triangles, c.method) == (largest, method)][0]
                   for method in ("exact", "hierarchical"))
    return (f"{exact.paper_ms * 1000 / ours.us:.0f}", "times faster",
            f"{exact.model}, {grouped(largest)} triangles: {exact.paper_ms:g} ms in the paper, "
            f"{ours.us:g} µs here with hierarchical, {exact.us:g} µs with the paper's "
            "algorithm. The ratio includes another processor and another language.")


def findings(of_figure4):
    """Compares the findings of section 5 of the paper with the results here."""
    of_paper = {(r["model"], int(r["triangles"])) for r in rows("section 5")}
    largest = {mesh: errors for mesh, errors in figure4_errors(of_figure4).items() if mesh in of_paper}
    exact = [("exact to rounding", method, lambda coarse, fine: max(coarse, fine) < 1e-12)
             for method in ("exact", "exact_surface")]
    approximate = [("a finer mesh reduces the error", "improved", lambda coarse, fine: fine < coarse / 2),
                   ("a finer mesh does not reduce the error", "fast", lambda coarse, fine: fine > coarse / 2)]
    made = []
    # A sphere's mesh is inscribed, so that the error of the mesh dominates.
    for shape, expected in (("cube", exact + approximate), ("sphere", approximate)):
        sizes = sorted(n for s, n in largest if s == shape)
        for finding, method, agrees in expected if len(sizes) > 1 else []:
            coarse, fine = largest[shape, sizes[0]][method], largest[shape, sizes[-1]][method]
            made.append([finding, f"{shape}, `{method}`", significant(coarse), significant(fine), f"{coarse / fine:.1f}",
                         "the same here" if agrees(coarse, fine) else "not so here"])
    return Table(["the paper's section 5 finds", "body", "largest error here, coarse mesh", "fine mesh", "coarse / fine", ""],
                 [False, False, True, True, True, False], made)


def table(results):
    exact = {(c.model, c.triangles): c.paper_ms for c in results if c.method == "exact"}
    made = []
    for c in results:
        # hierarchical is compared with the paper's exact method, which computes the same result.
        ratio = 1000 * (c.paper_ms or exact[c.model, c.triangles]) / c.us
        made.append([c.model, grouped(c.triangles), f"`{c.method}`", f"{c.paper_ms:.2f}" if c.paper_ms else "",
                     f"{c.us:.2f}", f"{ratio:.1f}" if c.paper_ms else f"{ratio:.1f} *", c.error])
    return Table(["model", "triangles", "method", "paper, ms", "here, µs", "paper / here", "force error here"],
                 [False, True, False, True, True, True, True], made)


def figure(results):
    drawing = Drawing("paper_table1", "Times of the paper's table 1 next to those measured here", 1080,
                      160 + 24 * len(results), "The paper's table 1 and the same here")
    axes = drawing.canvas.subplots()
    set_up(axes, "time of one query, µs", log="x", plain_numbers=True)
    axes.set_title("rings: the paper's; filled: here", loc="right")
    axes.set_yticks(range(len(results)), [f"{c.model}, {grouped(c.triangles)}: {c.method}" for c in results])
    axes.invert_yaxis()
    for at, c in enumerate(results):
        if c.paper_ms:
            theirs = c.paper_ms * 1000
            axes.plot([c.us, theirs], [at, at], color="#888888")
            drawing.point(axes, theirs, at, f"{c.method}, paper: {c.paper_ms:g} ms",
                          {"color": "#888888", "marker": "o", "markerfacecolor": "white", "markeredgewidth": 2})
            axes.annotate(f"{theirs / c.us:.0f} ×", (math.sqrt(c.us * theirs), at), **{**SIZE_LABEL, "xytext": (0, 3)})
        drawing.point(axes, c.us, at, f"{c.method}, here: {c.us:g} µs", STYLES[c.method])
    values = "; ".join(f"{c.model} {c.method}: " + (f"paper {c.paper_ms:g} ms, " if c.paper_ms else "") + f"here {c.us:g} µs"
                       for c in results)
    drawing.description = f"Time of one query, logarithmic, a line per model and method. {values}."
    return drawing
