"""Plans in notebooks, and assemblies that can be pickled."""
import html
import weakref

from . import _core
from ._errors import InputError

_origins = weakref.WeakKeyDictionary()  # assembly: (function, arguments) that made it


class Shown:
    """A page in a notebook; see Plan.show()."""

    def __init__(self, page, height):
        self.page, self.height = page, int(height)

    def _repr_html_(self):
        return (f'<iframe srcdoc="{html.escape(self.page)}" style="width: 100%; height: {self.height}px; border: 0" '
                'sandbox="allow-scripts allow-downloads"></iframe>')


def _show(self, assembly, height=600):
    """The page of the plan, for the last line of a cell of a notebook. assembly: the one that the plan is for. height: pixels."""
    return Shown(self.page(assembly), height)


def _repr_html_(self):
    """What notebooks show: how it ended, and a row for each step."""
    rows = []
    for step in self.steps:
        note = "forced" if step.forced else "; ".join(v.reason for v in step.checks if v.reason)
        rows.append(f"<tr><td>{step.number}</td><td>{html.escape(', '.join(step.parts))}</td><td>{html.escape(note)}</td></tr>")
    left = [u.part for u in self.unsolved]
    return (f"<p>{html.escape(repr(self)[1:-1])}{html.escape('; left: ' + ', '.join(left)) if left else ''}</p>"
            f"<table><thead><tr><th>step</th><th>parts</th><th></th></tr></thead><tbody>{''.join(rows)}</tbody></table>")


def remember(assembly, function, *arguments, **keywords):
    """Returns the assembly, which can be pickled from now on as a call of `function`."""
    _origins[assembly] = (function, arguments, keywords)
    return assembly


def _restored(function, arguments, keywords, sha256):
    assembly = function(*arguments, **keywords)
    if assembly.sha256 != sha256:
        raise InputError(f"{assembly.source}: its files have changed since the assembly was pickled")
    return assembly


def _reduce(self):
    if self not in _origins:
        raise TypeError("only assemblies of load(), from_meshes() and from_sample() can be pickled")
    return _restored, (*_origins[self], self.sha256)


for _function, _name in ((_show, "show"), (_repr_html_, "_repr_html_")):
    _function.__name__, _function.__qualname__ = _name, f"Plan.{_name}"
    setattr(_core.Plan, _name, _function)
_core.Assembly.__reduce__ = _reduce
