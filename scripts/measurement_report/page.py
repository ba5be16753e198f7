#!/usr/bin/env python3
"""Makes the results page from the files that the measurements wrote. Called by scripts/measure_all.

  page.py BUILD_DIRECTORY OUTPUT.html

The page marks missing measurements and names their commands. Exit status: 0 on success; 1 if there are no measurements,
a file is invalid, or the page cannot be written; 2 on invalid arguments.
"""
import sys
from html import escape
from pathlib import Path

import markdown
from figures import Unusable, grouped
from paper_section import figure4_section, paper_card, table1_section
from parts import card, file_of, find_parts, not_measured, read_text, row_with, source_line, table_with
from stability_section import stability_card, stability_section
from time_section import accuracy_card, speed_card, time_section

STYLE = Path(__file__).resolve().parent / "page.css"
PAPER_TITLE = "Approximate and exact buoyancy calculation for real-time floating simulation of meshes"


def network_card(part):
    claim = "Over the network: round trip between two processes"
    if not part.measured():
        return card(claim, None, "", "", part)
    path = file_of(part, "report.md")
    table = table_with(part, "report.md", "processors")
    row = row_with(table, {"processors": "all", "bodies": "1", "": "p50"}, path)
    return card(claim, row[table.column("service, us")], "µs",
                "Median round trip over UDP, one body. A plain LCM echo of the same size takes "
                f"{row[table.column('echo, us')]} µs.", part)


def replay_card(part):
    claim = "Replay: requests of a recorded log handled per second"
    if not part.measured():
        return card(claim, None, "", "", part)
    path = file_of(part, "section.md")
    for _, table in markdown.tables(read_text(path)):
        if "per second" in table.header:
            first, rate = table.header[0], table.column("per second")
            row = row_with(table, {first: "replay, all processors"}, path)
            alone = row_with(table, {first: "replay, one job"}, path)
            return card(claim, grouped(row[rate]), "per second",
                        f"All processors, reading and writing included; on one: {grouped(alone[rate])}. Every replay "
                        "writes the same bytes.", part)
    raise Unusable(f"{path}: no table with a column 'per second'")


def report_section(part, name):
    if not part.measured():
        return not_measured(part)
    # Omit its heading, which would repeat the section's.
    lines = [line for line in read_text(file_of(part, name)).splitlines() if not line.startswith("## ")]
    return markdown.html("\n".join(lines), 3) + source_line(part)


def page(parts):
    commands = [p.facts["command"] for p in parts.values() if p.measured()]
    quick = ('<p class="banner">A quick run with fewer meshes and requests: its times are preliminary.</p>'
             if any("--quick" in c for c in commands) else "")
    commits = sorted({p.facts["commit"] for p in parts.values() if p.measured()})
    mixed = (f'<p class="banner">These measurements were made at different commits: {escape(", ".join(commits))}.</p>'
             if len(commits) > 1 else "")
    cards = "\n".join([accuracy_card(parts["bench"]), speed_card(parts["bench"]), paper_card(parts["paper"]),
                       stability_card(parts["stability"]), network_card(parts["network"]),
                       replay_card(parts["replay"])])
    sections = [
        ("time", "Time and error", time_section(parts["bench"])),
        ("figure4", "The paper's figure 4: accuracy", figure4_section(parts["paper"])),
        ("table1", "The paper's table 1: time", table1_section(parts["paper"])),
        ("stability", "Numerical stability", stability_section(parts["stability"], parts["search"])),
        ("network", "Over the network", report_section(parts["network"], "report.md")),
        ("replay", "Replay", report_section(parts["replay"], "section.md")),
    ]
    nav = "".join(f'<a href="#{key}">{escape(title)}</a>' for key, title, _ in sections)
    body = "\n".join(f'<section id="{key}">\n<h2>{escape(title)}</h2>\n{content}\n</section>'
                     for key, title, content in sections)
    style = read_text(STYLE)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>buoyancy: results</title>
<style>
{style}</style>
</head>
<body>
<header>
<h1>buoyancy: results</h1>
<p class="lead">Accuracy, speed and numerical stability of the hydrostatic forces on floating triangle meshes, measured
by the project's own commands. Five algorithms are those of &ldquo;{escape(PAPER_TITLE)}&rdquo;;
<code>hierarchical</code> is this project's.</p>
{quick}{mixed}<nav aria-label="sections">{nav}</nav>
</header>
<main>
<section id="claims" aria-label="in short">
<div class="cards">
{cards}
</div>
</section>
{body}
</main>
<footer><p>Force errors are relative to the weight of the displacement of the whole body, torque errors to that times
the diagonal of the bounding box. Every figure on this page comes from the output of a measurement, those of the paper
from <code>bench/paper_numbers.csv</code>. Made by <code>./scripts/measure_all</code>.</p></footer>
</body>
</html>
"""


def main(arguments):
    if len(arguments) != 2:
        print("usage: page.py BUILD_DIRECTORY OUTPUT.html", file=sys.stderr)
        return 2
    try:
        made = page(find_parts(Path(arguments[0])))
        Path(arguments[1]).write_text(made, encoding="utf-8")
    except (Unusable, OSError) as error:
        print(f"scripts/measure_all: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
