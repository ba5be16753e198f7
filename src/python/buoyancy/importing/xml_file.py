"""Reads XML files into elements that know their line, within limits, and without entities or document types.

An entity can make a short file long or name another file, and no format that is read here needs any. So expat is
given a handler that refuses what declares them, as defusedxml does too; that one keeps no line numbers.
"""
import copy
import math
import xml.parsers.expat
from pathlib import Path

from .failure import ImportFailure, fail

MAX_BYTES = 32 * 1024 * 1024  # of all files of a model
MAX_DEPTH = 200
MAX_ELEMENTS = 1_000_000
_MAX_NUMBER = 1e12  # products of several of these are finite


class Element:
    """An element with its attributes, its own text, its children, and where it is."""

    __slots__ = ("tag", "attributes", "text", "children", "parent", "file", "line")

    def __init__(self, tag, attributes, parent, file, line):
        self.tag, self.attributes, self.text, self.children = tag, attributes, "", []
        self.parent, self.file, self.line = parent, file, line

    @property
    def where(self):
        """The place in an error: file, line and path, such as model.sdf:7: /sdf/model[boat]/link[base]/pose."""
        path, element = "", self
        while element is not None:
            name = element.get("name")
            path, element = f"/{element.tag}[{name}]{path}" if name else f"/{element.tag}{path}", element.parent
        return f"{self.file}:{self.line}: {path}"

    @property
    def source(self):
        """The place in a comment: the name of the file alone."""
        return f"{Path(self.file).name}:{self.line}"

    @property
    def depth(self):
        return self.parent.depth + 1 if self.parent else 0

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

    def _value(self, path):
        """An attribute, or else the text of a child or (path "") of the element: element, name, text or None."""
        *steps, name = path.split("/")
        holder = self.find("/".join(steps)) if steps else self
        if holder is not None and name in holder.attributes:
            return holder, f"{name} of <{holder.tag}>", holder.attributes[name]
        found = holder.find(name) if name and holder is not None else holder
        return (None, "", None) if found is None else (found, f"<{found.tag}>", found.text.strip() or None)

    def text_of(self, path, default=""):
        text = self._value(path)[2]
        return default if text is None else text.strip()

    def flag(self, path):
        return self.text_of(path).lower() in ("true", "1")

    def numbers(self, path="", count=None, default=None, minimum=-math.inf):
        """The numbers that a path leads to; `count` is how many, or a tuple of what is allowed."""
        element, what, text = self._value(path)
        if text is None:
            return default
        words = text.replace(",", " ").split()
        try:
            values = [float(word) for word in words]
        except ValueError:
            values = None
        if values is None or not all(abs(value) <= _MAX_NUMBER for value in values):
            found = " ".join(words)
            fail(element, f"{what} is '{found if len(found) <= 60 else found[:57] + '...'}'",
                 f"finite numbers up to {_MAX_NUMBER:g} separated by spaces",
                 "a template that was not expanded, or a misspelt number", "Write the numbers out")
        allowed = (count,) if isinstance(count, int) else count
        if allowed and len(values) not in allowed:
            fail(element, f"{what} has {len(values)} numbers", " or ".join(map(str, allowed)),
                 "numbers that are missing or too many", "Correct the model")
        if any(value < minimum for value in values):
            fail(element, f"{what} is {', '.join(f'{value:g}' for value in values)}", f"at least {minimum:g}",
                 "a mistyped sign", "Correct the model")
        return values

    def number(self, path="", default=None, minimum=-math.inf):
        values = self.numbers(path, 1, None, minimum)
        return values[0] if values else default

    def with_attributes(self, attributes):
        """The same element with other attributes."""
        result = copy.copy(self)
        result.attributes = attributes
        return result


class XmlReader:
    """Reads files; the limits are for all of them together."""

    def __init__(self):
        self.bytes = self.elements = 0

    def read(self, path, element=None):
        """The root element of a file. `element` of another one names it, and counts as what contains it."""
        path = Path(path)
        where = f"{element.where}: {path}" if element else path
        try:
            if path.is_fifo() or path.is_socket():
                raise ImportFailure(f"{where}: cannot be read: not a regular file")
            with open(path, "rb") as file:
                data = file.read(MAX_BYTES - self.bytes + 1)
        except OSError as error:
            raise ImportFailure(f"{where}: cannot be read: {error.strerror}") from None
        self.bytes += len(data)
        if self.bytes > MAX_BYTES:
            fail(where, f"more than {MAX_BYTES // 2 ** 20} MiB of XML", "a model of at most this size",
                 "data in the model, or files that include each other", "Keep data in files of their own")
        return self._parse(data, path, element)

    def _parse(self, data, path, parent):
        parser = xml.parsers.expat.ParserCreate()
        parser.buffer_text = True
        depth, root, stack = parent.depth + 1 if parent else 0, [], []

        def start(tag, attributes):
            self.elements += 1
            if depth + len(stack) >= MAX_DEPTH or self.elements > MAX_ELEMENTS:
                fail(f"{path}:{parser.CurrentLineNumber}", "elements are nested too deeply, or are too many",
                     f"at most {MAX_ELEMENTS:,}, nested at most {MAX_DEPTH} deep",
                     "a model that includes itself, or a file that was made to exhaust memory",
                     "Break the cycle, or use a smaller model")
            outer = stack[-1][0] if stack else parent
            element = Element(tag, attributes, outer, str(path), parser.CurrentLineNumber)
            (outer.children if stack else root).append(element)
            stack.append((element, []))

        def end(tag):
            element, pieces = stack.pop()
            element.text = "".join(pieces)

        def characters(text):
            if stack:
                stack[-1][1].append(text)

        def doctype(name, system_id, public_id, has_internal_subset):
            # Entities are declared in one of these.
            if system_id or public_id or has_internal_subset:
                fail(f"{path}:{parser.CurrentLineNumber}", "has a document type",
                     "XML without entities and document types",
                     "a file that was made to exhaust memory or to read other files", "Remove the <!DOCTYPE ...>")

        parser.StartElementHandler = start
        parser.EndElementHandler = end
        parser.CharacterDataHandler = characters
        parser.StartDoctypeDeclHandler = doctype
        try:
            parser.Parse(data, True)
        except (xml.parsers.expat.ExpatError, LookupError, ValueError) as error:  # the latter two: of its encoding
            fail(f"{path}:{parser.CurrentLineNumber}", f"is not XML ({error})", "an SDF, URDF or MJCF file",
                 "a template (.erb, .xacro, Jinja), a value without quotes, or a bare & or < in a text",
                 "Expand the template, or correct this line: Gazebo's own reader is less strict")
        return root[0]
