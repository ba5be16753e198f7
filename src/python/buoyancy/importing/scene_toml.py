"""The scene as text: tables of keys, each with a comment that says where its value is from."""
import numpy as np

_TEXT_COLUMN = 44  # where comments begin, if the line before is shorter


class SceneText:
    def __init__(self):
        self.lines = []

    def comment(self, text):
        self.lines.append(f"# {_plain(text)}" if text else "")

    def table(self, name):
        self.lines += ["", f"[{name}]" if not name.startswith("[") else name]

    def key(self, key, value, comment):
        if isinstance(value, list) and len(value) == 36:
            rows = [f"  {', '.join(map(text, value[i : i + 6]))}," for i in range(0, 36, 6)]
            self.lines += [f"{key} = [  # {_plain(comment)}", *rows, "]"]
        else:
            self.lines.append(f"{f'{key} = {text(value)}':<{_TEXT_COLUMN}} # {_plain(comment)}")

    def __str__(self):
        return "\n".join(self.lines).strip() + "\n"


def text(value):
    """A value of TOML."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {text(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(text, value)) + "]"
    if isinstance(value, str):
        escaped = "".join(c if c >= " " and c not in '"\\\x7f' else f"\\u{ord(c):04X}" for c in value)
        return f'"{escaped}"'
    if isinstance(value, float):
        return number(value)
    return str(value)


def number(value):
    """A number of twelve digits: angles such as 1.5708 rad would otherwise leave their rounding in every entry."""
    short = float(f"{value:.12g}")
    return repr(int(short)) if short == int(short) and abs(short) < 1e15 else repr(short)


def vector(values):
    """Numbers in which those that are nothing but rounding are 0."""
    largest = max(map(abs, values))
    return [0.0 if abs(v) <= 1e-12 * max(largest, 1e-3) else float(v) for v in values]


def coefficients(matrix):
    """Six numbers for a diagonal, else 36 in rows."""
    diagonal = np.diag(matrix)
    return list(matrix.flat if (matrix - np.diag(diagonal)).any() else diagonal)


def _plain(comment):
    return "".join(c if c.isprintable() else " " for c in comment)
