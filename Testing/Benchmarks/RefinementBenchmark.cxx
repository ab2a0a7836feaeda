// SPDX-License-Identifier: BSD-3-Clause
// How far faces of a bent model part at their common edges, by the spacing of their control points.
//
// A free-form lattice around the model bends it across its longest side. Trim curves that name the
// same edge are evaluated at the same 65 parameters of it, on both surfaces, bent. `gap` is the
// largest distance, as a part of the diagonal; `own` what the file's own gaps become where the bend
// is applied to points of the surfaces themselves, as it would be by the densest nets; `net` the
// largest distance that the nets add to that.
//   RefinementBenchmark FILE   prints a JSON line a spacing, the first without refinement
#include "Measuring.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSFreeFormDeformation.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSRefinement.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkSMPTools.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <cstdio>
#include <map>

namespace
{

constexpr double Amounts[] = { 0.02, 0.1, 0.3 };
constexpr double Spacings[] = { 0.0, 0.1, 0.05, 0.02, 0.01 };
constexpr int Samples = 65;
constexpr int Lattice[3] = { 4, 4, 6 };

std::vector<vtkUnstructuredGrid*> Leaves(vtkDataObject* data)
{
  auto* composite = vtkCompositeDataSet::SafeDownCast(data);
  if (!composite)
  {
    return { vtkUnstructuredGrid::SafeDownCast(data) };
  }
  std::vector<vtkUnstructuredGrid*> leaves;
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(composite->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    leaves.push_back(vtkUnstructuredGrid::SafeDownCast(at->GetCurrentDataObject()));
  }
  return leaves;
}

// The points of all shared edges: Samples for every trim curve on one, curves of an edge together.
struct EdgeSamples
{
  std::vector<nurbs::Vec3> Points;
  std::vector<bool> First; // of the edge's curves; one a curve
  std::size_t Faces = 0, Edges = 0;
};

EdgeSamples Sample(vtkDataObject* data)
{
  EdgeSamples samples;
  nurbs::AssembleOptions options;
  options.CheckLoops = options.CheckEdges = false;
  for (vtkUnstructuredGrid* grid : Leaves(data))
  {
    const vtkNURBSModelView view(grid, options);
    const nurbs::Model& model = view.GetModel();
    using Use = std::pair<const nurbs::SurfaceView*, const nurbs::CurveView<2>*>;
    std::map<std::int64_t, std::vector<Use>> uses;
    for (const nurbs::Face& face : model.Faces)
    {
      samples.Faces += face.Geometry.Size() > 0;
      for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
      {
        const nurbs::TrimLoop& loop = model.Loops[l];
        for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
        {
          uses[model.TrimCurves[c].Edge].emplace_back(
            &face.Geometry, &model.TrimCurves[c].Geometry);
        }
      }
    }
    uses.erase(-1);
    for (const auto& [edge, all] : uses)
    {
      samples.Edges += all.size() > 1;
      for (std::size_t k = 0; k < all.size() && all.size() > 1; ++k)
      {
        const auto& [surface, curve] = all[k];
        const nurbs::Interval range = curve->Domain();
        samples.First.push_back(k == 0);
        for (int i = 0; i < Samples; ++i)
        {
          const double t = range.Clamp(range.Min + range.Length() * i / (Samples - 1));
          const nurbs::Vec2 uv = nurbs::Evaluate(*curve, t);
          samples.Points.push_back(nurbs::Evaluate(
            *surface, surface->Domain(0).Clamp(uv[0]), surface->Domain(1).Clamp(uv[1])));
        }
      }
    }
  }
  return samples;
}

// The largest distance of an edge's curves from its first one, less the distances of `own`.
double LargestGap(const EdgeSamples& at, const std::vector<nurbs::Vec3>* own = nullptr)
{
  double worst = 0.0;
  std::size_t first = 0;
  for (std::size_t c = 0; c < at.First.size(); ++c)
  {
    first = at.First[c] ? c : first;
    for (std::size_t i = 0; i < Samples; ++i)
    {
      const std::size_t a = first * Samples + i, b = c * Samples + i;
      const nurbs::Vec3 gap = at.Points[b] - at.Points[a];
      worst = std::max(worst, (own ? gap - ((*own)[b] - (*own)[a]) : gap).norm());
    }
  }
  return worst;
}

nurbs::Box3 ControlBox(vtkDataObject* data)
{
  nurbs::Box3 box;
  for (vtkUnstructuredGrid* grid : Leaves(data))
  {
    double b[6];
    grid->GetBounds(b);
    box.extend(nurbs::Vec3(b[0], b[2], b[4]));
    box.extend(nurbs::Vec3(b[1], b[3], b[5]));
  }
  return box;
}

// A lattice that bows the box sideways, as half a wave along its longest side.
void SetBend(vtkNURBSFreeFormDeformation* filter, const nurbs::Box3& box, double amount)
{
  int along;
  const double length = box.sizes().maxCoeff(&along);
  const nurbs::Vec3 margin = nurbs::Vec3::Constant(1e-3 * length);
  const nurbs::Vec3 low = box.min() - margin, high = box.max() + margin;
  int size[3] = { Lattice[0], Lattice[0], Lattice[0] };
  size[along] = Lattice[2];
  filter->SetDimensions(size);
  filter->UseInputBoundsOff();
  filter->SetBounds(low[0], high[0], low[1], high[1], low[2], high[2]);
  int shortest;
  box.sizes().minCoeff(&shortest);
  vtkNew<vtkNURBSFreeFormDeformation> atRest;
  vtkNew<vtkUnstructuredGrid> nothing;
  atRest->SetInputData(nothing);
  atRest->SetDimensions(size);
  atRest->UseInputBoundsOff();
  atRest->SetBounds(filter->GetBounds());
  atRest->Update();
  auto* rest = vtkStructuredGrid::SafeDownCast(atRest->GetOutputDataObject(1));
  for (vtkIdType n = 0; n < rest->GetNumberOfPoints(); ++n)
  {
    const double part = (rest->GetPoint(n)[along] - low[along]) / (high[along] - low[along]);
    double move[3] = { 0.0, 0.0, 0.0 };
    move[shortest] = amount * length * std::sin(3.14159265358979324 * part);
    filter->SetLatticeDisplacement(n, move[0], move[1], move[2]);
  }
}

// The bend of points themselves.
std::vector<nurbs::Vec3> BendPoints(
  const std::vector<nurbs::Vec3>& points, const nurbs::Box3& box, double amount)
{
  vtkNew<vtkPoints> moved;
  moved->SetDataTypeToDouble();
  for (const nurbs::Vec3& point : points)
  {
    moved->InsertNextPoint(point.data());
  }
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(moved);
  vtkNew<vtkNURBSFreeFormDeformation> filter;
  SetBend(filter, box, amount);
  filter->SetInputData(grid);
  filter->Update();
  std::vector<nurbs::Vec3> bent(points.size());
  for (std::size_t n = 0; n < bent.size(); ++n)
  {
    vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0))
      ->GetPoint(vtkIdType(n), bent[n].data());
  }
  return bent;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2)
  {
    std::fprintf(stderr, "usage: RefinementBenchmark FILE\n");
    return 2;
  }
  vtkSMPTools::Initialize(1);
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(argv[1]);
  reader->Update();
  vtkDataObject* model = reader->GetOutputDataObject(0);
  const nurbs::Box3 box = ControlBox(model);
  if (box.isEmpty())
  {
    std::fprintf(stderr, "no faces\n");
    return 1;
  }
  const EdgeSamples rest = Sample(model);
  std::vector<std::vector<nurbs::Vec3>> exact;
  for (const double amount : Amounts)
  {
    exact.push_back(BendPoints(rest.Points, box, amount));
  }
  nurbs::Box3 used;
  for (const nurbs::Vec3& point : rest.Points)
  {
    used.extend(point);
  }
  const double diagonal = used.diagonal().norm();
  for (const double spacing : Spacings)
  {
    vtkNew<vtkNURBSRefinement> refine;
    refine->SetInputData(model);
    refine->SetMaximumControlPoints(1000000);
    measuring::Duration time;
    if (spacing > 0.0)
    {
      refine->SetMaximumSpacing(spacing);
      time = measuring::MedianTime(3, [&] {
        refine->Modified();
        refine->Update();
      });
    }
    vtkDataObject* dense = spacing > 0.0 ? refine->GetOutputDataObject(0) : model;
    vtkIdType points = 0;
    for (vtkUnstructuredGrid* grid : Leaves(dense))
    {
      points += grid->GetNumberOfPoints();
    }
    std::printf("{\"spacing\": %g, \"faces\": %zu, \"edges\": %zu, \"points\": %lld, "
                "\"seconds\": %.4f, \"bends\": [",
      spacing, rest.Faces, rest.Edges, static_cast<long long>(points), time.Processor);
    for (std::size_t k = 0; k < std::size(Amounts); ++k)
    {
      vtkNew<vtkNURBSFreeFormDeformation> filter;
      filter->SetInputData(dense);
      SetBend(filter, box, Amounts[k]);
      filter->Update();
      const EdgeSamples bent = Sample(filter->GetOutputDataObject(0));
      EdgeSamples own = rest;
      own.Points = exact[k];
      std::printf("%s{\"amount\": %g, \"gap\": %.6e, \"own\": %.6e, \"net\": %.6e}",
        k > 0 ? ", " : "", Amounts[k], LargestGap(bent) / diagonal, LargestGap(own) / diagonal,
        LargestGap(bent, &exact[k]) / diagonal);
    }
    std::printf("]}\n");
    std::fflush(stdout);
  }
  return 0;
}
