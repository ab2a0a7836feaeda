"""A CAD model as glTF, for web pages and viewers: a node a part, metres, y up.

    python3 gltf.py [FILE]     writes gltf.gltf, which has all in it, and gltf.png
"""

import sys

from vtkmodules.vtkIOExport import vtkGLTFExporter

import vtknurbs

reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName((sys.argv[1:] or ["/usr/share/opencascade/data/step/linkrods.step"])[0])
tessellator = vtknurbs.vtkNURBSTessellator()
tessellator.SetInputConnection(reader.GetOutputPort())
tessellator.SetTolerance(1e-3)
tessellator.Update()

actors = []
for part in vtknurbs.blocks(tessellator.GetOutputDataObject(0)):
    part.GetPointData().SetTCoords(None)  # UV are surfaces' parameters, not places in a texture
    actor = vtknurbs.make_actor(part)
    actor.SetScale(1e-3)  # millimetres to metres
    actor.RotateX(-90)  # z up to y up
    actors.append(actor)
window = vtknurbs.make_window(*actors, size=(400, 280), view=(1, 1, 2), up=(0, 1, 0), zoom=1.4)
exporter = vtkGLTFExporter()
exporter.SetRenderWindow(window)
exporter.SetFileName("gltf.gltf")
exporter.InlineDataOn()
exporter.Write()
print(len(actors), "part(s),", tessellator.GetNumberOfTriangles(), "triangles")
vtknurbs.grab(window, "gltf.png")
