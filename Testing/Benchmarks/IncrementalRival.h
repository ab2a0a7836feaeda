// SPDX-License-Identifier: BSD-3-Clause
/// @file IncrementalRival.h
/// @brief This suite's own entry among the methods of DeformationRivals.h.
#pragma once

#include "DeformationRivals.h"
#include "DeformingModel.h"

namespace nurbs
{

/// Increments (c, d) by DeformingModel. Without refinement (d) the mesh is the grid, whose cells a span
/// must be a power of two. With refinement (c) it has about as many vertices, by the tolerance, which
/// is searched by Prepare.
class IncrementalRival : public DeformationRival
{
public:
  explicit IncrementalRival(bool refine)
    : Refine(refine)
  {}

  const char* GetName() const override
  {
    return this->Refine ? "increments, refined" : "increments";
  }
  const DeformationMesh& GetMesh() const override;
  const FrameReport& GetReport() const { return this->Report; }
  std::int64_t Triangles() const { return this->Arrays.TriangleCount; }
  double GetTolerance() const { return this->Tolerance; }

protected:
  void Polygonise() override;
  void Update(std::int64_t index, const Vec3& before) override;

private:
  void Make(double tolerance);

  bool Refine;
  double Tolerance = 0.0;
  Model Whole;
  MeshVectors Arrays;
  std::unique_ptr<DeformingModel> Deforming;
  FrameReport Report;
  mutable DeformationMesh Copied;
};

} // namespace nurbs
