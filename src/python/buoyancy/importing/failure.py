"""The error that ends an import, and the report of what was changed and what was left out."""

_MAX_NAMES = 40  # in a sentence


class ImportFailure(Exception):
    """A model that cannot be imported; one line that says what was found, what is expected, and what to do."""


def fail(place, actual, expected, cause, hint):
    """Ends the import because of something at an element, or in a file."""
    text = f"{getattr(place, 'where', place)}: {actual}; expected {expected}. Likely cause: {cause}. {hint}."
    raise ImportFailure(" ".join(text.split()))


def one_of(names):
    names = list(names)
    more = f" and {len(names) - _MAX_NAMES} more" if len(names) > _MAX_NAMES else ""
    return f"one of: {', '.join(names[:_MAX_NAMES]) or 'none'}{more}"


def choose(root, candidates, preferred, name, kind):
    """Of pairs of a name and an element, the element that --model names; without it the only one of those preferred."""
    chosen = [pair for pair in candidates if pair[0] == name] if name else preferred
    if len(chosen) != 1:
        names = ", ".join(f"'{other}'" if other else f"one without a name, {e.source}" for other, e in preferred)
        wanted = f", {len(chosen)} of them named '{name}'" if name else ""
        unnamed = "" if all(other for other, _ in preferred) else ", and name it first if it has no name"
        fail(root, f"has {len(preferred)} {kind} to choose from ({names or 'none'}){wanted}", f"one of its {kind}",
             "a file with several vehicles, or a misspelt name", f"Choose one with --model NAME{unnamed}")
    return chosen[0][1]


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
