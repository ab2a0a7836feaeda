"""An engineering drawing of a CAD model, with hidden lines: SVG and PDF of true curves.

    python3 drawing.py [FILE]     writes drawing.svg, drawing.pdf and drawing.png
"""

import sys

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

vtknurbs.render(regions.GetOutputPort(1), file="drawing.png", size=(480, 300),
                view=(0, 0, 1), up=(0, 1, 0), zoom=1.4)  # fmt: skip
