# SPDX-License-Identifier: BSD-3-Clause
"""Runs 'vtknurbs convert': the same surfaces as STEP, IGES, BREP and VTK's own formats."""

import json
import sys
import unittest

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

import TestCommandLine
from TestCommandLine import LINKRODS, SCREW, Folder, read, tool


class Convert(Folder):
    """The command convert."""

    def convert(self, model, name, *options, code=0):
        """Converts to self.folder/name; the path and the report."""
        path, report = self.folder / name, self.folder / "r.json"
        self.out, self.err = tool(
            "convert", model, "-o", path, "--report", report, *options, code=code
        )
        return path, json.loads(report.read_text())

    def info(self, model):
        report = self.folder / "i.json"
        tool("info", model, "--report", report)
        return json.loads(report.read_text())

    def test_formats_keep_faces_edges_and_solids(self):
        for name in ("s.step", "s.stp", "s.iges", "s.IGS", "s.brep", "s.brp"):
            path, report = self.convert(SCREW, name)
            self.assertIn("10 faces, 1 solid, 0 shells, 22 shared edges", self.out)
            self.assertEqual(self.err, "")
            for key, value in (("written_faces", 10), ("lost_faces", 0), ("invalid_faces", 0),
                               ("analytic_faces", 10), ("instances", 0), ("solids", 1), ("shells", 0), ("shared_edges", 22),
                               ("torn_edges", 0)):
                self.assertEqual(report[key], value, (name, key))
            again = self.info(path)
            self.assertEqual((again["faces"], again["edges"], again["problems"]), (10, 22, []))

    def test_vtk_formats(self):
        path, _ = self.convert(SCREW, "s.vtu")
        assembly, _ = self.convert(LINKRODS, "l.vtpc")
        self.assertEqual(self.info(path)["faces"], 10)
        self.assertEqual(self.info(assembly)["faces"], 37)
        back, report = self.convert(assembly, "l.step")
        self.assertEqual(report["written_faces"], 37)
        self.assertEqual(self.info(back)["faces"], 37)

    def test_units(self):
        path, _ = self.convert(SCREW, "m.step", "--unit", "m")
        report = self.folder / "u.json"
        tool("info", path, "--unit", "file", "--report", report)
        self.assertEqual(json.loads(report.read_text())["unit"], "m")

    def test_visible_regions_as_step(self):
        path = self.folder / "seen.step"
        tool("visible", SCREW, "-o", path, "--view", "front")
        self.assertGreater(self.info(path)["faces"], 3)

    def test_strict_finds_torn_edges(self):
        path, _ = self.convert(SCREW, "s.vtu")
        grid = read(vtkXMLUnstructuredGridReader(), path)
        middle = grid.GetCell(3).GetPointIds()
        for i in range(middle.GetNumberOfIds()):  # One face moves away from its neighbours.
            x, y, z = grid.GetPoint(middle.GetId(i))
            grid.GetPoints().SetPoint(middle.GetId(i), x + 5.0, y, z)
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetDataModeToBinary()
        writer.SetInputData(grid)
        writer.SetFileName(str(path))
        writer.Write()
        _, report = self.convert(path, "torn.step", "--strict", code=3)
        self.assertGreater(report["torn_edges"], 0)
        self.assertEqual(report["solids"], 0)
        self.assertIn("torn", self.err)

    def test_errors(self):
        self.fails("convert", SCREW, "-o", self.folder / "s.stl", says="models are .step")
        self.fails("convert", SCREW, "-o", self.folder / "no/s.step", says="cannot write")
        self.fails("convert", self.folder / "no.step", "-o", self.folder / "s.step", says="no such")
        self.fails("convert", SCREW, "-o", self.folder / "s.step", "--gap=-1", says="'-1' is not",
                   code=2)


if __name__ == "__main__":
    TestCommandLine.TOOL = sys.argv.pop(1)
    unittest.main()
