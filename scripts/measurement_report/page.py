"""Makes the results page from the files that the measurements wrote.

The page marks missing measurements and names their commands.
"""
import re
from dataclasses import dataclass
from html import escape
from pathlib import Path

import markdown

import figures
import paper
import tables
from rows import COLUMNS, Unusable, best_rows, grouped, microseconds, read_rows, significant

STYLE = Path(__file__).resolve().parent / "page.css"
PAPER_TITLE = "Approximate and exact buoyancy calculation for real-time floating simulation of meshes"


@dataclass
class Part:
    """A measurement: the folder of its files, and its provenance, which is empty if it is missing."""
    folder: Path
    facts: dict

    def command(self):
        return self.facts.get("command", f"./scripts/measure {self.folder.name}")

    def text(self, name):
        return read_text(self.folder / name)

    def rows(self, name, columns):
        return read_rows(self.folder / name, columns)

    def table(self, name, column):
        """Returns the table of a report that has this column."""
        for table in tables.tables_in(self.text(name)):
            if column in table.header:
                return table
        raise Unusable(f"{self.folder / name}: no table with a column '{column}'; expected the output of {self.command()}")


def read_text(path):
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Unusable(f"{path}: {error}") from error


def find_part(folder):
    """Finds a measurement; it is complete if its provenance exists, which is written last."""
    path = folder / "provenance"
    if not path.exists():
        return Part(folder, {})
    facts = dict(line.split(": ", 1) for line in read_text(path).splitlines() if ": " in line)
    for key in ("command", "date", "processor", "threads", "system", "compiler", "commit"):
        if key not in facts:
            raise Unusable(f"{path}: no line '{key}: ...'. Measure again.")
    return Part(folder, facts)


# --- The claims: each returns a figure, its unit and an explanation, or None if the models for it are missing ---------

def accuracy(part):
    rows = [r for r in part.rows("speed_accuracy.csv", COLUMNS["speed_accuracy"])
            if r["method"] in ("exact", "exact_surface", "hierarchical") and float(r["tolerance"]) == 0]
    meshes = {(r["mesh"], r["triangles"]) for r in rows}
    targets = {r["target"] for r in rows if r["target"] != "-"}
    sizes = sorted(int(n) for _, n in meshes)
    return (significant(max(float(r["force_error"]) for r in rows)), "of the whole",
            f"{len(meshes)} meshes of {grouped(sizes[0])} to {grouped(sizes[-1])} triangles, two kinds of pose "
            f"sequences, {len(targets)} instruction sets; compared with extended precision.")


def speed(part):
    best = best_rows(part.rows("speed_accuracy.csv", COLUMNS["speed_accuracy"]), "independent")
    triangles, mesh = max((n, mesh) for mesh, n, m, t in best if m == "hierarchical" and "shuffled" not in mesh)
    time = {m: float(best[mesh, triangles, m, "0"]["median_ns"]) for m in ("read", *tables.LINEAR_EXACT, "hierarchical")}
    linear = min(tables.LINEAR_EXACT, key=time.get)
    return (microseconds(time["hierarchical"]), "µs",
            f"{grouped(triangles)} triangles, median over independent poses, caches warm, one thread. In the same run "
            f"the fastest exact method that visits the whole mesh, {linear}, takes {microseconds(time[linear])} µs, "
            f"{time[linear] / time['hierarchical']:.0f} "
            f"times as long, and reading the mesh once {microseconds(time['read'])} µs.")


def stability(part):
    both = [catalogue(part, name) for name in ("table.md", "in_time.md")]
    worst = max(worst for *_, worst in both)
    return (f"{worst:.3g}", "of 1 allowed" if worst <= 1 else "of 1 allowed: exceeded",
            f"{sum(kinds for _, kinds, *_ in both)} kinds of stress, {grouped(sum(checks for *_, checks, _ in both))} checks "
            "against rational arithmetic or closed forms.")


def network(part):
    table = part.table("report.md", "echo, us")
    row = table.row(processors="all", bodies="1", **{"": "p50"})
    return (row["service, us"], "µs", "Median round trip over UDP, one body. A plain LCM echo of the same size takes "
            f"{row['echo, us']} µs.")


def replay(part):
    table = part.table("section.md", "per second")
    every, alone = (table.row(**{table.header[0]: f"replay, {jobs}"})["per second"] for jobs in ("all processors", "one job"))
    return (grouped(every), "per second", f"All processors, reading and writing included; on one: {grouped(alone)}. Every "
            "replay writes the same bytes.")


CLAIMS = [
    ("speed", "Accurate: largest error of the exact methods' force", accuracy),
    ("speed", "Fast: a query of the largest mesh, exact to rounding", speed),
    ("paper", "Compared with the paper: an exact result on its largest available model", paper.claim),
    ("stability", "Stable: the largest error under stress, relative to its limit", stability),
    ("round_trip", "Over the network: round trip between two processes", network),
    ("replay", "Replay: requests of a recorded log handled per second", replay),
]


# --- The sections ----------------------------------------------------------------------------------------------------

def html(text, level=4, label="table"):
    """Returns a text as a part of the page, without its links and images, and each table in a box that scrolls if the page
    is narrower. level: the level of all headings; label: what a table without a heading above it is."""
    made = markdown.markdown(re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text), extensions=["tables"])
    made = re.sub(r"<th\b", '<th scope="col"', re.sub(r"(</?h)\d>", rf"\g<1>{level}>", made))
    made = re.sub(r"<td(?=(?:(?!</td>).)*MISSED)", '<td class="missed"', made)
    parts = re.split(r"(<h\d>.*?</h\d>|<table>)", made)
    for at, part in enumerate(parts):
        if part.startswith("<h"):
            label = re.sub(r"<.*?>", "", part)
        elif part == "<table>":
            parts[at] = f'<div class="scroll" role="region" aria-label="{label}" tabindex="0"><table>'
    return "".join(parts).replace("</table>", "</table></div>")


def details(summary, inner):
    return f"<details><summary>{escape(summary)}</summary>\n{inner}\n</details>"


def picture(figure, caption):
    return f'<figure><div class="scroll" tabindex="0">{figure.svg()}</div>\n<figcaption>{caption}</figcaption></figure>'


def time_section(part):
    rows = part.rows("speed_accuracy.csv", COLUMNS["speed_accuracy"])
    drawn = [(figures.speed_accuracy(rows),
              "Rocks of growing size. The accuracy and cost of an approximation grow with the mesh; the cost of "
              "<code>hierarchical</code> grows with the waterline only, and with a tolerance even less."),
             (figures.speed_accuracy(rows, "speed_accuracy_models", scanned=True),
              "The same for the torus knot and the available scanned models.")]
    if not any(figure for figure, _ in drawn):
        raise Unusable(f"{part.folder / 'speed_accuracy.csv'}: no mesh that a figure shows")
    return [*(picture(figure, caption) for figure, caption in drawn if figure),
            details("The numbers: every mesh, method and tolerance",
                    "<p>Medians over independent poses; errors and bounds are the largest, relative to the whole "
                    "displacement, on the processor's best instruction set. <code>plain</code> is the paper's "
                    "exact method as a user would write it, in 40 lines of C++.</p>"
                    + html(tables.times(rows).text(), label="time and error of every mesh, method and tolerance")),
            details("The report of the run: goals, growth, instruction sets, the tree, many bodies",
                    html(part.text("report.md")))]


def figure4_section(part):
    rows = part.rows("figure4.csv", COLUMNS["paper_figure4"])
    return [picture(figures.paper_figure4(rows),
                    "The paper gives no numbers with its figure 4. The thick line is its closed form (section 5); the "
                    "curves are from this run. On a sphere the exact methods show the error of the inscribed mesh."),
            "<p>The paper's findings, compared with results on the same meshes:</p>",
            html(paper.findings(rows).text(), label="the paper's findings next to this run"),
            details("The numbers: forces at five heights, and the largest errors",
                    "<p>Force where ρg = 1.</p>" + html(tables.figure4_samples(rows).text(), label="forces next to the closed form")
                    + "<p>Largest error of the force over all heights, relative to the whole.</p>"
                    + html(tables.figure4(rows).text(), label="largest errors"))]


def table1_section(part):
    compared = paper.compared(part)
    replaced = "Rocks of the same size replaced them; <code>BUOYANCY_MESHES</code> is the folder of the scanned models."
    if not compared:
        return [f'<p class="absent">None of the paper\'s models was measured. {replaced}</p>']
    setup = {r["quantity"]: escape(r["value"]) for r in paper.rows()}
    facts = {key: escape(value) for key, value in part.facts.items()}
    absent = dict.fromkeys(r["model"] for r in paper.rows("table 1") if r["model"] not in {c.model for c in compared})
    return [picture(paper.figure(compared),
                    "Across: time of one query, logarithmic. The paper has no <code>hierarchical</code>."),
            f"<p>Other differences than the code. The paper: {setup['processor']}, {setup['system']}, in "
            f"{setup['platform']}, the average of {setup['measurements averaged']} measurements. Here: "
            f"{facts['processor']}, {facts['system']}, {facts['compiler']}, one thread, the median "
            "of five runs over poses from almost dry to almost submerged, as in the paper. The ratio includes all of these "
            "differences and does not compare algorithms alone.</p>",
            f'<p class="absent">Not available and therefore not compared: {escape(", ".join(absent))}. '
            f"{replaced}</p>" if absent else "",
            details("The numbers: table 1 next to this run",
                    html(paper.table(compared).text(), label="the paper's table 1 next to this run")
                    + "<p>* Compared with the paper's time for <code>exact</code>, which computes the same result.</p>")]


def catalogue(part, name):
    """Returns a table of the stability report, its number of rows and of checks, and its largest value."""
    table = part.table(name, "case")
    try:
        return (table, len(table.rows), sum(int(n) for n in table.cells_of("checks")),
                max(float(value) for value in table.cells_of("largest, in gates")))
    except ValueError as error:
        raise Unusable(f"{part.folder / name}: {error}") from error


def stability_section(part):
    rows = part.rows("error_under_stress.csv", COLUMNS["error_under_stress"])
    table, cases, checks, worst = catalogue(part, "table.md")
    in_time, timed, timed_checks, timed_worst = catalogue(part, "in_time.md")
    return [picture(figures.error_under_stress(rows),
                    "The exact methods are not affected. The dashed line is not a method of this service, but the "
                    "usual way of simulators: every vertex is transformed to the world frame in single precision."),
            details("The numbers of the figure", html(tables.stress(rows).text(), label="error under stress")),
            f"<p>The catalogue: {cases} kinds of stress, {grouped(checks)} checks; the largest value is {worst:.3g} of "
            "the limit. The limit for a volume is the gate G_V = ε (64 V + L A) with ε = 2⁻⁵², the diagonal L of the "
            "bounding box and the surface area A.</p>",
            details("The catalogue, case by case", html(table.text(), label="the stress catalogue")),
            f"<p>In time: {timed} kinds of run, {grouped(timed_checks)} checks; the largest value is {timed_worst:.3g} "
            "of the limit.</p>",
            details("The runs, case by case", html(in_time.text(), label="runs of the simulator"))]


def search_section(part):
    return ["<p>Random meshes and adversarial poses, checked with exact arithmetic: the largest errors "
            "relative to their limits and to the error bounds in the results. Errors of approximations and "
            "errors within a tolerance may reach their bound. A violated bound fails the search.</p>",
            html(part.text("report.md"))]


def report_section(name):
    def section(part):
        # Omit its heading, which would repeat the section's.
        return [html("\n".join(line for line in part.text(name).splitlines() if not line.startswith("## ")), 3)]
    return section


SECTIONS = [
    ("time", "speed", "Time and error", time_section),
    ("figure4", "paper", "The paper's figure 4: accuracy", figure4_section),
    ("table1", "paper", "The paper's table 1: time", table1_section),
    ("stability", "stability", "Numerical stability", stability_section),
    ("search", "search", "Random search", search_section),
    ("network", "round_trip", "Over the network", report_section("report.md")),
    ("replay", "replay", "Replay", report_section("section.md")),
]


# --- The page --------------------------------------------------------------------------------------------------------

def source(*facts):
    command, *others = map(escape, facts)
    return f'<p class="source"><code>{command}</code>{"".join(f"<span>{fact}</span>" for fact in others)}</p>'


def card(part, claim, function):
    made = function(part) if part.facts else None
    if made is None:
        return (f'<div class="card absent"><h3>{escape(claim)}</h3><p class="figure">–</p><p>Not measured.</p>'
                f"{source(part.command())}</div>")
    figure, unit, detail = map(escape, made)
    return (f'<div class="card"><h3>{escape(claim)}</h3><p class="figure">{figure} <small>{unit}</small></p>'
            f"<p>{detail}</p>{source(*(part.facts[key] for key in ('command', 'date', 'processor')))}</div>")


def section(key, title, part, function):
    if part.facts:
        facts = part.facts
        made = [*function(part), source(facts["command"], facts["date"], f"{facts['processor']}, {facts['threads']} threads",
                                        facts["compiler"], f"commit {facts['commit']}")]
    else:
        made = [f'<p class="absent">Not measured. Run <code>{part.command()}</code>.</p>']
    return "\n".join([f'<section id="{key}">\n<h2>{escape(title)}</h2>', *made, "</section>"])


def page(results):
    """results: the folder with a folder for each measurement."""
    parts = {name: find_part(results / name) for _, name, *_ in SECTIONS}
    facts = [part.facts for part in parts.values() if part.facts]
    if not facts:
        raise Unusable(f"{results}: no measurements found. Run scripts/measure all without --reuse, or one of "
                       + ", ".join(part.command() for part in parts.values()))
    quick = ('<p class="banner">A quick run with fewer meshes and requests: its times are preliminary.</p>'
             if any("--quick" in f["command"] for f in facts) else "")
    commits = sorted({f["commit"] for f in facts})
    mixed = (f'<p class="banner">These measurements were made at different commits: {escape(", ".join(commits))}.</p>'
             if len(commits) > 1 else "")
    cards = "\n".join(card(parts[name], claim, function) for name, claim, function in CLAIMS)
    nav = "".join(f'<a href="#{key}">{escape(title)}</a>' for key, _, title, _ in SECTIONS)
    body = "\n".join(section(key, title, parts[name], function) for key, name, title, function in SECTIONS)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>buoyancy: results</title>
<style>
{read_text(STYLE)}</style>
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
from <code>bench/paper_numbers.csv</code>. Made by <code>./scripts/measure all</code>.</p></footer>
</body>
</html>
"""
