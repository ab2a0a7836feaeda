// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFaceEvaluator.h"

#include "SurfaceEvaluator.h"
#include "TrimIndex.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSParallel.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

vtkStandardNewMacro(vtkNURBSFaceEvaluator);

struct vtkNURBSFaceEvaluator::Internals
{
  std::shared_ptr<const vtkNURBSModelView> View;
  vtkMTimeType ViewTime = 0;

  const nurbs::Face& Face(vtkIdType cell) const { return this->View->GetModel().Faces[cell]; }
};

namespace
{

std::vector<nurbs::Vec2> Parameters(vtkDataArray* array, std::int64_t begin, std::int64_t end)
{
  std::vector<nurbs::Vec2> uv(end - begin);
  for (std::int64_t i = begin; i < end; ++i)
  {
    uv[i - begin] = nurbs::Vec2(array->GetComponent(i, 0), array->GetComponent(i, 1));
  }
  return uv;
}

void CopyTo(vtkDoubleArray* array, int components, const double* values, std::size_t count)
{
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count) / components);
  std::copy_n(values, count, array->GetPointer(0));
}

} // namespace

vtkNURBSFaceEvaluator::vtkNURBSFaceEvaluator()
  : Content(new Internals)
{}

vtkNURBSFaceEvaluator::~vtkNURBSFaceEvaluator() = default;

void vtkNURBSFaceEvaluator::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Model: " << this->Model.Get() << "\n";
}

void vtkNURBSFaceEvaluator::SetModel(vtkUnstructuredGrid* model)
{
  if (model != this->Model)
  {
    this->Model = model;
    this->Content->View.reset();
    this->Modified();
  }
}

vtkUnstructuredGrid* vtkNURBSFaceEvaluator::GetModel()
{
  return this->Model;
}

bool vtkNURBSFaceEvaluator::Refuse(const std::string& reason)
{
  this->ErrorMessage = reason;
  vtkErrorMacro(<< reason);
  return false;
}

vtkIdType vtkNURBSFaceEvaluator::GetNumberOfFaces()
{
  return this->Model ? this->Model->GetNumberOfCells() : 0;
}

std::string vtkNURBSFaceEvaluator::GetFaceError(vtkIdType cell)
{
  if (cell < 0 || cell >= this->GetNumberOfFaces())
  {
    return "there is no cell " + std::to_string(cell) + "; the model has " +
      std::to_string(this->GetNumberOfFaces());
  }
  if (!vtkNURBSModel::IsModel(this->Model))
  {
    return "the grid is no NURBS model: it lacks the arrays of one";
  }
  if (!this->Content->View || this->Content->ViewTime != this->Model->GetMTime())
  {
    vtkNURBSParallelScope parallel;
    this->Content->View = vtkNURBSModel::View(this->Model);
    this->Content->ViewTime = this->Model->GetMTime();
  }
  const std::string& error = this->Content->View->GetFaceError(cell);
  return error.empty() ? error : "cell " + std::to_string(cell) + ": " + error;
}

bool vtkNURBSFaceEvaluator::HasFace(vtkIdType cell)
{
  this->ErrorMessage.clear();
  const std::string reason = this->GetFaceError(cell);
  return reason.empty() || this->Refuse(reason);
}

bool vtkNURBSFaceEvaluator::CanFill(vtkIdType cell, vtkDataArray* results)
{
  return this->HasFace(cell) && (results || this->Refuse("there is no array for the results"));
}

bool vtkNURBSFaceEvaluator::HasParameters(
  vtkIdType cell, vtkDataArray* parameters, vtkDataArray* results)
{
  if (!this->CanFill(cell, results))
  {
    return false;
  }
  return (parameters && parameters->GetNumberOfComponents() == 2) ||
    this->Refuse("cell " + std::to_string(cell) + ": the parameters have " +
      std::to_string(parameters ? parameters->GetNumberOfComponents() : 0) +
      " components instead of 2");
}

bool vtkNURBSFaceEvaluator::Evaluate(
  vtkIdType cell, vtkDataArray* parameters, int order, vtkDoubleArray* results)
{
  if (!this->HasParameters(cell, parameters, results))
  {
    return false;
  }
  if (order < 0 || order > 2)
  {
    return this->Refuse("derivatives of order " + std::to_string(order) + " are not 0 to 2");
  }
  constexpr int Widths[] = { 3, 9, 18 };
  const vtkIdType count = parameters->GetNumberOfTuples();
  results->SetNumberOfComponents(Widths[order]);
  results->SetNumberOfTuples(count);
  double* out = results->GetPointer(0);
  const nurbs::SurfaceEvaluator surface(this->Content->Face(cell).Geometry);
  vtkNURBSParallelScope parallel;
  vtkNURBSParallelFor(0, count, [&](std::int64_t begin, std::int64_t end) {
    nurbs::SurfaceEvaluator mine(surface);
    const std::vector<nurbs::Vec2> uv = Parameters(parameters, begin, end);
    if (order == 0)
    {
      mine.Batch(uv.data(), end - begin, out + 3 * begin, nullptr);
      return;
    }
    for (std::int64_t i = begin; i < end; ++i)
    {
      const nurbs::Vec2& at = uv[i - begin];
      const nurbs::SurfaceDerivatives d = mine.Derivatives(at[0], at[1], order);
      const nurbs::Vec3* all[] = { &d.S, &d.Su, &d.Sv, &d.Suu, &d.Suv, &d.Svv };
      for (int k = 0; k < Widths[order]; ++k)
      {
        out[Widths[order] * i + k] = (*all[k / 3])[k % 3];
      }
    }
  });
  results->Modified();
  return true;
}

bool vtkNURBSFaceEvaluator::EvaluateNormals(
  vtkIdType cell, vtkDataArray* parameters, vtkDoubleArray* normals)
{
  if (!this->HasParameters(cell, parameters, normals))
  {
    return false;
  }
  const vtkIdType count = parameters->GetNumberOfTuples();
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(count);
  double* out = normals->GetPointer(0);
  const nurbs::Face& face = this->Content->Face(cell);
  const nurbs::SurfaceEvaluator surface(face.Geometry);
  const double sign = face.Reversed ? -1.0 : 1.0;
  vtkNURBSParallelScope parallel;
  vtkNURBSParallelFor(0, count, [&](std::int64_t begin, std::int64_t end) {
    nurbs::SurfaceEvaluator mine(surface);
    const std::vector<nurbs::Vec2> uv = Parameters(parameters, begin, end);
    std::vector<double> points(3 * uv.size());
    mine.Batch(uv.data(), end - begin, points.data(), out + 3 * begin);
    std::transform(out + 3 * begin, out + 3 * end, out + 3 * begin,
      [sign](double value) { return sign * value; });
  });
  normals->Modified();
  return true;
}

bool vtkNURBSFaceEvaluator::EvaluateInside(
  vtkIdType cell, vtkDataArray* parameters, vtkUnsignedCharArray* inside)
{
  if (!this->HasParameters(cell, parameters, inside))
  {
    return false;
  }
  const vtkIdType count = parameters->GetNumberOfTuples();
  inside->SetNumberOfComponents(1);
  inside->SetNumberOfTuples(count);
  unsigned char* out = inside->GetPointer(0);
  const nurbs::FaceTrim trim(this->Content->View->GetModel(), cell);
  vtkNURBSParallelScope parallel;
  vtkNURBSParallelFor(0, count, [&](std::int64_t begin, std::int64_t end) {
    const std::vector<nurbs::Vec2> uv = Parameters(parameters, begin, end);
    for (std::int64_t i = begin; i < end; ++i)
    {
      out[i] = trim.Inside(uv[i - begin][0], uv[i - begin][1]) ? 1 : 0;
    }
  });
  inside->Modified();
  return true;
}

bool vtkNURBSFaceEvaluator::GetDomain(vtkIdType cell, double domain[4])
{
  if (!this->HasFace(cell))
  {
    return false;
  }
  for (int dir = 0; dir < 2; ++dir)
  {
    const nurbs::Interval range = this->Content->Face(cell).Geometry.Domain(dir);
    domain[2 * dir] = range.Min;
    domain[2 * dir + 1] = range.Max;
  }
  return true;
}

bool vtkNURBSFaceEvaluator::GetDegree(vtkIdType cell, int degree[2])
{
  if (!this->HasFace(cell))
  {
    return false;
  }
  std::copy_n(this->Content->Face(cell).Geometry.Degree, 2, degree);
  return true;
}

bool vtkNURBSFaceEvaluator::GetNetSize(vtkIdType cell, int size[2])
{
  if (!this->HasFace(cell))
  {
    return false;
  }
  std::copy_n(this->Content->Face(cell).Geometry.Count, 2, size);
  return true;
}

bool vtkNURBSFaceEvaluator::GetKnots(vtkIdType cell, int direction, vtkDoubleArray* knots)
{
  if (!this->CanFill(cell, knots))
  {
    return false;
  }
  if (direction != 0 && direction != 1)
  {
    return this->Refuse("direction " + std::to_string(direction) + " is neither 0 nor 1");
  }
  const nurbs::KnotView values = this->Content->Face(cell).Geometry.Knots[direction];
  CopyTo(knots, 1, values.data(), values.size());
  return true;
}

bool vtkNURBSFaceEvaluator::GetControlPoints(vtkIdType cell, vtkDoubleArray* points)
{
  if (!this->CanFill(cell, points))
  {
    return false;
  }
  const nurbs::SurfaceView& surface = this->Content->Face(cell).Geometry;
  points->SetNumberOfComponents(3);
  points->SetNumberOfTuples(surface.Size());
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    points->SetTuple(k, surface.Point(k).data());
  }
  return true;
}

bool vtkNURBSFaceEvaluator::GetWeights(vtkIdType cell, vtkDoubleArray* weights)
{
  if (!this->CanFill(cell, weights))
  {
    return false;
  }
  const nurbs::SurfaceView& surface = this->Content->Face(cell).Geometry;
  weights->SetNumberOfComponents(1);
  weights->SetNumberOfTuples(surface.Size());
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    weights->SetValue(k, surface.Weight(k));
  }
  return true;
}

bool vtkNURBSFaceEvaluator::IsRational(vtkIdType cell)
{
  return this->HasFace(cell) && this->Content->Face(cell).Geometry.IsRational();
}

bool vtkNURBSFaceEvaluator::IsReversed(vtkIdType cell)
{
  return this->HasFace(cell) && this->Content->Face(cell).Reversed;
}

vtkIdType vtkNURBSFaceEvaluator::GetNumberOfLoops(vtkIdType cell)
{
  return this->HasFace(cell) ? this->Content->Face(cell).LoopCount : -1;
}

vtkIdType vtkNURBSFaceEvaluator::GetNumberOfTrimCurves(vtkIdType cell, vtkIdType loop)
{
  if (!this->HasFace(cell))
  {
    return -1;
  }
  const nurbs::Face& face = this->Content->Face(cell);
  if (loop < 0 || loop >= face.LoopCount)
  {
    this->Refuse("cell " + std::to_string(cell) + " has no loop " + std::to_string(loop) +
      "; it has " + std::to_string(face.LoopCount));
    return -1;
  }
  return this->Content->View->GetModel().Loops[face.FirstLoop + loop].CurveCount;
}

vtkIdType vtkNURBSFaceEvaluator::FindTrimCurve(vtkIdType cell, vtkIdType loop, vtkIdType curve)
{
  const vtkIdType count = this->GetNumberOfTrimCurves(cell, loop);
  if (count < 0)
  {
    return -1;
  }
  if (curve < 0 || curve >= count)
  {
    this->Refuse("cell " + std::to_string(cell) + ", loop " + std::to_string(loop) +
      " has no curve " + std::to_string(curve) + "; it has " + std::to_string(count));
    return -1;
  }
  const nurbs::Face& face = this->Content->Face(cell);
  return this->Content->View->GetModel().Loops[face.FirstLoop + loop].FirstCurve + curve;
}

bool vtkNURBSFaceEvaluator::GetTrimCurve(
  vtkIdType cell, vtkIdType loop, vtkIdType curve, vtkDoubleArray* points, vtkDoubleArray* knots)
{
  const vtkIdType found = this->FindTrimCurve(cell, loop, curve);
  if (found < 0)
  {
    return false;
  }
  if (!points || !knots)
  {
    return this->Refuse("there is no array for the results");
  }
  const nurbs::CurveView<2>& geometry = this->Content->View->GetModel().TrimCurves[found].Geometry;
  CopyTo(points, 3, geometry.Points, 3 * static_cast<std::size_t>(geometry.Count));
  CopyTo(knots, 1, geometry.Knots.data(), geometry.Knots.size());
  return true;
}

vtkIdType vtkNURBSFaceEvaluator::GetTrimCurveEdge(vtkIdType cell, vtkIdType loop, vtkIdType curve)
{
  const vtkIdType found = this->FindTrimCurve(cell, loop, curve);
  return found < 0 ? -1 : this->Content->View->GetModel().TrimCurves[found].Edge;
}

bool vtkNURBSFaceEvaluator::IsTrimCurveReversed(vtkIdType cell, vtkIdType loop, vtkIdType curve)
{
  const vtkIdType found = this->FindTrimCurve(cell, loop, curve);
  return found >= 0 && this->Content->View->GetModel().TrimCurves[found].Reversed;
}
