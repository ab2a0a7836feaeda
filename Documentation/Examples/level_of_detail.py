"""Levels of detail by wavelets: surfaces are evaluated once, then any level or budget is at hand.

    python3 level_of_detail.py     writes level_of_detail.png
"""

import vtknurbs

source = vtknurbs.vtkNURBSShapeSource()
source.SetShapeToTeapot()
levels = vtknurbs.vtkNURBSWaveletLOD()
levels.SetInputConnection(source.GetOutputPort())
levels.SetModeToTriangleBudget()

actors = []
for place, budget in enumerate((8000, 2000, 500)):
    levels.SetTriangleBudget(budget)
    levels.Update()
    print(f"{levels.GetNumberOfTriangles()} triangles of at most {budget}, within",
          f"{levels.GetErrorBound():.5f}; evaluated: {levels.GetAnalyseSeconds() > 0}")  # fmt: skip
    mesh = levels.GetOutputDataObject(0).NewInstance()
    mesh.DeepCopy(levels.GetOutputDataObject(0))
    actor = vtknurbs.make_actor(mesh)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.3, 0.35, 0.5)
    actor.AddPosition(6.5 * place, 0, 0)
    actors.append(actor)
vtknurbs.render(*actors, file="level_of_detail.png", size=(640, 240), view=(0, -3, 1), zoom=2.4)
