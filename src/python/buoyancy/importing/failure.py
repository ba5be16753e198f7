"""The error that ends an import, and the report of what was changed and what was left out."""


class ImportFailure(Exception):
    """A model that cannot be imported; one line that says what was found, what is expected, and what to do."""


def fail(where, actual, expected, cause, hint):
    text = f"{where}: {actual}; expected {expected}. Likely cause: {cause}. {hint}."
    raise ImportFailure(" ".join(text.split()))


def one_of(names):
    return f"one of: {', '.join(names) or 'none'}"


class Report:
    """Three sets of sentences, in the order in which they are said first; each may name the source of an element."""

    def __init__(self):
        self.notes, self.warnings, self.not_converted = {}, {}, {}

    def note(self, text, element=None):
        _add(self.notes, text, element)

    def warn(self, text, element=None):
        _add(self.warnings, text, element)

    def leave_out(self, text, element=None):
        _add(self.not_converted, text, element)


def _add(sentences, text, element):
    sentences[" ".join(text.split()) + (f" ({element.source})" if element else "")] = None
