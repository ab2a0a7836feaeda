// SPDX-License-Identifier: BSD-3-Clause
#include "OcctHiddenLines.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepLib.hxx>
#include <GCPnts_QuasiUniformDeflection.hxx>
#include <HLRAlgo_EdgeIterator.hxx>
#include <HLRAlgo_EdgeStatus.hxx>
#include <HLRAlgo_Projector.hxx>
#include <HLRBRep_Algo.hxx>
#include <HLRBRep_HLRToShape.hxx>
#include <HLRBRep_PolyAlgo.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Ax2.hxx>

namespace verify
{

namespace
{

HLRAlgo_Projector ProjectorOf(const Eigen::Vector3d& view)
{
  return HLRAlgo_Projector(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(view[0], view[1], view[2])));
}

void AddEdges(
  const TopoDS_Shape& edges, bool visible, int kind, double chord, std::vector<HiddenLine>& lines)
{
  if (edges.IsNull())
  {
    return;
  }
  BRepLib::BuildCurves3d(edges);
  for (TopExp_Explorer e(edges, TopAbs_EDGE); e.More(); e.Next())
  {
    const BRepAdaptor_Curve curve(TopoDS::Edge(e.Current()));
    const GCPnts_QuasiUniformDeflection points(curve, chord);
    HiddenLine line;
    line.Visible = visible;
    line.Kind = kind;
    for (int i = 1; points.IsDone() && i <= points.NbPoints(); ++i)
    {
      const gp_Pnt p = points.Value(i);
      line.Points.emplace_back(p.X(), p.Y(), p.Z());
    }
    if (line.Points.size() > 1)
    {
      lines.push_back(std::move(line));
    }
  }
}

} // namespace

std::vector<HiddenLine> HideExactly(
  const TopoDS_Shape& root, const Eigen::Vector3d& view, double chord)
{
  const Handle(HLRBRep_Algo) algorithm = new HLRBRep_Algo;
  algorithm->Add(root, 0);
  algorithm->Projector(ProjectorOf(view));
  algorithm->Update();
  algorithm->Hide();
  HLRBRep_HLRToShape results(algorithm);
  std::vector<HiddenLine> lines;
  for (const bool visible : { true, false })
  {
    AddEdges(results.CompoundOfEdges(HLRBRep_OutLine, visible, true), visible, 0, chord, lines);
    AddEdges(results.CompoundOfEdges(HLRBRep_Sharp, visible, true), visible, 2, chord, lines);
  }
  return lines;
}

std::vector<HiddenLine> HideByPolygons(const TopoDS_Shape& root, const Eigen::Vector3d& view)
{
  const Handle(HLRBRep_PolyAlgo) algorithm = new HLRBRep_PolyAlgo;
  algorithm->Load(root);
  algorithm->Projector(ProjectorOf(view));
  algorithm->Update();
  std::vector<HiddenLine> lines;
  for (algorithm->InitHide(); algorithm->MoreHide(); algorithm->NextHide())
  {
    HLRAlgo_EdgeStatus status;
    TopoDS_Shape shape;
    Standard_Boolean smooth = false, seam = false, outline = false, inner = false;
    const HLRAlgo_BiPoint::PointsT& ends =
      algorithm->Hide(status, shape, smooth, seam, outline, inner);
    if (smooth || seam)
    {
      continue; // An edge between faces that go on in each other, or within one.
    }
    const Eigen::Vector3d a(ends.Pnt1.X(), ends.Pnt1.Y(), ends.Pnt1.Z());
    const Eigen::Vector3d b(ends.Pnt2.X(), ends.Pnt2.Y(), ends.Pnt2.Z());
    const auto add = [&](double from, double to, bool visible) {
      lines.push_back({ { a + from * (b - a), a + to * (b - a) }, visible, outline ? 0 : 2 });
    };
    HLRAlgo_EdgeIterator parts;
    double from = 0.0, to = 0.0;
    float fromTolerance = 0.0f, toTolerance = 0.0f;
    for (parts.InitVisible(status); parts.MoreVisible(); parts.NextVisible())
    {
      parts.Visible(from, fromTolerance, to, toTolerance);
      add(from, to, true);
    }
    for (parts.InitHidden(status); parts.MoreHidden(); parts.NextHidden())
    {
      parts.Hidden(from, fromTolerance, to, toTolerance);
      add(from, to, false);
    }
  }
  return lines;
}

} // namespace verify
