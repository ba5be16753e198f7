"""Reads XML files into elements that know their line, within limits, and without entities or document types.

An entity can make a short file long or name another file, and no format that is read here needs any. So expat is
given handlers that refuse them, which is what defusedxml does too; that one keeps no line numbers.
"""
import math
import xml.parsers.expat
from pathlib import Path

from .failure import ImportFailure, fail

MAX_BYTES = 32 * 1024 * 1024  # of all files of a model
MAX_DEPTH = 200
MAX_ELEMENTS = 1_000_000


class Element:
    """An element with its attributes, its own text, its children, and where it is."""

    __slots__ = ("tag", "attributes", "text", "children", "file", "line")

    def __init__(self, tag, attributes, file, line):
        self.tag, self.attributes, self.text, self.children = tag, attributes, "", []
        self.file, self.line = file, line

    @property
    def where(self):
        return f"{self.file}:{self.line}"

    @property
    def source(self):
        """The place in a comment: the name of the file alone."""
        return f"{Path(self.file).name}:{self.line}"

    def get(self, name, default=None):
        return self.attributes.get(name, default)

    def find(self, path):
        """The first element on a path of tags, such as "inertial/mass", or None."""
        element = self
        for tag in path.split("/"):
            element = next((child for child in element.children if child.tag == tag), None)
            if element is None:
                return None
        return element

    def all(self, *tags):
        return [child for child in self.children if child.tag in tags]

    def walk(self):
        yield self
        for child in self.children:
            yield from child.walk()

    def child_text(self, path, default=None):
        found = self.find(path)
        return default if found is None or not found.text.strip() else found.text.strip()

    def numbers(self, count=None, text=None, what=None):
        """The numbers in the text; `count` is how many, or a tuple of what is allowed."""
        words = (self.text if text is None else text).replace(",", " ").split()
        what = what or f"<{self.tag}>"
        try:
            values = [float(word) for word in words]
        except ValueError:
            values = None
        if values is None or not all(map(math.isfinite, values)):
            fail(self.where, f"{what} is '{_short(' '.join(words))}'", "finite numbers separated by spaces",
                 "a template that was not expanded, or a misspelt number", "Write the numbers out")
        allowed = (count,) if isinstance(count, int) else count
        if allowed and len(values) not in allowed:
            fail(self.where, f"{what} has {len(values)} numbers", " or ".join(map(str, allowed)),
                 "numbers that are missing or too many", "Correct the model")
        return values

    def number(self, path, default=None):
        found = self.find(path)
        return default if found is None or not found.text.strip() else found.numbers(1)[0]

    def flag(self, path, default=False):
        return self.child_text(path, str(default)).lower() in ("true", "1")

    def attribute_numbers(self, name, count=None, default=None):
        if name not in self.attributes:
            return default
        return self.numbers(count, self.attributes[name], f"{name} of <{self.tag}>")


def _short(text):
    return text if len(text) <= 60 else text[:57] + "..."


class XmlReader:
    """Reads files; the limits are for all of them together."""

    def __init__(self):
        self.bytes = self.elements = 0

    def read(self, path):
        path = Path(path)
        try:
            if path.is_fifo() or path.is_socket():
                raise ImportFailure(f"{path}: cannot be read: not a regular file")
            with open(path, "rb") as file:
                data = file.read(MAX_BYTES - self.bytes + 1)
        except OSError as error:
            raise ImportFailure(f"{path}: cannot be read: {error.strerror}") from None
        self.bytes += len(data)
        if self.bytes > MAX_BYTES:
            fail(path, f"more than {MAX_BYTES // 2 ** 20} MiB of XML", "a model of at most this size",
                 "data in the model, or files that include each other", "Keep data in files of their own")
        return self._parse(data, path)

    def _parse(self, data, path):
        parser = xml.parsers.expat.ParserCreate()
        parser.buffer_text = True
        root, stack = [], []

        def refuse(kind):
            fail(f"{path}:{parser.CurrentLineNumber}", f"has {kind}", "XML without entities and document types",
                 "a file that was made to exhaust memory or to read other files", "Remove the <!DOCTYPE ...>")

        def start(tag, attributes):
            self.elements += 1
            if len(stack) >= MAX_DEPTH or self.elements > MAX_ELEMENTS:
                fail(f"{path}:{parser.CurrentLineNumber}", "too many elements",
                     f"at most {MAX_ELEMENTS:,}, nested at most {MAX_DEPTH} deep",
                     "a file that was made to exhaust " "memory", "Use a smaller model")
            element = Element(tag, attributes, str(path), parser.CurrentLineNumber)
            (stack[-1].children if stack else root).append(element)
            stack.append(element)

        def characters(text):
            if stack:
                stack[-1].text += text

        def doctype(name, system_id, public_id, has_internal_subset):
            if system_id or public_id or has_internal_subset:
                refuse("a document type")

        parser.StartElementHandler = start
        parser.EndElementHandler = lambda tag: stack.pop()
        parser.CharacterDataHandler = characters
        parser.StartDoctypeDeclHandler = doctype
        parser.EntityDeclHandler = lambda *arguments: refuse("an entity")
        parser.ExternalEntityRefHandler = lambda *arguments: refuse("an external entity")
        try:
            parser.Parse(data, True)
        except xml.parsers.expat.ExpatError as error:
            fail(f"{path}:{error.lineno}", f"is not XML ({xml.parsers.expat.ErrorString(error.code)})",
                 "an SDF, URDF or MJCF file",
                 "a template (.erb, .xacro, Jinja), a value without quotes, or a bare & or < in a text",
                 "Expand the template, or correct this line: Gazebo's own reader is less strict")
        return root[0]
