// SPDX-License-Identifier: BSD-3-Clause
#include "RegionCells.h"

#include "FaceCells.h"
#include "RegionArea.h"

namespace nurbs
{

namespace
{

// How far what is seen may be from the point that is looked for, as a share of the model's size: rays
// that graze a surface meet it to the square root of rounding.
constexpr double SamePoint = 1e-6;

} // namespace

RegionCells::RegionCells(const ViewLines& lines, const ImagePlane& image, const RayCaster& caster,
  double precision, bool bothSides)
  : Lines(lines)
  , Image(image)
  , Caster(caster)
  , Precision(precision)
  , BothSides(bothSides)
  , OwnLines(lines.Whole.Data.Faces.size())
{
  for (std::size_t l = 0; l < lines.Lines.size(); ++l)
  {
    const ViewLine& line = lines.Lines[l];
    if (line.Edge < 0)
    {
      this->OwnLines[line.Face].push_back(std::int32_t(l));
      if (line.IsIntersection())
      {
        this->OwnLines[line.OtherFace].push_back(std::int32_t(l));
      }
    }
  }
}

bool RegionCells::IsSeen(std::int64_t index, const Vec2& uv) const
{
  const Face& face = this->Lines.Whole.Data.Faces[index];
  const SurfaceDerivatives d = EvaluateDerivatives(face.Geometry, uv[0], uv[1], 1);
  const Viewer& viewer = this->Image.GetViewer();
  const Vec3 toViewer = viewer.Perspective ? Vec3(viewer.Place - d.S) : viewer.Place;
  // Of unit length: models may be as small as numbers are.
  const Vec3 normal = d.Su.stableNormalized().cross(d.Sv.stableNormalized());
  const bool fromBehind = (normal.dot(toViewer.stableNormalized()) < 0.0) != face.Reversed;
  if (fromBehind && !this->BothSides)
  {
    return false;
  }
  const FrontHit hit = LookAt(this->Caster, this->Image, this->Image.Project(d.S));
  return hit.Face == index && hit.FromBehind == fromBehind &&
    (hit.Point - d.S).norm() <= SamePoint * this->Caster.Bounds().diagonal().norm();
}

SettledRegions RegionCells::Settle(
  std::int64_t index, const TracedRegion& traced, bool hidden) const
{
  const Model& model = this->Lines.Whole.Data;
  FaceCells cells(model, index, this->Precision);
  cells.AddTrims(traced.Loops);
  for (const RegionLoop& loop : traced.Loops)
  {
    for (const RegionPiece& piece : loop)
    {
      cells.AddPolyline(piece.Polyline, true);
    }
  }
  for (const std::int32_t l : this->OwnLines[index])
  {
    const ViewLine& line = this->Lines.Lines[l];
    std::vector<Vec2> points;
    for (std::size_t k = 0; k < line.Points.size(); ++k)
    {
      points.push_back(ParametersAt(line, double(k), index));
    }
    cells.AddPolyline(points, false);
  }
  SettledRegions out;
  FaceView view;
  view.IsSeen = [&](const Vec2& uv) { return this->IsSeen(index, uv); };
  view.ImageOf = [&](const Vec2& uv) {
    return this->Image.Project(Evaluate(model.Faces[index].Geometry, uv[0], uv[1]));
  };
  out.Unsettled = cells.Look(view, traced.Doubtful > 0);
  const bool isWhole = cells.All(Sight::Visible);
  const bool isHidden = cells.All(Sight::Hidden);
  out.Visible = isWhole ? WholeRegion(model, index) : cells.Loops(Sight::Visible);
  if (hidden)
  {
    out.Hidden = isHidden ? WholeRegion(model, index) : cells.Loops(Sight::Hidden);
  }
  return out;
}

} // namespace nurbs
