"""The rows that the measuring programs write, and how their numbers are shown."""
import csv

METHOD_ORDER = ["fast", "improved", "fast_surface", "exact", "exact_surface", "hierarchical"]
# What each method is called.
METHODS = {"plain": "plain", **{method: method for method in METHOD_ORDER},
           "float32_in_world": "single precision, in the world"}
# The columns that each figure needs.
COLUMNS = {
    "speed_accuracy": ["mesh", "triangles", "method", "tolerance", "target", "regime", "median_ns", "force_error",
                       "torque_error", "bound"],
    "wave_speed_accuracy": ["mesh", "triangles", "pressure", "components", "method", "tolerance", "median_ns",
                            "force_error", "force_bound"],
    "paper_figure4": ["shape", "triangles", "method", "h", "force", "closed_form", "error_of_whole"],
    "error_under_stress": ["sweep", "x", "method", "error_of_whole"],
    "run": ["utime", "pz", "qw", "qx", "qy", "qz", "fz"],
}
WAVE_COMPONENTS = 200
# Of each sweep of error_under_stress: title, label of the horizontal axis, name in a table.
SWEEPS = {
    "tilt": ("tilt of a box of flat faces", "rad", "tilt, 1e-12 to 1 rad"),
    "level": ("level and position, far up", "m", "level and position, 1 to 1e9 m up"),
    "origin": ("mesh far from its own origin", "m", "mesh 1 to 1e7 m from its origin"),
    "scale": ("size of the body", "m", "size, 1e-6 to 1e6 m"),
    "wet_share": ("submerged fraction; dotted: all of it missed", "of the whole displacement",
                  "submerged fraction, 1e-9 to 1"),
}


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
    if triangles < 1e3:
        return f"{triangles}"
    if triangles >= 1e6:
        return f"{triangles / 1e6:.0f} M"
    return f"{triangles / 1e3:.1f} k" if triangles < 3e3 else f"{triangles / 1e3:.0f} k"


def short_tolerance(tolerance):
    return f"{float(tolerance):.0e}".replace("e-0", "e-")


def largest(rows, key, column):
    """Returns the largest absolute value of a column per key; key(row): a tuple, or None to leave the row out."""
    found = {}
    for row in rows:
        if (at := key(row)) is not None:
            found[at] = max(abs(float(row[column])), found.get(at, 0.0))
    return found


def best_rows(rows, regime):
    """Returns the first row, that of the best instruction set, per mesh, size, method and tolerance."""
    best = {}
    for row in rows:
        if row["regime"] == regime:
            best.setdefault((row["mesh"], int(row["triangles"]), row["method"], row["tolerance"]), row)
    return best


def wave_table_rows(rows):
    """Returns the rows of one pressure with the tables' number of components."""
    return [r for r in rows if r["pressure"] == "wheeler" and int(r["components"]) == WAVE_COMPONENTS]


def figure4_errors(rows):
    """Returns {(shape, triangles): {method: largest error}}."""
    errors = {}
    for (*mesh, method), error in largest(rows, lambda r: (r["shape"], int(r["triangles"]), r["method"]),
                                          "error_of_whole").items():
        errors.setdefault(tuple(mesh), {})[method] = error
    return errors
