"""Numerical stability: the results of scripts/measure_stability and scripts/random_search."""
import figures
import markdown
from figures import Unusable, grouped, significant
from markdown import Table
from parts import card, details, file_of, not_measured, picture, read_text, source_line, table_with
from plot import METHODS


def catalogue(part):
    """Returns (rows, checks, largest value, table) for each of the two tables."""
    made = []
    for name in ("table.md", "in_time.md"):
        table = table_with(part, name, "case")
        largest, checks = table.column("largest, in gates"), table.column("checks")
        try:
            worst = max(float(r[largest]) for r in table.rows)
            count = sum(int(r[checks]) for r in table.rows)
        except ValueError as error:
            raise Unusable(f"{file_of(part, name)}: {error}") from error
        made.append((len(table.rows), count, worst, table))
    return made


def stability_card(part):
    claim = "Stable: the largest error under stress, relative to its limit"
    if not part.measured():
        return card(claim, None, "", "", part)
    tables = catalogue(part)
    worst = max(t[2] for t in tables)
    kinds, checks = sum(t[0] for t in tables), sum(t[1] for t in tables)
    return card(claim, f"{worst:.3g}", "of 1 allowed" if worst <= 1 else "of 1 allowed: exceeded",
                f"{kinds} kinds of stress, {grouped(checks)} checks against rational arithmetic or closed "
                "forms.", part)


def stress_table(rows):
    methods = [m for m in METHODS if any(r["method"] == m for r in rows)]
    table = Table(["stress", "by"] + [METHODS[m].label for m in methods], [False] + [True] * (1 + len(methods)), [])
    at = {}
    for row in rows:
        at.setdefault((row["sweep"], float(row["x"])), {})[row["method"]] = significant(float(row["error_of_whole"]))
    for (sweep, x), of_method in at.items():
        kind = figures.SWEEPS[sweep][0].split(";")[0]
        table.rows.append([kind, f"{x:.3g}"] + [of_method.get(m, "") for m in methods])
    return table


def stability_section(part, search):
    made = []
    if part.measured():
        rows = figures.read_rows(file_of(part, "error_under_stress.csv"), figures.STRESS_COLUMNS)
        (cases, checks, worst, table), (timed, timed_checks, timed_worst, in_time) = catalogue(part)
        made += [
            picture(lambda wide: figures.error_under_stress(rows, wide),
                    "The exact methods are not affected. The dashed line is not a method of this service, but the "
                    "usual way of simulators: every vertex is transformed to the world frame in single precision."),
            details("The numbers of the figure", markdown.table_html(stress_table(rows), "error under stress")),
            f"<p>The catalogue: {cases} kinds of stress, {grouped(checks)} checks; the largest value is {worst:.3g} of "
            "the limit. The limit for a volume is the gate G_V = ε (64 V + L A) with ε = 2⁻⁵², the diagonal L of the "
            "bounding box and the surface area A.</p>",
            details("The catalogue, case by case", markdown.table_html(table, "the stress catalogue")),
            f"<p>In time: {timed} kinds of run, {grouped(timed_checks)} checks; the largest value is {timed_worst:.3g} "
            "of the limit.</p>",
            details("The runs, case by case", markdown.table_html(in_time, "runs of the simulator")),
            source_line(part)]
    else:
        made.append(not_measured(part))
    made.append("<h3>Random search</h3>")
    if search.measured():
        made.append("<p>Random meshes and adversarial poses, checked with exact arithmetic: the largest errors "
                    "relative to their limits and to the error bounds in the results. Errors of approximations and "
                    "errors within a tolerance may reach their bound. A violated bound fails the search.</p>")
        made.append(markdown.html(read_text(file_of(search, "report.md")), 4) + source_line(search))
    else:
        made.append(not_measured(search))
    return "\n".join(made)
