"""The tables of the results page and of the docs, made of the rows that the measuring programs write."""
import json
import math
import re
from dataclasses import dataclass

from rows import (METHOD_ORDER, METHODS, SWEEPS, Unusable, best_rows, figure4_errors, grouped, largest, microseconds,
                  short_tolerance, significant, wave_table_rows)

# The methods that visit the whole mesh and are exact to rounding.
LINEAR_EXACT = ("plain", "exact", "exact_surface")


@dataclass
class Table:
    header: list  # cells as Markdown
    right: list  # per column: whether it is right-aligned
    rows: list

    def dictionaries(self):
        """Returns the rows by column; of several columns of one name, the first counts."""
        return [dict(reversed(list(zip(self.header, row)))) for row in self.rows]

    def cells_of(self, column):
        return [row[column] for row in self.dictionaries()]

    def row(self, **where):
        """Returns the first row with these cells."""
        for row in self.dictionaries():
            if where.items() <= row.items():
                return row
        raise Unusable(f"no row with {where} below the header {self.header}")

    def text(self):
        marks = ["---:" if right else "---" for right in self.right]
        lines = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in (self.header, *self.rows)]
        return "\n".join([lines[0], f"|{'|'.join(marks)}|", *lines[1:]])


def tables_in(text):
    """Returns the tables of a document."""
    found = []
    for lines in re.findall(r"(?:^\|.*\n?)+", text, re.MULTILINE):
        header, marks, *rows = [[cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]]
                                for line in lines.splitlines()]
        rows = [(row + [""] * len(header))[:len(header)] for row in rows]
        found.append(Table(header, [mark.endswith(":") for mark in marks], rows))
    return found


def table(header, left, rows):
    """left: how many columns before those of numbers."""
    return Table(header, [column >= left for column in range(len(header))], rows)


def absent_row(what, mesh, triangles, name):
    return Unusable(f"no row of {what} for {mesh} of {triangles} triangles; expected the rows of a complete run of "
                    f"scripts/measure {name}")


def performance(rows):
    """The README's table: the time of every method, poses far apart and caches warm; below them the largest errors."""
    methods = ["read", "plain", "fast", "improved", "exact", "fast_surface", "exact_surface", "hierarchical"]
    best = best_rows(rows, "independent")
    made = []
    for triangles, mesh in sorted({(n, mesh) for mesh, n, _, _ in best if "shuffled" not in mesh}):
        absent = [method for method in methods if (mesh, triangles, method, "0") not in best]
        if absent:
            raise absent_row(f"'{absent[0]}'", mesh, triangles, "speed")
        ns = {method: float(best[mesh, triangles, method, "0"]["median_ns"]) for method in methods}
        made.append([mesh, grouped(triangles), *(microseconds(ns[method]) for method in methods),
                     f"{min(ns[method] for method in LINEAR_EXACT) / ns['hierarchical']:.1f}",
                     f"{ns['plain'] / ns['hierarchical']:.1f}"])
    for kind in ("force", "torque"):
        errors = largest(rows, lambda r: r["method"] if r["method"] != "read" and r["regime"] in ("independent", "coherent")
                         and float(r["tolerance"]) == 0 else None, f"{kind}_error")
        made.append([f"largest error of {kind}", "",
                     *(significant(errors[method]) if method in errors else "" for method in methods), "", ""])
    return table(["time per query, µs", "triangles", *(f"`{m}`" for m in methods), "ratio", "to `plain`"], 1, made)


def waves(rows):
    """The README's table of waves: time and error of every method, and the bound of hierarchical."""
    drawn = wave_table_rows(rows)
    kinds = list(dict.fromkeys((row["method"], row["tolerance"]) for row in drawn))
    cells = {(row["mesh"], int(row["triangles"]), row["method"], row["tolerance"]): row for row in drawn}

    def cell(row):
        bound = float(row["force_bound"])
        of_bound = f" of {significant(bound)}" if bound < float("inf") else ""
        return f"{microseconds(float(row['median_ns']))} ({significant(float(row['force_error']))}{of_bound})"

    made = []
    for triangles, mesh in sorted({(n, mesh) for mesh, n, _, _ in cells}):
        absent = [" at ".join(kind) for kind in kinds if (mesh, triangles, *kind) not in cells]
        if absent:
            raise absent_row(absent[0], mesh, triangles, "waves")
        made.append([mesh, grouped(triangles), *(cell(cells[mesh, triangles, *kind]) for kind in kinds)])
    titles = [f"`{method}`" if float(tolerance) == 0 else f"`{method}`, {short_tolerance(tolerance)}"
              for method, tolerance in kinds]
    return table(["time, µs (error of bound)", "triangles", *titles], 1, made)


def times(rows):
    """Every mesh, method and tolerance."""
    best = best_rows(rows, "independent")
    others = [best_rows(rows, regime) for regime in ("coherent", "cold")]
    order = ["read", *METHODS]
    made = []
    for key in sorted(best, key=lambda k: (k[1], k[0], order.index(k[2]), float(k[3]))):
        mesh, triangles, method, tolerance = key
        row = best[key]
        other_times = [microseconds(float(of[key]["median_ns"])) if key in of else "" for of in others]
        errors = [float(row[column]) for column in ("force_error", "torque_error", "bound")]
        made.append([mesh, grouped(triangles), f"`{method}`", tolerance, row["target"],
                     microseconds(float(row["median_ns"])), *other_times,
                     *("" if math.isnan(error) else significant(error) for error in errors)])
    return Table(["mesh", "triangles", "method", "tolerance", "instruction set", "time, µs", "time on a trajectory, µs",
                  "caches flushed, µs", "force error", "torque error", "bound"],
                 [False, True, False, True, False] + [True] * 6, made)


def figure4(rows):
    """The largest error of every method on every body of the paper's figure 4."""
    return table(["body", "triangles"] + [f"`{m}`" for m in METHOD_ORDER], 1,
                 [[shape, grouped(n)] + [significant(errors[m]) if m in errors else "" for m in METHOD_ORDER]
                  for (shape, n), errors in figure4_errors(rows).items()])


def figure4_samples(rows):
    made, series = [], {}
    for row in rows:
        series.setdefault((row["shape"], int(row["triangles"])), {}).setdefault(row["h"], {})[row["method"]] = row
    for (shape, triangles), of_height in series.items():
        heights = sorted(of_height, key=float)
        for h in heights[len(heights) // 10::max(1, len(heights) // 5)]:
            of_method = of_height[h]
            closed = float(next(iter(of_method.values()))["closed_form"])
            made.append([shape, grouped(triangles), f"{float(h):g}", f"{closed:.8f}"]
                        + [f"{float(of_method[m]['force']):.8f}" if m in of_method else "" for m in METHOD_ORDER])
    return table(["body", "triangles", "h", "paper's closed form"] + [f"`{m}`" for m in METHOD_ORDER], 1, made)


def table1(rows):
    """The paper's table 1, from the medians of Google Benchmark."""
    made = []
    for row in rows:
        if not row["name"].endswith("_median"):
            continue
        model, triangles, method = row["name"].removesuffix("_median").split("/")[:3]
        us = float(row["cpu_time"]) / 1000
        errors = ["", ""] if method.startswith("read") else [significant(float(row[f"{kind}_error"]))
                                                             for kind in ("force", "torque")]
        made.append([model, triangles, method, f"{us:.2f}", f"{1000 * us / int(triangles):.2f}", *errors])
    return Table(["model", "triangles", "method", "processor time, us", "ns per triangle", "force error", "torque error"],
                 [False, True, False] + [True] * 4, made)


def stress(rows):
    """The error of every method at every step of every sweep."""
    methods = [m for m in METHODS if any(r["method"] == m for r in rows)]
    at = {}
    for row in rows:
        at.setdefault((row["sweep"], float(row["x"])), {})[row["method"]] = significant(float(row["error_of_whole"]))
    return table(["stress", "by"] + [METHODS[m] for m in methods], 1,
                 [[SWEEPS[sweep][0].split(";")[0], f"{x:.3g}"] + [of_method.get(m, "") for m in methods]
                  for (sweep, x), of_method in at.items()])


def sweeps(rows):
    """The largest error of every method over each sweep."""
    methods = [*METHOD_ORDER, "float32_in_world"]
    errors = largest(rows, lambda row: (row["sweep"], row["method"]), "error_of_whole")
    return table(["largest over the sweep", *METHOD_ORDER, "single precision"], 1,
                 [[SWEEPS[sweep][2], *(significant(errors[sweep, method]) for method in methods)]
                  for sweep in dict.fromkeys(row["sweep"] for row in rows)])


def catalogue(paths):
    """A row per test that records one, from the JSON output of GoogleTest."""
    made = []
    for path in paths:
        suites = json.loads(path.read_text(encoding="utf-8"))["testsuites"]
        for case in (case for suite in suites for case in suite["testsuite"] if "checks" in case):
            value = float(case["largest"])
            made.append([case["row"], case["oracle"], case["gate"], f"{value:.3g}", case["largest_at"], case["checks"]])
    return Table(["case", "oracle", "gate", "largest, in gates", "at", "checks"],
                 [False, False, False, True, False, True], made)
