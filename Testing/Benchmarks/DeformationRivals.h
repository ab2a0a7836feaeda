// SPDX-License-Identifier: BSD-3-Clause
/// @file DeformationRivals.h
/// @brief Ways to bring the mesh of a surface up to date after a control point has moved.
///
/// Source: Li, Lau, Green 1997, section 6 and figure 2, and today's alternatives. Each rival leaves
/// points and unit normals of the whole surface behind, after every move. They agree on what they
/// are given: a surface (clamped, interior multiplicity <= degree, no poles) and the parameters of
/// the vertices. One thread, double precision.
#pragma once

#include "Surface.h"

#include <array>
#include <memory>

namespace nurbs
{

/// The vertices' parameters: each non-empty knot span is cut into the same number of cells.
struct SampleGrid
{
  /// @param cells cells a span and direction, >= 1.
  SampleGrid(const Surface& surface, int cells);

  /// [first, last) of Parameters[dir]: those in the support [u_s, u_{s+q}) of control point `s`, or
  /// up to the end of the domain.
  std::array<int, 2> Support(const Surface& surface, int dir, int s) const;
  std::int64_t Count() const
  {
    return std::int64_t(this->Parameters[0].size()) * std::int64_t(this->Parameters[1].size());
  }

  int Cells;
  std::vector<double> Breaks[2];     ///< Distinct knots of the domain.
  std::vector<double> Parameters[2]; ///< Ascending; both ends of the domain are in.
};

/// Vertices, and triangles that index them.
struct DeformationMesh
{
  std::vector<double> Points;     ///< xyz triples; on a grid u fastest.
  std::vector<double> Normals;    ///< Unit length, likewise.
  std::vector<int> Triangles;     ///< Triples.
  std::vector<double> Parameters; ///< uv pairs, of methods that choose vertices themselves.
};

/// One method. It keeps a surface of its own, whose control points the caller moves one a frame.
class DeformationRival
{
public:
  virtual ~DeformationRival() = default;

  /// What tables call it.
  virtual const char* GetName() const = 0;

  /// Takes the surface and makes the first mesh: whatever is not done for every frame.
  void Prepare(const Surface& surface, const SampleGrid& grid);

  /// A frame: moves control point `index` and brings the mesh up to date.
  void Move(std::int64_t index, const Vec3& position);

  const Surface& GetSurface() const { return this->Deformed; }
  virtual const DeformationMesh& GetMesh() const { return this->Mesh; }

protected:
  /// The whole mesh of Deformed. Prepare has set Grid and, for its vertices, the mesh's size and
  /// triangles.
  virtual void Polygonise() = 0;

  /// Control point `index` of Deformed has moved, it was at `before`. As a rule, all is done again.
  virtual void Update(std::int64_t index, const Vec3& before);

  Surface Deformed;
  std::unique_ptr<SampleGrid> Grid;
  DeformationMesh Mesh;
};

/// Oslo (a): knots at the vertices' parameters are inserted into the net, `multiplicity` times each.
/// At the degree they stop being knots between polynomials: every vertex is a control point, and
/// normals are differences of them. At 1 the net is as fine as the mesh, and the surface at a knot is
/// a combination of `degree` control points a direction. Anything between works as well.
std::unique_ptr<DeformationRival> MakeOsloRival(int multiplicity);

/// Bezier (b): patches by knot insertion, then Horner's scheme. As Mesa's evaluators do, each vertex
/// is on its own: the columns of its patch become a curve by u, and the curve a point by v. With
/// `sharedRows`, which Mesa does not do, the vertices of a row share its curve.
std::unique_ptr<DeformationRival> MakeBezierRival(bool sharedRows);

/// Full evaluation (e): SurfaceEvaluator::Grid, with a new evaluator for each frame's control net.
std::unique_ptr<DeformationRival> MakeGridRival();

/// Local evaluation (f): the same for the vertices in the moved point's support only, with an
/// evaluator of the control points that these depend on.
std::unique_ptr<DeformationRival> MakeLocalGridRival();

} // namespace nurbs
