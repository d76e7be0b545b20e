"""The stub says what the module has: names, members, parameters."""
import ast
import inspect

import dismantle


def public(names):
    return {n for n in names if not n.startswith("_") or n in ("__len__", "__getitem__", "__bool__")}


def stub_of(source):
    return ast.parse((source / "apps/python/dismantle/__init__.pyi").read_text())


def members_of_class(node):
    out = set()
    for item in node.body:
        if isinstance(item, (ast.FunctionDef,)):
            out.add(item.name)
        elif isinstance(item, ast.AnnAssign):
            out.add(item.target.id)
    return public(out)


def members_of(cls):
    own = [set(vars(c)) for c in cls.__mro__ if c.__module__.startswith("dismantle")]
    return public(set().union(*own))


def test_names(source):
    stub = stub_of(source)
    names = {n.name for n in stub.body if isinstance(n, (ast.ClassDef, ast.FunctionDef))}
    assert public(names) == set(dismantle.__all__)
    assert set(dismantle.__all__) == {n for n in vars(dismantle) if not n.startswith("_") and not inspect.ismodule(getattr(dismantle, n))}


def test_members(source):
    for node in stub_of(source).body:
        if not isinstance(node, ast.ClassDef):
            continue
        cls = getattr(dismantle, node.name)
        if issubclass(cls, tuple) or node.name == "Parameter":
            assert members_of_class(node) == set(inspect.signature(cls).parameters), node.name
            continue
        known = members_of(cls)
        if node.name == "Outcome":
            known = set(cls.__members__)
        if issubclass(cls, Exception):
            known = {n for n in known if n in vars(cls)}
        assert members_of_class(node) == known, node.name


def test_parameters_of_functions(source):
    for node in stub_of(source).body:
        if not isinstance(node, ast.FunctionDef) or not inspect.isfunction(getattr(dismantle, node.name)):
            continue
        written = [a.arg for a in node.args.args + node.args.kwonlyargs]
        signature = inspect.signature(getattr(dismantle, node.name))
        assert written == [p.name for p in signature.parameters.values() if p.kind != p.VAR_POSITIONAL], node.name


def test_everything_has_a_docstring():
    for name in dismantle.__all__:
        thing = getattr(dismantle, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for member in members_of(thing) - {"__len__", "__bool__"}:
                if issubclass(thing, (Exception, tuple)) or name in ("Outcome", "Parameter"):
                    continue
                assert inspect.getdoc(inspect.getattr_static(thing, member)), f"{name}.{member}"
