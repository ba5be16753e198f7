"""Python values as TOML, so that a Sea takes the keys, the ranges and the errors of the scene file."""
import json
import os

_MAX_DEPTH = 16  # of tables within tables; a list may contain itself


def line(key, value):
    """Return "key = value" and a line break, in UTF-8.

    A dict becomes an inline table, a list, a tuple or a numpy array an array; numbers keep every bit. Raises TypeError
    for a value that TOML does not have.
    """
    return f"{_quoted(key)} = {_text(value, key, 0)}\n".encode()


def _quoted(text):
    # JSON escapes as TOML does, but for one control character.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _text(value, name, depth):
    if depth > _MAX_DEPTH:
        raise ValueError(f"{name} has tables or lists within each other without end")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, int):
        return int.__repr__(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, dict):
        pairs = (f"{_quoted(str(key))} = {_text(element, str(key), depth + 1)}" for key, element in value.items())
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_text(element, name, depth + 1) for element in value) + "]"
    if hasattr(value, "__fspath__"):
        return _quoted(os.fspath(value))
    if hasattr(value, "tolist"):  # of numpy's arrays and scalars
        return _text(value.tolist(), name, depth + 1)
    actual = "None" if value is None else f"a {type(value).__name__}"
    raise TypeError(f"{name} is {actual}; expected a value of the scene file: a number, text, a list or a dict")
