// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "Failure.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace nurbs
{

void WriteReport(const Report& report, const std::string& path)
{
  nlohmann::ordered_json json;
  json["file"] = report.File;
  json["unit"] = report.Unit;
  json["faces"] = report.Faces;
  json["edges"] = report.Edges;
  json["unconverted_faces"] = report.Unconverted;
  json["seconds"]["read"] = report.ReadSeconds;
  if (report.Tessellated)
  {
    json["triangles"] = report.Triangles;
    json["points"] = report.Points;
    json["tolerance"] = report.Tolerance;
    json["certified_error"] = report.CertifiedError;
    json["guaranteed"] = report.Guaranteed;
    json["open_edges"] = report.OpenEdges;
    json["failed_faces"] = report.FailedFaces;
    json["repaired_faces"] = report.RepairedFaces;
    json["capped_faces"] = report.CappedFaces;
    json["seconds"]["tessellate"] = report.TessellateSeconds;
    json["seconds"]["write"] = report.WriteSeconds;
  }
  if (report.Viewed)
  {
    json["precision"] = report.Precision;
    if (report.HasRegions)
    {
      json["visible_faces"] = report.VisibleFaces;
      json["partial_faces"] = report.PartialFaces;
      json["hidden_faces"] = report.HiddenFaces;
      json["visible_area"] = report.VisibleArea;
    }
    json["failed_faces"] = report.UnusedFaces;
    json["piercing_pairs"] = report.PiercingPairs;
    json["lines"] = report.Lines;
    json["visible_lines"] = report.VisibleLines;
    json["seconds"]["visibility"] = report.VisibilitySeconds;
    json["seconds"]["write"] = report.WriteSeconds;
  }
  if (report.Drawn)
  {
    json["paths"] = report.Paths;
    json["curves"] = report.Curves;
    json["straight_lines"] = report.StraightLines;
    json["scale"] = report.Scale;
  }
  if (report.Converted)
  {
    json["written_faces"] = report.WrittenFaces;
    json["lost_faces"] = report.LostFaces;
    json["invalid_faces"] = report.InvalidFaces;
    json["analytic_faces"] = report.AnalyticFaces;
    json["instances"] = report.Instances;
    json["solids"] = report.Solids;
    json["shells"] = report.Shells;
    json["shared_edges"] = report.SharedEdges;
    json["computed_edges"] = report.ComputedEdges;
    json["torn_edges"] = report.TornEdges;
    json["edge_tolerance"] = report.EdgeTolerance;
    json["seconds"]["write"] = report.WriteSeconds;
  }
  json["problems"] = report.Problems;
  std::ofstream file(path);
  file << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  file.close();
  if (!file)
  {
    throw Failure("cannot write the report " + path);
  }
}

} // namespace nurbs
