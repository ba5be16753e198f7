"""The paper's figure 4 and table 1 next to the results of scripts/measure_paper."""
from html import escape
from pathlib import Path

import figures
import markdown
from figures import METHOD_ORDER, grouped, significant
from markdown import Table
from parts import card, details, file_of, not_measured, picture, source_line, table_with
from plot import METHODS, Figure, Panel, Scale, heading, marker, note, text

FIND_MODELS = "Rocks of the same size replaced them; <code>BUOYANCY_MESHES</code> is the folder of the scanned models."
PAPER = Path(__file__).resolve().parents[2] / "bench" / "paper_numbers.csv"


def paper_rows():
    return figures.read_rows(PAPER, ["place", "quantity", "model", "triangles", "method", "value", "unit"])


def compared_table1(part):
    """Returns rows (model, triangles, method, paper's ms or None, our us, force error) for models in both tables."""
    paper = {(r["model"], int(r["triangles"]), r["method"]): float(r["value"])
             for r in paper_rows() if r["place"] == "table 1"}
    ours = table_with(part, "table1.md", "model")
    model, triangles, method = (ours.column(c) for c in ("model", "triangles", "method"))
    time, error = ours.column("processor time, us"), ours.column("force error")
    measured = {(r[model], int(r[triangles]), r[method]): (float(r[time]), r[error]) for r in ours.rows}
    compared = []
    for of_model in dict.fromkeys((m, n) for m, n, _ in paper):
        for name in METHOD_ORDER:
            if (*of_model, name) in measured:
                us, force_error = measured[(*of_model, name)]
                compared.append((*of_model, name, paper.get((*of_model, name)), us, force_error))
    return compared


def paper_table1_figure(compared, wide):
    models = list(dict.fromkeys(row[:2] for row in compared))
    width, row_height, gap = (1080, 24, 46) if wide else (420, 24, 46)
    left = 150 if wide else 112
    times = [row[4] for row in compared] + [row[3] * 1000 for row in compared if row[3]]
    height = 60 + sum(gap + row_height * sum(r[:2] == m for r in compared) for m in models) + 46
    x = Scale(min(times) / 1.6, max(times) * 1.6, log=True, plain=True, label="time of one query, µs")
    panel = Panel(left, 48, width - left - 30, height - 48 - 50, x, None)
    parts = panel.parts
    parts.append(heading(width, wide, "The paper's table 1 and the same here", "The paper's table 1, and here"))
    y = 48.0
    for model in models:
        title = escape(f"{model[0]}, {grouped(model[1])} triangles")
        parts.append(text(left + 8, y + 26, title, weight="600", halo=True))
        y += gap - 6
        for _, _, method, paper_ms, us, _ in (r for r in compared if r[:2] == model):
            at = y + row_height / 2
            ours = panel.at_x(us)
            parts.append(text(left - 10, at + 4, method, css="ink", anchor="end"))
            if paper_ms:
                theirs = panel.at_x(paper_ms * 1000)
                parts.append(f'<path d="M{ours:.1f} {at:.1f}H{theirs:.1f}" stroke="#888888" stroke-width="1.5"/>')
                parts.append(f'<circle class="ring" cx="{theirs:.1f}" cy="{at:.1f}" r="5" fill="#ffffff" '
                             f'stroke="#888888" stroke-width="2"><title>{method}, paper: {paper_ms:g} ms</title>'
                             '</circle>')
                if wide:
                    ratio = f"{paper_ms * 1000 / us:.0f} ×"
                    parts.append(note((ours + theirs) / 2, at - 4, ratio, halo=True))
            parts.append(marker(ours, at, METHODS[method], f"{method}, here: {us:g} µs"))
            y += row_height
        y += 6
    parts.append(note(width - 30, 42, "rings: the paper's; filled: here", anchor="end"))
    values = "; ".join(f"{model} {method}: " + (f"paper {ms:g} ms, " if ms else "") + f"here {us:g} µs"
                       for model, _, method, ms, us, _ in compared)
    return Figure("paper_table1", "Times of the paper's table 1 next to those measured here",
                  f"Time of one query, logarithmic, a line per model and method. {values}.", width, height, parts)


def paper_card(part):
    claim = "Compared with the paper: an exact result on its largest available model"
    if not part.measured():
        return card(claim, None, "", "", part)
    compared = [r for r in compared_table1(part) if r[2] in ("exact", "hierarchical")]
    if not compared:
        return card(claim, None, "", "", part)
    largest = max(n for _, n, *_ in compared)
    rows = {r[2]: r for r in compared if r[1] == largest}
    paper_us = rows["exact"][3] * 1000
    return card(claim, f"{paper_us / rows['hierarchical'][4]:.0f}", "times faster",
                f"{rows['exact'][0]}, {grouped(largest)} triangles: {rows['exact'][3]:g} ms in the paper, "
                f"{rows['hierarchical'][4]:g} µs here with hierarchical, {rows['exact'][4]:g} µs with the paper's "
                "algorithm. The ratio includes another processor and another language.", part)


def figure4_findings(rows):
    """Compares the findings of section 5 of the paper with the results here."""
    of_paper = {(r["model"], int(r["triangles"])) for r in paper_rows() if r["place"] == "section 5"}
    largest = {mesh: errors for mesh, errors in figures.largest_figure4_errors(rows).items() if mesh in of_paper}
    table = Table(["the paper's section 5 finds", "body", "largest error here, coarse mesh", "fine mesh",
                   "coarse / fine", ""], [False, False, True, True, True, False], [])
    for shape in ("cube", "sphere"):
        sizes = sorted(n for s, n in largest if s == shape)
        if len(sizes) < 2:
            continue
        coarse, fine = largest[shape, sizes[0]], largest[shape, sizes[-1]]

        def add(finding, method, agrees):
            ratio = coarse[method] / fine[method]
            verdict = "the same here" if agrees(coarse[method], fine[method]) else "not so here"
            table.rows.append([finding, f"{shape}, `{method}`", significant(coarse[method]), significant(fine[method]),
                               f"{ratio:.1f}", verdict])
        if shape == "cube":  # a sphere's mesh is inscribed, so that its discretisation error dominates
            for method in ("exact", "exact_surface"):
                add("exact to rounding", method, lambda c, f: max(c, f) < 1e-12)
        add("a finer mesh reduces the error", "improved", lambda c, f: f < c / 2)
        add("a finer mesh does not reduce the error", "fast", lambda c, f: f > c / 2)
    return table


def figure4_samples(rows):
    table = Table(["body", "triangles", "h", "paper's closed form"] + [f"`{m}`" for m in METHOD_ORDER],
                  [False] + [True] * (3 + len(METHOD_ORDER)), [])
    series = {}
    for row in rows:
        series.setdefault((row["shape"], int(row["triangles"])), {}).setdefault(row["h"], {})[row["method"]] = row
    for (shape, triangles), of_height in series.items():
        heights = sorted(of_height, key=float)
        for h in heights[len(heights) // 10::max(1, len(heights) // 5)]:
            of_method = of_height[h]
            closed = float(next(iter(of_method.values()))["closed_form"])
            table.rows.append([shape, grouped(triangles), f"{float(h):g}", f"{closed:.8f}"]
                              + [f"{float(of_method[m]['force']):.8f}" if m in of_method else "" for m in METHOD_ORDER])
    return table


def figure4_errors(rows):
    table = Table(["body", "triangles"] + [f"`{m}`" for m in METHOD_ORDER],
                  [False] + [True] * (1 + len(METHOD_ORDER)), [])
    for (shape, n), errors in figures.largest_figure4_errors(rows).items():
        table.rows.append([shape, grouped(n)] + [significant(errors[m]) if m in errors else "" for m in METHOD_ORDER])
    return table


def table1_table(compared):
    table = Table(["model", "triangles", "method", "paper, ms", "here, µs", "paper / here", "force error here"],
                  [False, True, False, True, True, True, True], [])
    exact = {row[:2]: row[3] for row in compared if row[2] == "exact"}
    for model, triangles, method, paper_ms, us, error in compared:
        if paper_ms:
            ratio = f"{paper_ms * 1000 / us:.1f}"
        else:  # hierarchical, compared with the paper's exact method, which computes the same result
            ratio = f"{exact[model, triangles] * 1000 / us:.1f} *"
        table.rows.append([model, grouped(triangles), f"`{method}`", f"{paper_ms:.2f}" if paper_ms else "", f"{us:.2f}",
                           ratio, error])
    return table


def figure4_section(part):
    if not part.measured():
        return not_measured(part)
    rows = figures.read_rows(file_of(part, "figure4.csv"), figures.FIGURE4_COLUMNS)
    return "\n".join([
        picture(lambda wide: figures.paper_figure4(rows, wide),
                "The paper gives no numbers with its figure 4. The thick line is its closed form (section 5); the "
                "curves are from this run. On a sphere the exact methods show the error of the inscribed mesh."),
        "<p>The paper's findings, compared with results on the same meshes:</p>",
        markdown.table_html(figure4_findings(rows), "the paper's findings next to this run"),
        details("The numbers: forces at five heights, and the largest errors",
                "<p>Force where ρg = 1.</p>"
                + markdown.table_html(figure4_samples(rows), "forces next to the closed form")
                + "<p>Largest error of the force over all heights, relative to the whole.</p>"
                + markdown.table_html(figure4_errors(rows), "largest errors")),
        source_line(part)])


def table1_section(part):
    if not part.measured():
        return not_measured(part)
    compared = compared_table1(part)
    if not compared:
        return f"<p class=\"absent\">None of the paper's models was measured. {FIND_MODELS}</p>" + source_line(part)
    setup = {r["quantity"]: r["value"] for r in paper_rows()}
    measured = {model for model, *_ in compared}
    absent = list(dict.fromkeys(r["model"] for r in paper_rows()
                                if r["place"] == "table 1" and r["model"] not in measured))
    missing = (f'<p class="absent">Not available and therefore not compared: {escape(", ".join(absent))}. '
               f"{FIND_MODELS}</p>" if absent else "")
    facts = part.facts
    return "\n".join([
        picture(lambda wide: paper_table1_figure(compared, wide),
                "Across: time of one query, logarithmic. The paper has no <code>hierarchical</code>."),
        f"<p>Other differences than the code. The paper: {escape(setup['processor'])}, {escape(setup['system'])}, in "
        f"{escape(setup['platform'])}, the average of {escape(setup['measurements averaged'])} measurements. Here: "
        f"{escape(facts['processor'])}, {escape(facts['system'])}, {escape(facts['compiler'])}, one thread, the median "
        "of five runs over poses from almost dry to almost submerged, as in the paper. The ratio includes all of these "
        "differences and does not compare algorithms alone.</p>",
        missing,
        details("The numbers: table 1 next to this run",
                markdown.table_html(table1_table(compared), "the paper's table 1 next to this run")
                + "<p>* Compared with the paper's time for <code>exact</code>, which computes the same result.</p>"),
        source_line(part)])
