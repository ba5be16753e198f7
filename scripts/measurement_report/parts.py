"""The measurements of the results page, and the elements that all sections share."""
from dataclasses import dataclass, field
from html import escape
from pathlib import Path

import markdown
from figures import Unusable


@dataclass
class Part:
    """A measurement: the location of its files and the command that writes them."""
    key: str
    folder: str
    command: str
    files: list
    facts: dict = field(default_factory=dict)

    def measured(self):
        return bool(self.facts)


PARTS = [
    Part("bench", "bench", "./scripts/bench", ["speed_accuracy.csv", "report.md"]),
    Part("paper", "measure", "./scripts/measure_paper", ["figure4.csv", "table1.md"]),
    Part("stability", "stability", "./scripts/measure_stability", ["table.md", "in_time.md", "error_under_stress.csv"]),
    Part("search", "search", "./scripts/random_search --table", ["report.md"]),
    Part("network", "round_trip", "./scripts/measure_round_trip", ["report.md"]),
    Part("replay", "replay", "./scripts/measure_replay", ["section.md"]),
]


def read_text(path):
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Unusable(f"{path}: {error}") from error


def read_facts(path):
    facts = dict(line.split(": ", 1) for line in read_text(path).splitlines() if ": " in line)
    for key in ("command", "date", "processor", "threads", "system", "compiler", "commit"):
        if key not in facts:
            raise Unusable(f"{path}: no line '{key}: ...'; expected the output of scripts/provenance. Measure again.")
    return facts


def find_parts(build):
    """Finds the measurements; one is complete if its provenance exists, which its script writes last."""
    parts = {}
    for part in PARTS:
        folder = build / part.folder
        facts = read_facts(folder / "provenance") if (folder / "provenance").exists() else {}
        parts[part.key] = Part(part.key, str(folder), part.command, part.files, facts)
    if not any(part.measured() for part in parts.values()):
        raise Unusable(f"{build}: no measurements found. Run scripts/measure_all without --reuse, or one of "
                       + ", ".join(part.command for part in PARTS))
    return parts


def file_of(part, name):
    return Path(part.folder) / name


def table_with(part, name, first_column):
    """Returns the table of a report whose first column has this name."""
    path = file_of(part, name)
    for _, table in markdown.tables(read_text(path)):
        if table.header[0] == first_column:
            return table
    raise Unusable(f"{path}: no table whose first column is '{first_column}'; expected the output of {part.command}")


def row_with(table, where, path_of):
    for row in table.rows:
        if all(row[table.column(name)] == value for name, value in where.items()):
            return row
    raise Unusable(f"{path_of}: no row with {where}")


def source_line(part):
    facts = part.facts
    return (f'<p class="source"><code>{escape(facts["command"])}</code><span>{escape(facts["date"])}</span>'
            f'<span>{escape(facts["processor"])}, {escape(facts["threads"])} threads</span>'
            f'<span>{escape(facts["compiler"])}</span>'
            f'<span>commit {escape(facts["commit"])}</span></p>')


def not_measured(part):
    return f'<p class="absent">Not measured. Run <code>{escape(part.command)}</code>.</p>'


def details(summary, inner):
    return f"<details><summary>{escape(summary)}</summary>\n{inner}\n</details>"


def picture(draw, caption):
    """draw(wide): returns the figure in its wide or narrow form."""
    wide, narrow = draw(True), draw(False)
    return f'<figure>{wide.inline("wide")}\n{narrow.inline("narrow")}\n<figcaption>{caption}</figcaption></figure>'


def card(claim, figure, unit, detail, part):
    if figure is None:
        return (f'<div class="card absent"><h3>{escape(claim)}</h3><p class="figure">–</p>'
                f'<p>Not measured.</p><p class="source"><code>{escape(part.command)}</code></p></div>')
    return (f'<div class="card"><h3>{escape(claim)}</h3>'
            f'<p class="figure">{escape(figure)} <small>{escape(unit)}</small></p>'
            f'<p>{escape(detail)}</p><p class="source"><code>{escape(part.facts["command"])}</code>'
            f'<span>{escape(part.facts["date"])}</span><span>{escape(part.facts["processor"])}</span></p></div>')
