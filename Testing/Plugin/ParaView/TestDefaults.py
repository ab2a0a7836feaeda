# SPDX-License-Identifier: BSD-3-Clause
"""Every property's default is its class's own, every setting of a class has a property."""
from paraview import servermanager
from session import FILTERS, load_plugin

import vtknurbs  # noqa: F401, so that Python sees the classes of the objects behind the proxies

# Settings that have no property of their own.
LEFT_OUT = {
    "vtkNURBSControlPointEdits": ["BlockControlPointWeight"],  # A table.
    "vtkNURBSFreeFormDeformation": ["Lattice", "LatticeDisplacement"],  # An input, a table.
    "vtkNURBSSilhouette": ["Camera"],  # Direction and EyePoint tell the view.
    "vtkNURBSVisibleRegions": ["Camera"],  # Likewise.
}
# Objects and strings that are null at first.
WITHOUT_DEFAULT = {"Camera", "FileName", "Title", "Source", "View"}


def is_ours(python_class):
    return python_class.__module__.startswith("vtknurbs")


def settings(made):
    """Names with a Set and a Get in our own classes."""
    classes = type(made).__mro__
    own = {n for c in classes if is_ours(c) for n in vars(c)}
    inherited = {n for c in classes if not is_ours(c) for n in vars(c)}
    names = {n[3:] for n in own - inherited if n.startswith("Set")}
    return {n for n in names if "Get" + n in own} - set(LEFT_OUT.get(type(made).__name__, []))


def check_defaults(name, prop, key, fresh):
    """True if the property has a default to compare."""
    value = getattr(fresh, "Get" + key, lambda: None)()
    if value is None or prop.GetInformationOnly() or prop.IsA("vtkSMProxyProperty"):
        return False
    default = [prop.GetElement(i) for i in range(prop.GetNumberOfElements())]
    if key == "Shape":
        assert default == [fresh.TEAPOT], "the panel starts with the teapot"
    else:
        assert default == (list(value) if isinstance(value, tuple) else [value]), (name, key)
    return True


load_plugin()
names = [("filters", name) for name in FILTERS + ["NURBSFromBezierCells"]]
names += [("sources", "NURBSCADReader"), ("sources", "NURBSShapeSource")]
names += [("writers", "NURBS%sWriter" % kind) for kind in ("Drawing", "STEP", "IGES", "BREP")]
for group, name in names:
    proxy = servermanager.ProxyManager().NewProxy(group, name)
    made = proxy.GetClientSideObject()
    fresh = type(made)()
    properties = {}
    iterator = proxy.NewPropertyIterator()
    iterator.Begin()
    while not iterator.IsAtEnd():
        properties[iterator.GetKey()] = iterator.GetProperty()
        iterator.Next()
    assert proxy.GetDocumentation().GetDescription().strip(), name
    for key, prop in properties.items():
        assert prop.GetDocumentation().GetDescription().strip(), (name, key)
    labels = [p.GetXMLLabel() for p in properties.values()]
    assert len(set(labels)) == len(labels), (name, labels)
    checked = sum(check_defaults(name, p, key, fresh) for key, p in properties.items())
    wanted = settings(made)
    assert wanted <= set(properties), (name, wanted - set(properties))
    assert checked >= len(wanted - WITHOUT_DEFAULT), (name, checked, wanted)
    print("%-26s %2d settings, %2d defaults" % (name, len(wanted), checked))
print("passed")
