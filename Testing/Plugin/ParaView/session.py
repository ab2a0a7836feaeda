# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts share that test the plugin in pvpython and pvbatch.

Each is run as `pvpython SCRIPT PLUGIN FOLDER`: the plugin's library, and a folder to write to.
"""
import os
import sys

import paraview

paraview.compatibility.major, paraview.compatibility.minor = 5, 11

from paraview import simple  # noqa: E402

LINKRODS = "/usr/share/opencascade/data/step/linkrods.step"
SCREW = "/usr/share/opencascade/data/step/screw.step"
PLUGIN, FOLDER = sys.argv[1:3]
BASELINES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../Data/Baselines")

# Every filter of the plugin whose input is a model.
FILTERS = [
    "NURBSControlNet",
    "NURBSControlPointEdits",
    "NURBSDeformingTessellator",
    "NURBSFreeFormDeformation",
    "NURBSRefinement",
    "NURBSSilhouette",
    "NURBSTessellator",
    "NURBSToBezierCells",
    "NURBSVisibleRegions",
    "NURBSWaveletLOD",
]


def load_plugin():
    simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))


def path(name):
    os.makedirs(FOLDER, exist_ok=True)
    return os.path.join(FOLDER, name)


def updated(proxy):
    """The proxy, updated and with its information-only properties."""
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()
    return proxy


def size(proxy, port=0):
    """Numbers of cells and points of an output."""
    information = proxy.GetDataInformation(port).DataInformation
    return information.GetNumberOfCells(), information.GetNumberOfPoints()


def leaves(proxy, port=0):
    """The data sets of an output."""
    data = proxy.GetClientSideObject().GetOutputDataObject(port)
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    found = []
    iterator = data.NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        found.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return found


class Messages:
    """Keeps the errors and warnings of VTK while it is entered."""

    def __enter__(self):
        from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

        self.kept = vtkOutputWindow.GetInstance()
        self.window = vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        from vtkmodules.vtkCommonCore import vtkOutputWindow

        vtkOutputWindow.SetInstance(self.kept)
        self.text = self.window.GetOutput()


def baseline_difference(file, name):
    """About the number of pixels in which a PNG differs from Data/Baselines/ParaView-<name>.png.

    By vtkImageDifference, which forgives shifts by a pixel, as between two drivers' rasterisers, and
    here differences of colour up to 16 of 255.
    """
    from vtkmodules.vtkImagingCore import vtkImageDifference
    from vtkmodules.vtkIOImage import vtkPNGReader

    images = []
    for png in (file, os.path.join(BASELINES, "ParaView-%s.png" % name)):
        assert os.path.exists(png), png
        reader = vtkPNGReader()
        reader.SetFileName(png)
        reader.Update()
        images.append(reader.GetOutput())
    assert images[0].GetDimensions() == images[1].GetDimensions(), name
    difference = vtkImageDifference()
    difference.SetInputData(images[0])
    difference.SetImageData(images[1])
    difference.SetThreshold(16)
    difference.Update()
    return difference.GetThresholdedError()
