# SPDX-License-Identifier: BSD-3-Clause
"""Writes the type hints (.pyi) of the package vtknurbs, from its built modules.

    PYTHONPATH=... python3 makeStubs.py

VTK's generate_pyi does the modules; names of classes of other modules, which it leaves bare, are given
their module, so that type checkers find them. __init__.pyi names everything that the package gathers.
"""

import contextlib
import importlib
import inspect
import io
import os
import pkgutil
import re

import vtkmodules
import vtknurbs
from vtkmodules import generate_pyi


def homes_of_vtk_classes():
    """Class name to the vtkmodules module that defines it, of all modules that load here."""
    homes = {}
    for found in pkgutil.iter_modules(vtkmodules.__path__):
        if found.ispkg or not found.name.startswith("vtk"):
            continue
        try:
            module = importlib.import_module("vtkmodules." + found.name)
        except ImportError:
            continue  # built for libraries that are not there
        for name, value in vars(module).items():
            if inspect.isclass(value) and value.__module__ == module.__name__:
                homes[name] = module.__name__
    return homes


def module_stub(module, homes):
    """The hints of one extension module, with all foreign names qualified."""
    text = io.StringIO()
    generate_pyi.module_pyi(module, text)
    imports = set()

    def qualify(match):
        name = match[1]
        if name in vars(module):
            return match[0]
        if name not in homes:
            return "Any"  # a class that is not wrapped
        imports.add(homes[name])
        return "'" + homes[name] + "." + name + "'"

    # Type variables would have to occur twice in a method, which these do not.
    text = re.sub(r"^(Buffer|Pointer|Template) = .*$", r"\1 = Any", text.getvalue(), flags=re.M)
    body = re.sub(r"'(vtk\w+)'", qualify, text)
    known = set(re.findall(r"^import (\S+)$", body, re.M))
    return "".join(f"import {name}\n" for name in sorted(imports - known)) + body


def package_stub():
    """The hints of the package itself."""
    lines = []
    for extension in vtknurbs._EXTENSIONS:
        names = [name for name in dir(importlib.import_module("vtknurbs." + extension))
                 if name.startswith("vtkNURBS")]  # fmt: skip
        lines += [f"from .{extension} import {name} as {name}" for name in names]
    for module, names in vtknurbs._HELPERS.items():
        lines += [f"from .{module} import {name} as {name}" for name in names]
    return "\n".join(lines) + "\n\n__version__: str\n__all__: list[str]\n"


def write(folder, name, text):
    """Leaves a file that is right already as it is, for those who look at times."""
    path = os.path.join(folder, name)
    with contextlib.suppress(OSError), open(path, encoding="utf-8") as old:
        if old.read() == text:
            return
    with open(path, "w", encoding="utf-8") as new:
        new.write(text)


def main():
    folder = os.path.dirname(vtknurbs.__file__)
    homes = homes_of_vtk_classes()
    for extension in vtknurbs._EXTENSIONS:
        module = importlib.import_module("vtknurbs." + extension)
        write(folder, extension + ".pyi", module_stub(module, homes))
    write(folder, "__init__.pyi", package_stub())
    write(folder, "py.typed", "")


if __name__ == "__main__":
    main()
