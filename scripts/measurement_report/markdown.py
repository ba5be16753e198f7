"""The subset of Markdown that the measuring programs write: headings, paragraphs, lists and tables."""
import re
from dataclasses import dataclass
from html import escape

from figures import Unusable


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
        lines = [f"| {' | '.join(row)} |" for row in (self.header, *self.rows)]
        return "\n".join([lines[0], f"|{'|'.join(marks)}|", *lines[1:]])

    def html(self, label):
        """Returns the table in a box that scrolls if the page is narrower."""
        def row(tag, row_cells):
            made = []
            for right, cell in zip(self.right, row_cells):
                classes = (["right"] if right else []) + (["missed"] if "MISSED" in cell else [])
                css = f' class="{" ".join(classes)}"' if classes else ""
                scope = ' scope="col"' if tag == "th" else ""
                made.append(f"<{tag}{scope}{css}>{inline(cell)}</{tag}>")
            return f"<tr>{''.join(made)}</tr>"

        body = "\n".join(row("td", r) for r in self.rows)
        return (f'<div class="scroll" role="region" aria-label="{escape(label)}" tabindex="0"><table>\n'
                f"<thead>{row('th', self.header)}</thead>\n<tbody>\n{body}\n</tbody></table></div>")


def cells(row):
    """'| a | b \\| c |' -> ['a', 'b | c']"""
    parts = re.split(r"(?<!\\)\|", row.strip())
    return [part.strip().replace("\\|", "|") for part in parts[1:-1]]


def parse_table(header, marks, *rows):
    rows = [(row + [""] * len(header))[:len(header)] for row in rows]
    return Table(header, [mark.endswith(":") for mark in marks], rows)


def blocks(text):
    """Yields pairs of kind ("heading", "table", "item" or "line") and content."""
    rows = []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|"):
            rows.append(cells(line))
            continue
        if len(rows) > 1:
            yield "table", parse_table(*rows)
        rows = []
        if line.startswith("#"):
            yield "heading", line.lstrip("# ")
        elif line.startswith("- "):
            yield "item", line[2:]
        else:
            yield "line", line.strip()


def tables(text):
    return [content for kind, content in blocks(text) if kind == "table"]


def inline(text):
    text = escape(text.replace("\\*", "∗"))
    text = re.sub(r"`([^`]+)`", r"<code>\1</code>", text)
    text = re.sub(r"\*\*([^*]+)\*\*", r"<strong>\1</strong>", text)
    return re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)


def html(text, level):
    """level: the level of all headings."""
    made, paragraph, items, heading = [], [], [], "table"
    for kind, content in blocks(text):
        if kind == "item":
            items.append(f"<li>{inline(content)}</li>")
            continue
        if kind == "line" and content:
            paragraph.append(content)
            continue
        if paragraph:
            made.append(f"<p>{inline(' '.join(paragraph))}</p>")
        if items:
            made.append(f"<ul>{''.join(items)}</ul>")
        paragraph, items = [], []
        if kind == "table":
            made.append(content.html(heading))
        elif kind == "heading":
            heading = content
            made.append(f"<h{level}>{inline(heading)}</h{level}>")
    return "\n".join(made)
