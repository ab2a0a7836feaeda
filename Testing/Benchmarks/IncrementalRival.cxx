// SPDX-License-Identifier: BSD-3-Clause
#include "IncrementalRival.h"

#include <cmath>

namespace nurbs
{

const DeformationMesh& IncrementalRival::GetMesh() const
{
  const std::size_t points = std::size_t(this->Arrays.PointCount);
  this->Copied.Points.assign(this->Arrays.Points, this->Arrays.Points + 3 * points);
  this->Copied.Normals.assign(this->Arrays.Normals, this->Arrays.Normals + 3 * points);
  this->Copied.Parameters.assign(this->Arrays.UV, this->Arrays.UV + 2 * points);
  this->Copied.Triangles.assign(
    this->Arrays.Corners, this->Arrays.Corners + 3 * this->Arrays.TriangleCount);
  return this->Copied;
}

void IncrementalRival::Make(double tolerance)
{
  DeformingOptions options;
  options.Tolerance = tolerance;
  options.FixedDepth = this->Refine ? -1 : int(std::lround(std::log2(this->Grid->Cells)));
  this->Deforming.reset();
  this->Deforming = std::make_unique<DeformingModel>(
    this->Whole, std::vector<std::string>(1), options, this->Arrays);
  this->Tolerance = tolerance;
}

void IncrementalRival::Polygonise()
{
  this->Whole.Faces.assign(1, Face());
  this->Whole.Faces[0].Geometry = this->Deformed.View();
  if (!this->Refine)
  {
    this->Make(1.0);
    return;
  }
  double low = 1e-9;
  double high = 1.0;
  for (int k = 0; k < 30 && high > 1.02 * low; ++k)
  {
    this->Make(std::sqrt(low * high));
    (this->Arrays.PointCount > this->Grid->Count() ? low : high) = this->Tolerance;
  }
}

void IncrementalRival::Update(std::int64_t, const Vec3&)
{
  this->Whole.Faces[0].Geometry = this->Deformed.View();
  this->Report = this->Deforming->Update(this->Whole);
  if (!this->Report.Accepted)
  {
    throw Error(this->Report.Problem);
  }
}

} // namespace nurbs
