// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSCellLocator.h"

#include "RayCaster.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSParallel.h"

#include "vtkCellArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkNURBSCellLocator);

/// A model and what finds the way in it.
struct vtkNURBSCellLocator::Structure
{
  std::shared_ptr<const vtkNURBSModelView> View;
  nurbs::RayCaster Caster;

  explicit Structure(const std::shared_ptr<const vtkNURBSModelView>& view)
    : View(view)
    , Caster(view->GetModel(), vtkNURBSParallelFor)
  {}
};

namespace
{

nurbs::Ray Segment(const double p1[3], const double p2[3])
{
  nurbs::Ray ray;
  ray.Origin = Eigen::Map<const nurbs::Vec3>(p1);
  ray.Direction = Eigen::Map<const nurbs::Vec3>(p2) - ray.Origin;
  ray.Max = 1.0;
  return ray;
}

/// The square in the tangent plane, see vtkNURBSCellLocator.h.
void SetTangentSquare(vtkGenericCell* cell, const nurbs::SurfaceView& surface,
  const nurbs::RayHit& hit, const double pcoords[3], double size)
{
  const nurbs::Vec3 along = size * hit.Normal.unitOrthogonal();
  const nurbs::Vec3 across = hit.Normal.cross(along);
  const std::int64_t last = surface.Size() - 1;
  const std::int64_t width = surface.Count[0];
  const std::int64_t ids[4] = { 0, width - 1, last, last - width + 1 };
  cell->SetCellTypeToQuad();
  for (int k = 0; k < 4; ++k)
  {
    const double u = k == 1 || k == 2 ? 1.0 : 0.0;
    const double v = k >= 2 ? 1.0 : 0.0;
    const nurbs::Vec3 corner = hit.Point + (u - pcoords[0]) * along + (v - pcoords[1]) * across;
    cell->Points->SetPoint(k, corner.data());
    cell->PointIds->SetId(k, surface.Id(ids[k]));
  }
}

/// The faces of parts of surfaces, without repetitions.
class FaceList
{
public:
  explicit FaceList(const nurbs::RayCaster& caster)
    : Caster(caster)
  {}
  void operator()(std::int32_t part, const nurbs::Box3&)
  {
    this->Faces.push_back(this->Caster.GetFace(part));
  }
  void Give(vtkIdList* cells)
  {
    std::sort(this->Faces.begin(), this->Faces.end());
    this->Faces.erase(std::unique(this->Faces.begin(), this->Faces.end()), this->Faces.end());
    cells->Reset();
    for (const std::int64_t face : this->Faces)
    {
      cells->InsertNextId(face);
    }
  }

private:
  const nurbs::RayCaster& Caster;
  std::vector<std::int64_t> Faces;
};

} // namespace

vtkNURBSCellLocator::vtkNURBSCellLocator() = default;
vtkNURBSCellLocator::~vtkNURBSCellLocator() = default;

void vtkNURBSCellLocator::FreeSearchStructure()
{
  this->Content = nullptr;
}

void vtkNURBSCellLocator::BuildLocator()
{
  if (this->Content &&
    (this->UseExistingSearchStructure ||
      (this->DataSet && this->BuildTime > this->MTime &&
        this->BuildTime > this->DataSet->GetMTime())))
  {
    return;
  }
  this->Content = nullptr;
  vtkUnstructuredGrid* grid = vtkUnstructuredGrid::SafeDownCast(this->DataSet);
  if (!vtkNURBSModel::IsModel(grid))
  {
    vtkErrorMacro(<< "The data set must be a NURBS model, see vtkNURBSModel.");
    return;
  }
  const vtkNURBSParallelScope parallel;
  const auto view = vtkNURBSModel::View(grid);
  const std::string skipped = view->DescribeFaceErrors();
  if (!skipped.empty())
  {
    vtkWarningMacro(<< "Left out:\n" << skipped);
  }
  try
  {
    this->Content = std::make_shared<const Structure>(view);
    this->Level = 1;
    this->BuildTime.Modified();
  }
  catch (const nurbs::Error& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

std::shared_ptr<const nurbs::RayCaster> vtkNURBSCellLocator::GetRayCaster()
{
  this->BuildLocator();
  return this->Content
    ? std::shared_ptr<const nurbs::RayCaster>(this->Content, &this->Content->Caster)
    : nullptr;
}

int vtkNURBSCellLocator::IntersectWithLine(const double p1[3], const double p2[3], double,
  double& t, double x[3], double pcoords[3], int& subId, vtkIdType& cellId, vtkGenericCell* cell)
{
  const auto caster = this->GetRayCaster();
  nurbs::RayHit hit;
  try
  {
    if (!caster || !caster->Nearest(Segment(p1, p2), hit))
    {
      return 0;
    }
  }
  catch (const nurbs::Error& error)
  {
    vtkErrorMacro(<< error.what());
    return 0;
  }
  const nurbs::SurfaceView& surface = caster->GetModel().Faces[hit.Face].Geometry;
  const double at[2] = { hit.U, hit.V };
  for (int dir = 0; dir < 2; ++dir)
  {
    const nurbs::Interval domain = surface.Domain(dir);
    pcoords[dir] = (at[dir] - domain.Min) / domain.Length();
  }
  pcoords[2] = 0.0;
  t = hit.T;
  Eigen::Map<nurbs::Vec3>(x, 3) = hit.Point;
  subId = 0;
  cellId = hit.Face;
  if (cell)
  {
    SetTangentSquare(cell, surface, hit, pcoords, caster->Bounds().diagonal().norm());
  }
  return 1;
}

int vtkNURBSCellLocator::IntersectWithLine(
  const double p1[3], const double p2[3], vtkPoints* points, vtkIdList* cellIds)
{
  if (points)
  {
    points->Reset();
  }
  if (cellIds)
  {
    cellIds->Reset();
  }
  std::vector<nurbs::RayHit> hits;
  try
  {
    if (const auto caster = this->GetRayCaster())
    {
      caster->All(Segment(p1, p2), hits);
    }
  }
  catch (const nurbs::Error& error)
  {
    vtkErrorMacro(<< error.what());
  }
  int side = 0;
  for (const nurbs::RayHit& hit : hits)
  {
    side = side == 0 ? hit.Crossing : side;
    if (points)
    {
      points->InsertNextPoint(hit.Point.data());
    }
    if (cellIds)
    {
      cellIds->InsertNextId(hit.Face);
    }
  }
  return hits.empty() || side != 0 ? side : 1;
}

void vtkNURBSCellLocator::FindCellsAlongLine(
  const double p1[3], const double p2[3], double, vtkIdList* cells)
{
  vtkNew<vtkIdList> all;
  this->IntersectWithLine(p1, p2, static_cast<vtkPoints*>(nullptr), all);
  cells->Reset();
  for (vtkIdType i = 0; i < all->GetNumberOfIds(); ++i)
  {
    cells->InsertUniqueId(all->GetId(i));
  }
}

void vtkNURBSCellLocator::FindCellsWithinBounds(double* bbox, vtkIdList* cells)
{
  cells->Reset();
  if (const auto caster = this->GetRayCaster())
  {
    const nurbs::Box3 box(
      nurbs::Vec3(bbox[0], bbox[2], bbox[4]), nurbs::Vec3(bbox[1], bbox[3], bbox[5]));
    FaceList faces(*caster);
    caster->GetTree().Search([&](const nurbs::Box3& part) { return box.intersects(part); }, faces);
    faces.Give(cells);
  }
}

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
int vtkNURBSCellLocator::IntersectWithLine(const double p1[3], const double p2[3], const double,
  vtkPoints* points, vtkIdList* cellIds, vtkGenericCell*)
{
  return this->IntersectWithLine(p1, p2, points, cellIds) != 0 ? 1 : 0;
}

void vtkNURBSCellLocator::FindCellsAlongPlane(
  const double o[3], const double n[3], double tolerance, vtkIdList* cells)
{
  cells->Reset();
  if (const auto caster = this->GetRayCaster())
  {
    const nurbs::Vec3 normal = nurbs::Vec3(n[0], n[1], n[2]).normalized();
    const nurbs::Vec3 origin(o[0], o[1], o[2]);
    FaceList faces(*caster);
    const auto meets = [&](const nurbs::Box3& part) {
      const double reach = 0.5 * normal.cwiseAbs().dot(part.sizes());
      return std::abs(normal.dot(part.center() - origin)) <= reach + tolerance;
    };
    caster->GetTree().Search(meets, faces);
    faces.Give(cells);
  }
}

vtkIdType vtkNURBSCellLocator::FindCell(
  double x[3], double tol2, vtkGenericCell* cell, int&, double pcoords[3], double* weights)
{
  return this->FindCell(x, tol2, cell, pcoords, weights);
}
#endif

bool vtkNURBSCellLocator::InsideCellBounds(double x[3], vtkIdType cellId)
{
  double bounds[6];
  const double exact[3] = { 0.0, 0.0, 0.0 };
  this->DataSet->GetCellBounds(cellId, bounds);
  return vtkMath::PointIsWithinBounds(x, bounds, exact) != 0;
}

void vtkNURBSCellLocator::FindClosestPoint(
  const double*, double*, vtkGenericCell*, vtkIdType& cellId, int&, double&)
{
  cellId = -1;
  vtkErrorMacro(<< "Closest points of trimmed surfaces are not available.");
}

vtkIdType vtkNURBSCellLocator::FindClosestPointWithinRadius(
  double*, double, double*, vtkGenericCell*, vtkIdType& cellId, int&, double&, int&)
{
  cellId = -1;
  vtkErrorMacro(<< "Closest points of trimmed surfaces are not available.");
  return 0;
}

vtkIdType vtkNURBSCellLocator::FindCell(double*, double, vtkGenericCell*, double*, double*)
{
  vtkErrorMacro(<< "FindCell is not available: a surface has no inside.");
  return -1;
}

void vtkNURBSCellLocator::GenerateRepresentation(int, vtkPolyData* pd)
{
  // Corners 0 to 7: bits of x, y and z.
  static const int sides[6][4] = { { 0, 2, 6, 4 }, { 1, 5, 7, 3 }, { 0, 4, 5, 1 }, { 2, 3, 7, 6 },
    { 0, 1, 3, 2 }, { 4, 6, 7, 5 } };
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> quads;
  if (const auto caster = this->GetRayCaster())
  {
    const auto add = [&](std::int32_t, const nurbs::Box3& box) {
      const vtkIdType first = points->GetNumberOfPoints();
      for (int k = 0; k < 8; ++k)
      {
        points->InsertNextPoint(box.corner(static_cast<nurbs::Box3::CornerType>(k)).eval().data());
      }
      for (const int(&side)[4] : sides)
      {
        const vtkIdType ids[4] = { first + side[0], first + side[1], first + side[2],
          first + side[3] };
        quads->InsertNextCell(4, ids);
      }
    };
    caster->GetTree().Search([](const nurbs::Box3&) { return true; }, add);
  }
  pd->SetPoints(points);
  pd->SetPolys(quads);
}

void vtkNURBSCellLocator::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Built: " << (this->Content ? "yes" : "no") << "\n";
  if (this->Content)
  {
    os << indent << "Parts: " << this->Content->Caster.PartCount() << "\n";
    os << indent << "MemoryUse: " << this->Content->Caster.MemoryUse() << "\n";
  }
}
