"""An engineering drawing of a CAD model, with hidden lines: SVG and PDF of true curves.

    python3 drawing.py [FILE]     writes drawing.svg, drawing.pdf and drawing.png
"""

import sys

from vtkmodules.vtkCommonCore import vtkLookupTable

import vtknurbs

file = (sys.argv[1:] or ["/usr/share/opencascade/data/step/linkrods.step"])[0]
reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName(file)
regions = vtknurbs.vtkNURBSVisibleRegions()
regions.SetInputConnection(reader.GetOutputPort())
regions.SetDirection(1, -2, 1)  # towards the viewer
regions.ProjectLinesOn()  # to the plane of the drawing, true to size
for name in ("drawing.svg", "drawing.pdf"):
    writer = vtknurbs.vtkNURBSDrawingWriter()
    writer.SetInputConnection(regions.GetOutputPort(1))
    writer.SetFileName(name)
    writer.SetSource(file)
    writer.Write()
print(regions.GetNumberOfVisibleLines(), "of", regions.GetNumberOfLines(), "lines are visible;",
      writer.GetNumberOfVisiblePaths(), "paths of", writer.GetNumberOfCurves(), "curves and",
      writer.GetNumberOfStraightLines(), "straight lines, with the hidden ones")  # fmt: skip

black = vtkLookupTable()  # of Visibility: 0 hidden, 1 visible
black.SetNumberOfTableValues(2)
black.SetTableValue(0, 0.75, 0.75, 0.75)
black.SetTableValue(1, 0, 0, 0)
actor = vtknurbs.make_actor(regions.GetOutputPort(1))
actor.GetMapper().ScalarVisibilityOn()
actor.GetMapper().SetScalarModeToUseCellFieldData()
actor.GetMapper().SelectColorArray("Visibility")
actor.GetMapper().SetColorModeToMapScalars()
actor.GetMapper().SetLookupTable(black)
actor.GetProperty().LightingOff()
vtknurbs.render(actor, file="drawing.png", size=(480, 300), view=(0, 0, 1), up=(0, 1, 0), zoom=1.4)
