"""A user's script: a CAD file tessellated by the vtknurbs that is installed below PREFIX.

    pipeline.py PREFIX FILE
"""

import sys
from pathlib import Path

import vtknurbs

prefix, file = sys.argv[1:]
assert Path(prefix) in Path(vtknurbs.__file__).parents, vtknurbs.__file__
reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName(file)
tessellator = vtknurbs.vtkNURBSTessellator()
tessellator.SetInputConnection(reader.GetOutputPort())
tessellator.Update()
assert 0 < tessellator.GetCertifiedError() <= tessellator.GetToleranceUsed()
print(tessellator.GetNumberOfTriangles(), "triangles")
