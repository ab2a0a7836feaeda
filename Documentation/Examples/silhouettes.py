"""Silhouettes (red) and edges (blue) of a CAD model as exact curves, over its surfaces.

    python3 silhouettes.py [FILE]     writes silhouettes.png
"""

import sys

from vtkmodules.vtkRenderingCore import vtkRenderer

import vtknurbs

reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName((sys.argv[1:] or ["/usr/share/opencascade/data/step/linkrods.step"])[0])
window = vtknurbs.make_window(reader, size=(400, 280), zoom=1.6, parallel=True)
camera = window.GetRenderers().GetFirstRenderer().GetActiveCamera()
overlay = vtkRenderer()  # so that no line is hidden by the surface that it lies on
overlay.SetActiveCamera(camera)
overlay.SetLayer(1)
overlay.UseFXAAOn()
window.SetNumberOfLayers(2)
window.AddRenderer(overlay)
for color, silhouettes in (((0.1, 0.2, 0.5), False), ((0.8, 0.1, 0.1), True)):
    lines = vtknurbs.vtkNURBSSilhouette()
    lines.SetInputConnection(reader.GetOutputPort())
    lines.SetCamera(camera)
    lines.SetSilhouettes(silhouettes)
    lines.SetBoundaryEdges(not silhouettes)
    lines.SetSharpEdges(not silhouettes)
    actor = vtknurbs.make_actor(lines, color)
    actor.GetMapper().ScalarVisibilityOff()
    actor.GetProperty().SetLineWidth(1.8)
    actor.GetProperty().LightingOff()
    overlay.AddActor(actor)
    print(sum(block.GetNumberOfLines() for block in vtknurbs.blocks(lines.GetOutputDataObject(0))),
          "silhouettes" if silhouettes else "edges")  # fmt: skip
vtknurbs.grab(window, "silhouettes.png")
