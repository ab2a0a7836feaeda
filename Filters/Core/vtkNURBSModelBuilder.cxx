// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSModelBuilder.h"

#include "ModelBuilder.h"
#include "PatchStitcher.h"
#include "vtkNURBSModel.h"

#include "vtkDataArray.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <map>

vtkStandardNewMacro(vtkNURBSModelBuilder);

namespace
{

struct TrimCurveData
{
  nurbs::Curve<2> Geometry;
  vtkIdType Edge = -1;
  bool Reversed = false;
};

struct FaceData
{
  nurbs::Surface Geometry;
  nurbs::FaceAttributes Attributes;
  std::vector<std::vector<TrimCurveData>> Loops;
};

std::vector<double> Values(vtkDataArray* array)
{
  std::vector<double> values(array->GetNumberOfValues());
  const int width = array->GetNumberOfComponents();
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    values[i] = array->GetComponent(i / width, i % width);
  }
  return values;
}

/// Why the values are no weights, or "".
std::string CheckWeights(const std::vector<double>& weights)
{
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    if (!(weights[i] > 0.0) || !std::isfinite(weights[i]))
    {
      return "weight " + std::to_string(i) + " is " + std::to_string(weights[i]) +
        ", not positive and finite";
    }
  }
  return std::string();
}

/// The knots of a direction, and the number of control points that they are for, into `surface`.
/// Returns the reason why they can't be, or "".
std::string SetKnots(nurbs::Surface& surface, int dir, int degree, vtkDataArray* knots)
{
  const std::string where = dir == 0 ? " in u" : " in v";
  if (degree < 1 || degree > nurbs::MaxDegree)
  {
    return "degree " + std::to_string(degree) + where + " is not 1 to " +
      std::to_string(nurbs::MaxDegree);
  }
  if (!knots || knots->GetNumberOfComponents() != 1)
  {
    return "the knots" + where + " are no array of one component";
  }
  const vtkIdType count = knots->GetNumberOfTuples() - degree - 1;
  if (count < degree + 1)
  {
    return std::to_string(knots->GetNumberOfTuples()) + " knots" + where +
      " are too few for degree " + std::to_string(degree);
  }
  surface.Degree[dir] = degree;
  surface.Count[dir] = static_cast<int>(count);
  surface.Knots[dir] = Values(knots);
  const std::string reason = nurbs::CheckKnots(surface.Knots[dir], degree, count);
  return reason.empty() ? reason : "knots" + where + ": " + reason;
}

std::string SetPoints(nurbs::Surface& surface, vtkDataArray* points, vtkDataArray* weights)
{
  const vtkIdType count = static_cast<vtkIdType>(surface.Count[0]) * surface.Count[1];
  if (!points || points->GetNumberOfComponents() != 3 || points->GetNumberOfTuples() != count)
  {
    return "the knots are for " + std::to_string(surface.Count[0]) + " x " +
      std::to_string(surface.Count[1]) + " control points, and there are " +
      std::to_string(points ? points->GetNumberOfTuples() : 0) + " of " +
      std::to_string(points ? points->GetNumberOfComponents() : 3) + " components";
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    surface.Points.emplace_back(
      points->GetComponent(i, 0), points->GetComponent(i, 1), points->GetComponent(i, 2));
    if (!surface.Points.back().allFinite())
    {
      return "control point " + std::to_string(i % surface.Count[0]) + ", " +
        std::to_string(i / surface.Count[0]) + " is not finite";
    }
  }
  if (weights && (weights->GetNumberOfComponents() != 1 || weights->GetNumberOfTuples() != count))
  {
    return "there are " + std::to_string(weights->GetNumberOfTuples()) + " weights for " +
      std::to_string(count) + " control points";
  }
  surface.Weights = weights ? Values(weights) : std::vector<double>();
  return CheckWeights(surface.Weights);
}

std::string SetCurve(nurbs::Curve<2>& curve, int degree, vtkDataArray* knots, vtkDataArray* points)
{
  if (degree < 1 || degree > nurbs::MaxDegree)
  {
    return "degree " + std::to_string(degree) + " is not 1 to " + std::to_string(nurbs::MaxDegree);
  }
  if (!knots || knots->GetNumberOfComponents() != 1)
  {
    return "the knots are no array of one component";
  }
  if (!points || points->GetNumberOfComponents() < 2 || points->GetNumberOfComponents() > 3)
  {
    return "the points are no array of two or three components";
  }
  curve.Degree = degree;
  curve.Knots = Values(knots);
  for (vtkIdType i = 0; i < points->GetNumberOfTuples(); ++i)
  {
    curve.Points.emplace_back(points->GetComponent(i, 0), points->GetComponent(i, 1));
    curve.Weights.push_back(
      points->GetNumberOfComponents() == 3 ? points->GetComponent(i, 2) : 1.0);
    if (!curve.Points.back().allFinite())
    {
      return "control point " + std::to_string(i) + " is not finite";
    }
  }
  curve.Pack();
  const std::string reason = CheckWeights(curve.Weights);
  return reason.empty() ? nurbs::CheckKnots(curve.Knots, degree, points->GetNumberOfTuples())
                        : reason;
}

/// True if the surface's sides are the outer rows of its net.
bool IsClamped(const nurbs::Surface& surface)
{
  for (int dir = 0; dir < 2; ++dir)
  {
    const std::vector<double>& knots = surface.Knots[dir];
    const int degree = surface.Degree[dir];
    if (knots[0] != knots[degree] || knots[knots.size() - 1] != knots[knots.size() - 1 - degree])
    {
      return false;
    }
  }
  return true;
}

} // namespace

struct vtkNURBSModelBuilder::Internals
{
  std::vector<FaceData> Faces;

  /// Diagonal of the box around all control points.
  double Size() const
  {
    nurbs::Box3 box;
    for (const FaceData& face : this->Faces)
    {
      for (const nurbs::Vec3& point : face.Geometry.Points)
      {
        box.extend(point);
      }
    }
    return box.isEmpty() ? 0.0 : box.diagonal().norm();
  }
};

vtkNURBSModelBuilder::vtkNURBSModelBuilder()
  : Content(new Internals)
{}

vtkNURBSModelBuilder::~vtkNURBSModelBuilder() = default;

void vtkNURBSModelBuilder::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfFaces: " << this->GetNumberOfFaces() << "\n";
  os << indent << "JoinSides: " << this->JoinSides << "\n";
  os << indent << "LengthUnit: " << this->LengthUnit << "\n";
}

bool vtkNURBSModelBuilder::Refuse(const std::string& reason)
{
  this->ErrorMessage = reason;
  vtkErrorMacro(<< reason);
  return false;
}

vtkIdType vtkNURBSModelBuilder::AddFace(int degreeU, int degreeV, vtkDataArray* knotsU,
  vtkDataArray* knotsV, vtkDataArray* points, vtkDataArray* weights)
{
  this->ErrorMessage.clear();
  FaceData face;
  std::string reason = SetKnots(face.Geometry, 0, degreeU, knotsU);
  reason = reason.empty() ? SetKnots(face.Geometry, 1, degreeV, knotsV) : reason;
  reason = reason.empty() ? SetPoints(face.Geometry, points, weights) : reason;
  if (!reason.empty())
  {
    this->Refuse("face " + std::to_string(this->GetNumberOfFaces()) + ": " + reason);
    return -1;
  }
  this->Content->Faces.push_back(std::move(face));
  this->Modified();
  return this->GetNumberOfFaces() - 1;
}

bool vtkNURBSModelBuilder::HasFace()
{
  this->ErrorMessage.clear();
  return !this->Content->Faces.empty() || this->Refuse("there is no face yet");
}

bool vtkNURBSModelBuilder::SetFaceId(vtkIdType id)
{
  if (!this->HasFace())
  {
    return false;
  }
  if (id < 0)
  {
    return this->Refuse("face " + std::to_string(this->GetNumberOfFaces() - 1) + ": identity " +
      std::to_string(id) + " is negative");
  }
  this->Content->Faces.back().Attributes.FaceId = id;
  this->Modified();
  return true;
}

bool vtkNURBSModelBuilder::SetFaceName(const std::string& name)
{
  if (!this->HasFace())
  {
    return false;
  }
  this->Content->Faces.back().Attributes.Name = name;
  this->Modified();
  return true;
}

bool vtkNURBSModelBuilder::SetFaceColor(int red, int green, int blue)
{
  if (!this->HasFace())
  {
    return false;
  }
  const int values[3] = { red, green, blue };
  if (std::any_of(values, values + 3, [](int value) { return value < 0 || value > 255; }))
  {
    return this->Refuse(
      "face " + std::to_string(this->GetNumberOfFaces() - 1) + ": a colour's values are 0 to 255");
  }
  std::copy(values, values + 3, this->Content->Faces.back().Attributes.Color.begin());
  this->Modified();
  return true;
}

bool vtkNURBSModelBuilder::SetFaceReversed(bool reversed)
{
  if (!this->HasFace())
  {
    return false;
  }
  this->Content->Faces.back().Attributes.Reversed = reversed;
  this->Modified();
  return true;
}

bool vtkNURBSModelBuilder::BeginLoop()
{
  if (!this->HasFace())
  {
    return false;
  }
  this->Content->Faces.back().Loops.emplace_back();
  this->Modified();
  return true;
}

bool vtkNURBSModelBuilder::AddTrimCurve(
  int degree, vtkDataArray* knots, vtkDataArray* points, vtkIdType edge, bool reversed)
{
  if (!this->HasFace())
  {
    return false;
  }
  std::vector<std::vector<TrimCurveData>>& loops = this->Content->Faces.back().Loops;
  const std::string face = "face " + std::to_string(this->GetNumberOfFaces() - 1);
  if (loops.empty())
  {
    return this->Refuse(face + ": a trim curve before any loop");
  }
  TrimCurveData curve;
  const std::string reason = edge < -1 ? "edge " + std::to_string(edge) + " is negative"
                                       : SetCurve(curve.Geometry, degree, knots, points);
  if (!reason.empty())
  {
    return this->Refuse(face + ", loop " + std::to_string(loops.size() - 1) + ", curve " +
      std::to_string(loops.back().size()) + ": " + reason);
  }
  curve.Edge = edge;
  curve.Reversed = reversed;
  loops.back().push_back(std::move(curve));
  this->Modified();
  return true;
}

void vtkNURBSModelBuilder::Build(vtkUnstructuredGrid* grid)
{
  if (!grid)
  {
    vtkErrorMacro("there is no grid to build the model in");
    return;
  }
  nurbs::ModelBuilder builder;
  builder.LengthUnit = this->LengthUnit;
  nurbs::PatchStitcher stitcher(builder, 1e-12 * this->Content->Size());
  std::map<vtkIdType, std::int64_t> edges; // The caller's numbers and ours.
  for (const FaceData& face : this->Content->Faces)
  {
    if (face.Loops.empty() && this->JoinSides && IsClamped(face.Geometry))
    {
      stitcher.AddFace(face.Geometry, face.Attributes);
      continue;
    }
    builder.BeginFace(face.Geometry.View(), face.Attributes);
    for (const std::vector<TrimCurveData>& loop : face.Loops)
    {
      builder.BeginLoop();
      for (const TrimCurveData& curve : loop)
      {
        std::int64_t edge = -1;
        if (curve.Edge >= 0)
        {
          const auto known = edges.find(curve.Edge);
          edge = known != edges.end() ? known->second : builder.AddUnknownEdge(0.0, -1, -1);
          edges[curve.Edge] = edge;
        }
        builder.AddTrimCurve(curve.Geometry.View(), edge, curve.Reversed);
      }
    }
  }
  vtkNURBSModel::Store(builder, grid);
}

void vtkNURBSModelBuilder::Reset()
{
  this->Content->Faces.clear();
  this->ErrorMessage.clear();
  this->Modified();
}

vtkIdType vtkNURBSModelBuilder::GetNumberOfFaces() const
{
  return static_cast<vtkIdType>(this->Content->Faces.size());
}
