"""The subset of Markdown that the measuring programs write: headings, paragraphs, lists and tables."""
import re
from dataclasses import dataclass
from html import escape


@dataclass
class Table:
    header: list  # cells as Markdown
    right: list  # per column: whether it is right-aligned
    rows: list

    def column(self, name):
        return self.header.index(name)


def cells(row):
    """'| a | b \\| c |' -> ['a', 'b | c']"""
    parts = re.split(r"(?<!\\)\|", row.strip())
    return [part.strip().replace("\\|", "|") for part in parts[1:-1]]


def tables(text):
    """Returns every table with the heading above it."""
    found, heading, lines = [], "", text.splitlines()
    i = 0
    while i < len(lines):
        if lines[i].startswith("#"):
            heading = lines[i].lstrip("# ")
        if lines[i].startswith("|") and i + 1 < len(lines) and re.match(r"^\|[-:| ]+\|$", lines[i + 1]):
            start = i
            while i < len(lines) and lines[i].startswith("|"):
                i += 1
            found.append((heading, parse_table(lines[start:i])))
            continue
        i += 1
    return found


def parse_table(lines):
    header = cells(lines[0])
    right = [mark.endswith(":") for mark in cells(lines[1])]
    rows = [(row + [""] * len(header))[:len(header)] for row in map(cells, lines[2:])]
    return Table(header, right, rows)


def inline(text):
    text = escape(text.replace("\\*", "∗"))
    text = re.sub(r"`([^`]+)`", r"<code>\1</code>", text)
    text = re.sub(r"\*\*([^*]+)\*\*", r"<strong>\1</strong>", text)
    return re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)


def table_html(table, label):
    """Returns the table in a box that scrolls if the page is narrower."""
    def row(tag, row_cells):
        made = []
        for right, cell in zip(table.right, row_cells):
            classes = (["right"] if right else []) + (["missed"] if "MISSED" in cell else [])
            css = f' class="{" ".join(classes)}"' if classes else ""
            scope = ' scope="col"' if tag == "th" else ""
            made.append(f"<{tag}{scope}{css}>{inline(cell)}</{tag}>")
        return f"<tr>{''.join(made)}</tr>"

    body = "\n".join(row("td", r) for r in table.rows)
    return (f'<div class="scroll" role="region" aria-label="{escape(label)}" tabindex="0"><table>\n'
            f"<thead>{row('th', table.header)}</thead>\n<tbody>\n{body}\n</tbody></table></div>")


def html(text, level):
    """level: the level of all headings."""
    made, paragraph, items, heading = [], [], [], "table"
    lines = text.splitlines()

    def flush():
        if paragraph:
            made.append(f"<p>{inline(' '.join(paragraph))}</p>")
            paragraph.clear()
        if items:
            made.append("<ul>" + "".join(f"<li>{inline(item)}</li>" for item in items) + "</ul>")
            items.clear()

    i = 0
    while i < len(lines):
        line = lines[i]
        if line.startswith("|"):
            flush()
            start = i
            while i < len(lines) and lines[i].startswith("|"):
                i += 1
            made.append(table_html(parse_table(lines[start:i]), heading))
            continue
        if line.startswith("#"):
            flush()
            heading = line.lstrip("# ")
            made.append(f"<h{level}>{inline(heading)}</h{level}>")
        elif line.startswith("- "):
            items.append(line[2:])
        elif line.strip() == "":
            flush()
        else:
            paragraph.append(line.strip())
        i += 1
    flush()
    return "\n".join(made)
