"""The stubs and the docstrings describe what the module has."""
import ast
import inspect
import unittest
from pathlib import Path

import buoyancy
from support import TestCase


def public(names):
    return {name for name in names if not name.startswith("_")}


class DescribesItself(TestCase):
    @classmethod
    def setUpClass(cls):
        stub = ast.parse(Path(buoyancy.__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
        cls.definitions = {node.name: node for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}

    def test_stubs_have_every_name(self):
        self.assertEqual(set(self.definitions), set(buoyancy.__all__))
        for name, node in self.definitions.items():
            actual = getattr(buoyancy, name)
            if not isinstance(node, ast.ClassDef) or issubclass(actual, (Exception, int)):
                continue
            stubbed = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
            stubbed |= {member.target.id for member in node.body if isinstance(member, ast.AnnAssign)}
            self.assertEqual(public(stubbed), public(vars(actual)), name)
        constants = {target.id for member in self.definitions["Status"].body for target in member.targets}
        self.assertEqual(constants, set(buoyancy.Status.__members__))

    def test_stubs_have_every_parameter(self):
        for name, node in self.definitions.items():
            methods = [node] if isinstance(node, ast.FunctionDef) else node.body
            for method in methods:
                decorated = getattr(method, "decorator_list", None)
                if not isinstance(method, ast.FunctionDef) or method.name.startswith("_") or decorated:
                    continue
                actual = getattr(buoyancy, name) if method is node else getattr(getattr(buoyancy, name), method.name)
                parameters = [each for each in inspect.signature(actual).parameters if each != "self"]
                stubbed = [each.arg for each in method.args.args + method.args.kwonlyargs if each.arg != "self"]
                self.assertEqual(stubbed, parameters, f"{name}.{method.name}")

    def test_everything_has_a_docstring(self):
        for name in buoyancy.__all__:
            actual = getattr(buoyancy, name)
            self.assertTrue(actual.__doc__, name)
            self.assertEqual(actual.__module__, "buoyancy")
            if not isinstance(actual, type) or issubclass(actual, (Exception, int)):
                continue
            for member in public(vars(actual)):
                self.assertTrue(getattr(actual, member).__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
