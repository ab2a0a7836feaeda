// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSViewAlgorithm.h"

#include "ContourForm.h"
#include "ModelExtent.h"
#include "vtkCamera.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <sstream>

vtkCxxSetObjectMacro(vtkNURBSViewAlgorithm, Camera, vtkCamera);

namespace
{

constexpr std::size_t QuickFaces = 8;
constexpr std::int64_t QuickPoints = 512;

} // namespace

vtkNURBSViewAlgorithm::vtkNURBSViewAlgorithm() = default;

vtkNURBSViewAlgorithm::~vtkNURBSViewAlgorithm()
{
  this->SetCamera(nullptr);
}

vtkMTimeType vtkNURBSViewAlgorithm::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Camera ? std::max(own, this->Camera->GetMTime()) : own;
}

int vtkNURBSViewAlgorithm::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

std::string vtkNURBSViewAlgorithm::CheckOptions() const
{
  std::ostringstream problem;
  if (!(this->Precision > 0.0) || !std::isfinite(this->Precision))
  {
    problem << "Precision must be positive, but is " << this->Precision;
  }
  else if (!(this->FeatureAngle > 0.0 && this->FeatureAngle <= 180.0))
  {
    problem << "FeatureAngle must be in (0, 180], but is " << this->FeatureAngle;
  }
  return problem.str();
}

nurbs::Viewer vtkNURBSViewAlgorithm::MakeViewer() const
{
  nurbs::Viewer out;
  const double* place = this->Projection == PERSPECTIVE ? this->EyePoint : this->Direction;
  out.Perspective = this->Projection == PERSPECTIVE;
  double back[3];
  if (this->Camera)
  {
    out.Perspective = !this->Camera->GetParallelProjection();
    this->Camera->GetDirectionOfProjection(back);
    vtkMath::MultiplyScalar(back, -1.0);
    place = out.Perspective ? this->Camera->GetPosition() : back;
  }
  out.Place = nurbs::Vec3(place[0], place[1], place[2]);
  return out;
}

double vtkNURBSViewAlgorithm::AbsolutePrecision(const vtkNURBSModelPool& pool) const
{
  const double size =
    nurbs::Diagonal(nurbs::FaceBoxes(pool.Model, pool.FaceErrors, vtkNURBSParallelFor));
  return this->Precision * (this->PrecisionMode == RELATIVE && size > 0.0 ? size : 1.0);
}

std::vector<int> vtkNURBSViewAlgorithm::PartsOf(const vtkNURBSModelPool& pool)
{
  std::vector<int> out(pool.Model.Faces.size());
  for (std::size_t k = 0; k < pool.Leaves.size(); ++k)
  {
    std::fill(
      out.begin() + pool.Leaves[k].FirstFace, out.begin() + pool.Leaves[k].LastFace, int(k));
  }
  return out;
}

bool vtkNURBSViewAlgorithm::IsQuick(const vtkNURBSModelPool& pool)
{
  const std::int64_t points =
    std::accumulate(pool.Model.Faces.begin(), pool.Model.Faces.end(), std::int64_t(0),
      [](std::int64_t sum, const nurbs::Face& face) { return sum + face.Geometry.Size(); });
  return pool.Model.Faces.size() <= QuickFaces && points <= QuickPoints;
}

double vtkNURBSViewAlgorithm::Now()
{
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

void vtkNURBSViewAlgorithm::ClearCounts()
{
  this->NumberOfFaces = this->NumberOfFailedFaces = this->NumberOfLines = 0;
  this->Seconds = 0.0;
}

void vtkNURBSViewAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Projection: " << (this->Projection == PERSPECTIVE ? "perspective" : "parallel")
     << "\n";
  os << indent << "Direction: " << this->Direction[0] << " " << this->Direction[1] << " "
     << this->Direction[2] << "\n";
  os << indent << "EyePoint: " << this->EyePoint[0] << " " << this->EyePoint[1] << " "
     << this->EyePoint[2] << "\n";
  os << indent << "Camera: " << this->Camera << "\n";
  os << indent << "PrecisionMode: " << (this->PrecisionMode == ABSOLUTE ? "absolute" : "relative")
     << "\n";
  os << indent << "Precision: " << this->Precision << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "Silhouettes: " << this->Silhouettes << "\n";
  os << indent << "BoundaryEdges: " << this->BoundaryEdges << "\n";
  os << indent << "SharpEdges: " << this->SharpEdges << "\n";
  os << indent << "SmoothEdges: " << this->SmoothEdges << "\n";
  os << indent << "NumberOfFaces: " << this->NumberOfFaces << "\n";
  os << indent << "NumberOfFailedFaces: " << this->NumberOfFailedFaces << "\n";
  os << indent << "NumberOfLines: " << this->NumberOfLines << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
}
