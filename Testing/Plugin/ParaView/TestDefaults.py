# SPDX-License-Identifier: BSD-3-Clause
"""Every property's default is the class's own, and every setting of a class has a property."""
import re

import session
from paraview import servermanager, simple
from session import FILTERS, load_plugin

import vtknurbs  # noqa: F401, so that Python sees the objects behind the proxies

# Settings of classes that panels leave out, and why.
LEFT_OUT = {
    "Lattice": "the second input does it",
    "Camera": "Direction and EyePoint tell the view",
}

load_plugin()
for name in FILTERS + ["NURBSCADReader", "NURBSShapeSource", "NURBSFromBezierCells"]:
    group = "filters" if name in FILTERS or name == "NURBSFromBezierCells" else "sources"
    definitions = servermanager.ProxyManager()
    proxy = definitions.NewProxy(group, name)
    assert proxy, name
    made = proxy.GetClientSideObject()
    fresh = made.NewInstance()
    checked = []
    properties = {}
    iterator = servermanager.PropertyIterator(servermanager._getPyProxy(proxy))
    for prop in iterator:
        key = iterator.GetKey()
        properties[key] = prop
        label = prop.GetXMLLabel()
        assert prop.GetDocumentation().GetDescription().strip(), (name, key)
        if not hasattr(prop, "GetNumberOfElements") or prop.GetInformationOnly():
            continue
        getter = getattr(fresh, "Get" + key, None)
        if getter is None or prop.GetRepeatCommand():
            continue
        value = getter()
        values = list(value) if isinstance(value, tuple) else [value]
        if value is None:
            continue
        default = [prop.GetElement(i) for i in range(prop.GetNumberOfElements())]
        if key == "Shape":
            assert default == [fresh.TEAPOT], "the panel starts with the teapot"
        else:
            assert default == values, (name, key, default, values)
        checked.append(key)
    # A setting is what has Set and Get of one name.
    for method in dir(made):
        match = re.fullmatch(r"Set([A-Z]\w+)", method)
        if not match or not hasattr(made, "Get" + match[1]) or "To" in match[1][1:]:
            continue
        setting = match[1]
        if getattr(type(made), method, None) is None or hasattr(
            servermanager.vtkAlgorithm if hasattr(servermanager, "vtkAlgorithm") else object, method
        ):
            continue
        if setting in properties or setting in LEFT_OUT:
            continue
        from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

        assert hasattr(vtkAlgorithm, method), "%s has no property %s" % (name, setting)
    print("%-26s %2d defaults" % (name, len(checked)))
    assert checked or name in ("NURBSFromBezierCells",), name
print("passed")
