"""The error that ends an import, and the report of what was changed and what was left out."""


class ImportFailure(Exception):
    """A model that cannot be imported; one line that says what was found, what is expected, and what to do."""


def fail(where, actual, expected, cause, hint):
    text = f"{where}: {actual}; expected {expected}. Likely cause: {cause}. {hint}."
    raise ImportFailure(" ".join(text.split()))


class Report:
    """Three sets of sentences, in the order in which they are said first."""

    def __init__(self):
        self.notes, self.warnings, self.not_converted = {}, {}, {}

    def note(self, text):
        _append(self.notes, text)

    def warn(self, text):
        _append(self.warnings, text)

    def leave_out(self, text):
        _append(self.not_converted, text)


def _append(sentences, text):
    sentences[" ".join(text.split())] = None
