"""The scene as text: tables of keys, each with a comment that says where its value is from."""
_TEXT_COLUMN = 44  # where comments begin, if the line before is shorter


class SceneText:
    def __init__(self):
        self.lines = []

    def comment(self, text):
        self.lines.append(f"# {_plain(text)}" if text else "")

    def table(self, name):
        self.lines += ["", f"[{name}]" if not name.startswith("[") else name]

    def key(self, key, value, comment):
        rows = _matrix_rows(value)
        if rows:
            self.lines.append(f"{key} = [  # {_plain(comment)}")
            self.lines += [f"  {row}," for row in rows]
            self.lines.append("]")
            return
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
    largest = max((abs(v) for v in values), default=0.0)
    return [0.0 if abs(v) <= 1e-12 * max(largest, 1e-3) else float(v) for v in values]


def coefficients(matrix):
    """Six numbers for a diagonal, else 36 in rows."""
    if all(matrix[i][j] == 0.0 for i in range(6) for j in range(6) if i != j):
        return [matrix[i][i] for i in range(6)]
    return [value for row in matrix for value in row]


def _matrix_rows(value):
    if isinstance(value, list) and len(value) == 36:
        return [", ".join(map(text, value[6 * i : 6 * i + 6])) for i in range(6)]
    return None


def _plain(comment):
    return "".join(c if c.isprintable() else " " for c in comment)


def quaternion(q):
    sign = -1.0 if q[0] < 0 else 1.0
    return vector([sign * c for c in q])
