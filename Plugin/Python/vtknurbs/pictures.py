# SPDX-License-Identifier: BSD-3-Clause
"""Pictures without a display: models and what filters make of them, drawn through EGL."""

from typing import Any, Optional, Sequence, Tuple

import numpy as np
from vtkmodules import vtkRenderingOpenGL2  # noqa: F401, makes vtkRenderer draw with OpenGL
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkAlgorithmOutput
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkMapper,
    vtkPolyDataMapper,
    vtkProp,
    vtkRenderer,
    vtkWindowToImageFilter,
)

try:
    from vtkmodules.vtkRenderingOpenGL2 import vtkCompositePolyDataMapper2 as CompositeMapper
except ImportError:  # VTK 9.3 and later
    from vtkmodules.vtkRenderingCore import vtkCompositePolyDataMapper as CompositeMapper

from .surfaces import blocks, models
from .vtkNURBSFiltersCore import vtkNURBSModel
from .vtkNURBSRenderingEGL import vtkNURBSEGLRenderWindow
from .vtkNURBSRenderingOpenGL2 import vtkNURBSMapper

__all__ = ["grab", "make_actor", "make_window", "render"]

Vector = Sequence[float]


def make_actor(what: Any, color: Vector = (0.8, 0.82, 0.86)) -> vtkActor:
    """An actor of a filter, an output port, data or a mapper.

    Models are drawn exactly, by vtkNURBSMapper; polygons and lines by VTK's own mappers.
    The faces' own colours show where there are any (a cell array Color), else `color`, 0 to 1. Drawings
    (lines with Visibility, as vtkNURBSVisibleRegions gives them) are black where visible, else grey.
    """
    actor = vtkActor()
    actor.GetProperty().SetColor(*color)
    if isinstance(what, vtkMapper):
        actor.SetMapper(what)
        return actor
    actor.SetMapper(_mapper(what))
    if actor.GetMapper().GetArrayName() == "Visibility":
        actor.GetProperty().LightingOff()
        actor.GetProperty().RenderLinesAsTubesOn()  # without gaps where segments meet
        actor.GetProperty().SetLineWidth(1.8)
    return actor


def make_window(*things: Any, size: Tuple[int, int] = (800, 600), view: Vector = (1, -2, 1),
                up: Vector = (0, 0, 1), zoom: float = 1.0, parallel: bool = False,
                background: Vector = (1, 1, 1)) -> vtkNURBSEGLRenderWindow:  # fmt: skip
    """A window that needs no display, with all things in it; they are props or what make_actor takes.

    view  from the things to the viewer
    up    what points upwards in the picture
    zoom  1: all is in the picture
    """
    window = vtkNURBSEGLRenderWindow()
    window.AddObserver("ErrorEvent", lambda *_: None)  # GetErrorMessage tells it
    window.SetSize(*size)
    window.SetMultiSamples(0)  # exact pixels would cost several times as much; FXAA smooths them
    window.Initialize()
    if window.GetErrorMessage():
        raise RuntimeError("no picture: " + window.GetErrorMessage())
    renderer = vtkRenderer()
    renderer.SetBackground(*background)
    renderer.UseFXAAOn()
    for thing in things:
        renderer.AddViewProp(thing if isinstance(thing, vtkProp) else make_actor(thing))
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*view)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(*up)
    camera.SetParallelProjection(parallel)
    renderer.ResetCamera()
    camera.Zoom(zoom)
    window.AddRenderer(renderer)
    return window


def grab(window: Any, file: Optional[str] = None) -> np.ndarray:
    """What the window shows, drawn anew: (height, width, 3) bytes of RGB, the top row first. With
    `file` it is written as PNG, too."""
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    if file is not None:
        writer = vtkPNGWriter()
        writer.AddObserver("ErrorEvent", lambda *_: None)  # the error code tells it
        writer.SetInputConnection(image.GetOutputPort())
        writer.SetFileName(str(file))
        writer.Write()
        if writer.GetErrorCode():
            raise OSError(f"the picture {file} can't be written")
    width, height, _ = image.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(height, width, -1)[::-1, :, :3].copy()


def render(*things: Any, file: Optional[str] = None, **options: Any) -> np.ndarray:
    """A picture of things: grab(make_window(*things, **options), file)."""
    return grab(make_window(*things, **options), file)


def _mapper(what: Any) -> vtkMapper:
    port = what.GetOutputPort() if isinstance(what, vtkAlgorithm) else what
    data = what
    if isinstance(port, vtkAlgorithmOutput):
        port.GetProducer().Update(port.GetIndex())
        data = port.GetProducer().GetOutputDataObject(port.GetIndex())
    if not isinstance(data, vtkDataObject):
        raise TypeError(f"a {type(what).__name__} is no filter, output port, data object or mapper")
    leaves = blocks(data)
    if models(data):
        mapper = vtkNURBSMapper()
    elif isinstance(data, vtkPolyData):
        mapper = vtkPolyDataMapper()
    elif any(isinstance(leaf, vtkPolyData) for leaf in leaves):
        mapper = CompositeMapper()
    else:
        raise TypeError("there is no NURBS model and no vtkPolyData in it; "
                        "make an actor of it and give that")  # fmt: skip
    if isinstance(port, vtkAlgorithmOutput):
        mapper.SetInputConnection(port)
    else:
        mapper.SetInputDataObject(data)
    mapper.SetScalarModeToUseCellFieldData()
    if any(leaf.GetCellData().HasArray("Visibility") for leaf in leaves):
        mapper.SelectColorArray("Visibility")
        mapper.SetColorModeToMapScalars()
        mapper.SetLookupTable(_grey_and_black())
    elif any(leaf.GetCellData().HasArray(vtkNURBSModel.ColorName()) for leaf in leaves):
        mapper.SelectColorArray(vtkNURBSModel.ColorName())
    else:
        mapper.ScalarVisibilityOff()
    return mapper


def _grey_and_black() -> vtkLookupTable:
    """Colours of 0 and 1."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(2)
    table.SetTableValue(0, 0.75, 0.75, 0.75)
    table.SetTableValue(1, 0, 0, 0)
    return table
