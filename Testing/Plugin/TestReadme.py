"""Runs the Python pipeline that README.md shows, as it stands there."""

import os
import re
import sys
import tempfile
from pathlib import Path

readme = Path(sys.argv[1]).read_text(encoding="utf-8")
pipelines = re.findall(r"^```python\n(.*?)^```", readme, re.MULTILINE | re.DOTALL)
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for pipeline in pipelines:
        exec(compile(pipeline, "README.md", "exec"), {})
    (mesh,) = Path(folder).glob("*.vtpc")
    from vtkmodules.vtkIOXML import vtkXMLPartitionedDataSetCollectionReader

    check = vtkXMLPartitionedDataSetCollectionReader()
    check.SetFileName(str(mesh))
    check.Update()
    triangles = check.GetOutput().GetNumberOfCells()
    assert triangles > 1000, triangles
print("README: the pipeline wrote", triangles, "triangles")
