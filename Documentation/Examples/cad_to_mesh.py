"""From a CAD file to a closed mesh that certifies how far it is from the exact surfaces.

    python3 cad_to_mesh.py [FILE]     writes cad_to_mesh.vtp and cad_to_mesh.png
"""

import sys

from vtkmodules.vtkFiltersCore import vtkFeatureEdges
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

import vtknurbs

reader = vtknurbs.vtkNURBSCADReader()
reader.SetFileName((sys.argv[1:] or ["/usr/share/opencascade/data/step/linkrods.step"])[0])
reader.SingleModelOn()
tessellator = vtknurbs.vtkNURBSTessellator()
tessellator.SetInputConnection(reader.GetOutputPort())
tessellator.SetTolerance(2e-3)  # of the model's diagonal
tessellator.MergePointsOn()
tessellator.Update()
print(tessellator.GetNumberOfTriangles(), "triangles of", tessellator.GetNumberOfFaces(), "faces;",
      f"certified to {tessellator.GetCertifiedError():.6f} mm, asked for",
      f"{tessellator.GetToleranceUsed():.6f} mm")  # fmt: skip
(mesh,) = vtknurbs.blocks(tessellator.GetOutputDataObject(0))
edges = vtkFeatureEdges()  # of one triangle only: a closed solid's mesh has none
edges.SetInputData(mesh)
edges.FeatureEdgesOff()
edges.NonManifoldEdgesOff()
edges.Update()
print(edges.GetOutput().GetNumberOfCells(), "open edges")

writer = vtkXMLPolyDataWriter()
writer.SetInputData(mesh)
writer.SetFileName("cad_to_mesh.vtp")
writer.SetDataModeToBinary()
writer.Write()
actor = vtknurbs.make_actor(tessellator)
actor.GetProperty().EdgeVisibilityOn()
actor.GetProperty().SetEdgeColor(0.3, 0.35, 0.5)
vtknurbs.render(actor, file="cad_to_mesh.png", size=(480, 300), view=(1, -1, 1), zoom=1.3)
