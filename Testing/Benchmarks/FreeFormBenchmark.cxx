// SPDX-License-Identifier: BSD-3-Clause
// Cost of an update of vtkNURBSFreeFormDeformation: a cylinder with many control points is twisted
// by its lattice, another angle every frame. Displacements of a twist by small angles are linear in
// each variable, so the lattice reproduces them: the last column is the distance from that closed
// form.
//   FreeFormBenchmark [THREADS]   default 1
#include "Measuring.h"
#include "ModelBuilder.h"
#include "Surface.h"
#include "vtkNURBSFreeFormDeformation.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"

#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkSMPTools.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace
{

constexpr double Height = 10.0;

std::vector<double> Between(nurbs::Interval range, int count)
{
  std::vector<double> values;
  for (int i = 1; i <= count; ++i)
  {
    values.push_back(range.Min + i * range.Length() / (count + 1));
  }
  return values;
}

// The side of a cylinder, exactly, with `around` x `along` knots more than it needs.
vtkSmartPointer<vtkUnstructuredGrid> Cylinder(int around, int along)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCylinder();
  source->SetHeight(Height);
  source->CappingOff();
  source->Update();
  const auto view = vtkNURBSModel::View(source->GetOutput());
  nurbs::Surface surface = nurbs::ElevateDegree(view->GetModel().Faces[0].Geometry, 1, 2);
  surface = nurbs::RefineKnots(surface.View(), 0, Between(surface.View().Domain(0), around));
  surface = nurbs::RefineKnots(surface.View(), 1, Between(surface.View().Domain(1), along));
  nurbs::ModelBuilder builder;
  builder.BeginFace(surface.View(), {});
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNURBSModel::Store(builder, grid);
  return grid;
}

nurbs::Vec3 Twist(const double* x, double angle)
{
  return nurbs::Vec3(-angle * x[2] * x[1], angle * x[2] * x[0], 0.0);
}

// Sets the displacements of a twist; with `local`, of one lattice point in the middle of a side
// only.
void SetTwist(vtkNURBSFreeFormDeformation* filter, vtkPoints* rest, double angle, bool local)
{
  const int* size = filter->GetDimensions();
  const vtkIdType middle =
    size[0] - 1 + size[0] * (size[1] / 2 + vtkIdType(size[1]) * (size[2] / 2));
  for (vtkIdType n = local ? middle : 0; n < (local ? middle + 1 : rest->GetNumberOfPoints()); ++n)
  {
    double x[3];
    rest->GetPoint(n, x);
    const nurbs::Vec3 d = Twist(x, angle);
    filter->SetLatticeDisplacement(n, d[0], d[1], d[2]);
  }
}

double Distance(vtkNURBSFreeFormDeformation* filter, vtkUnstructuredGrid* model, double angle)
{
  auto* moved = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  double worst = 0.0;
  for (vtkIdType n = 0; n < model->GetNumberOfPoints(); ++n)
  {
    nurbs::Vec3 x, y;
    model->GetPoint(n, x.data());
    moved->GetPoint(n, y.data());
    worst = std::max(worst, (y - x - Twist(x.data(), angle)).norm());
  }
  return worst;
}

void Measure(vtkUnstructuredGrid* model, const int (&size)[3], int degree, bool local)
{
  vtkNew<vtkNURBSFreeFormDeformation> filter;
  filter->SetInputData(model);
  filter->SetDimensions(size);
  filter->SetDegree(degree, degree, degree);
  filter->Update();
  vtkNew<vtkPoints> rest;
  rest->SetDataTypeToDouble();
  rest->DeepCopy(vtkStructuredGrid::SafeDownCast(filter->GetOutputDataObject(1))->GetPoints());
  double angle = 0.0;
  const measuring::Duration time = measuring::MedianTime(21, [&] {
    angle += 0.001;
    SetTwist(filter, rest, angle, local);
    filter->Update();
  });
  const auto points = static_cast<long long>(model->GetNumberOfPoints());
  const auto moved = static_cast<long long>(filter->GetNumberOfMovedPoints());
  std::printf("| %lld | %d x %d x %d | %s | %s | %lld | %.2f | %.2f | %.1f | ", points, size[0],
    size[1], size[2], degree == 0 ? "3" : "Bernstein", local ? "1" : "all", moved,
    1e3 * time.Elapsed, 1e3 * time.Processor, 1e9 * time.Processor / double(points));
  local ? std::printf("- |\n") : std::printf("%.1e |\n", Distance(filter, model, angle) / Height);
}

} // namespace

int main(int argc, char** argv)
{
  const int threads = argc > 1 ? std::max(1, std::atoi(argv[1])) : 1;
  vtkSMPTools::Initialize(threads);
  std::printf("Threads: %d. Nanoseconds: of processor time, a control point. Error: of the "
              "height.\n\n| control points | lattice | degree | displaced | moved | ms an update | "
              "processor ms | ns | error |\n|--:|---|---|--:|--:|--:|--:|--:|--:|\n",
    threads);
  const int cubic[3] = { 4, 4, 12 }, fine[3] = { 16, 16, 32 }, bernstein[3] = { 4, 4, 10 };
  for (const int along : { 1200, 12000 })
  {
    const auto model = Cylinder(90, along);
    Measure(model, cubic, 0, false);
    Measure(model, fine, 0, false);
    Measure(model, bernstein, 25, false);
    Measure(model, fine, 0, true);
  }
  return 0;
}
