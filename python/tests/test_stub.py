"""Tests that the type stub has every public name, and every parameter with its name, kind and default."""

import ast
import inspect
import os
import unittest

import limpid
from limpid import _rendering

STUB = os.path.join(os.path.dirname(limpid.__file__), "__init__.pyi")


def public(nodes):
    return {n.name: n for n in nodes if isinstance(n, (ast.FunctionDef, ast.ClassDef)) and not n.name.startswith("_")}


def described(function):
    """Returns (name, is keyword-only, has a default) for each parameter in the stub, without self and **options."""
    a = function.args
    plain = a.posonlyargs + a.args
    missing = len(plain) - len(a.defaults)
    result = [(p.arg, False, i >= missing) for i, p in enumerate(plain)]
    result += [(p.arg, True, d is not None) for p, d in zip(a.kwonlyargs, a.kw_defaults)]
    return [p for p in result if p[0] != "self"]


def actual(function):
    parameters = inspect.signature(function).parameters.values()
    return [(p.name, p.kind == p.KEYWORD_ONLY, p.default is not p.empty) for p in parameters
            if p.name != "self" and p.kind != p.VAR_KEYWORD]


class StubTest(unittest.TestCase):
    def setUp(self):
        with open(STUB) as file:
            self.stub = public(ast.parse(file.read()).body)

    def test_has_every_public_name(self):
        self.assertEqual(set(self.stub), set(limpid.__all__))

    def test_functions_have_the_same_parameters(self):
        for name in ("denoise", "denoise_shot", "explain_shot", "parameters", "compare", "builtin_scenes", "look_at",
                     "perspective"):
            self.assertEqual(described(self.stub[name]), actual(getattr(limpid, name)), name)

    def test_methods_have_the_same_parameters(self):
        for cls in ("Denoiser", "Device", "Error", "Network"):
            methods = {n.name: n for n in self.stub[cls].body if isinstance(n, ast.FunctionDef)}
            real = {n: v for n, v in vars(getattr(limpid, cls)).items() if n == "__init__" or not n.startswith("_")}
            self.assertEqual(set(methods), set(real), cls)
            for name, value in real.items():
                if not isinstance(value, property) and name != "denoise":
                    self.assertEqual(described(methods[name]), actual(value), f"{cls}.{name}")
        self.assertEqual([p[:2] for p in described(methods_of(self.stub["Denoiser"])["denoise"])],
                         [p[:2] for p in actual(limpid.Denoiser.denoise)])

    def test_renderers_options_are_those_of_render_and_render_sequence(self):
        real = {p[0] for p in actual(_rendering._Renderer.__init__)} - {"default_jitter"}
        self.assertEqual({p[0] for p in described(self.stub["render_sequence"])}, real | {"first"})
        self.assertEqual({p[0] for p in described(self.stub["render"])},
                         real - set(_rendering.OF_SEQUENCES))

    def test_everything_public_has_a_docstring(self):
        for name in limpid.__all__:
            value = getattr(limpid, name)
            self.assertTrue(inspect.getdoc(value), name)
            if inspect.isclass(value) and name != "Parameter":
                for method, member in vars(value).items():
                    if not method.startswith("_"):
                        self.assertTrue(inspect.getdoc(member), f"{name}.{method}")


def methods_of(cls):
    return {n.name: n for n in cls.body if isinstance(n, ast.FunctionDef)}


if __name__ == "__main__":
    unittest.main()
