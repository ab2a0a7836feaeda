// SPDX-License-Identifier: BSD-3-Clause
// The meshes of vtkNURBSTessellator against what is known of the shapes: where they are open, which
// area and volume they have, and how far triangles and surfaces are apart.
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTessellator.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStaticCellLocator.h"
#include "vtkUnstructuredGrid.h"

#include <vtksys/SystemTools.hxx>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

namespace
{

constexpr double Pi = 3.14159265358979323846;

using nurbs::Vec2;
using nurbs::Vec3;
using Coordinates = std::array<double, 3>;
using Segment = std::pair<Coordinates, Coordinates>;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

Grid Make(int shape)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  source->SetNumberOfPatches(150);
  source->SetSheetPoints(12, 12);
  source->Update();
  return source->GetOutput();
}

struct Corner
{
  Vec3 Point;
  Vec3 Normal = Vec3::Zero();
  Vec2 UV = Vec2::Zero();
};

struct Triangle
{
  std::array<Corner, 3> Corners;
  vtkIdType Face = 0;

  Vec3 Cross() const
  {
    const Vec3& a = this->Corners[0].Point;
    return (this->Corners[1].Point - a).cross(this->Corners[2].Point - a);
  }
};

std::vector<Triangle> TrianglesOf(vtkPolyData* mesh)
{
  std::vector<Triangle> triangles(static_cast<std::size_t>(mesh->GetNumberOfPolys()));
  vtkDataArray* faces = mesh->GetCellData()->GetArray(vtkNURBSModel::FaceIdName());
  vtkDataArray* normals = mesh->GetPointData()->GetNormals();
  vtkDataArray* uv = mesh->GetPointData()->GetArray("UV");
  vtkNew<vtkIdList> ids;
  for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
  {
    mesh->GetPolys()->GetCellAtId(t, ids);
    for (int c = 0; c < 3; ++c)
    {
      Corner& corner = triangles[t].Corners[c];
      mesh->GetPoint(ids->GetId(c), corner.Point.data());
      if (normals && uv)
      {
        normals->GetTuple(ids->GetId(c), corner.Normal.data());
        uv->GetTuple(ids->GetId(c), corner.UV.data());
      }
    }
    triangles[t].Face = static_cast<vtkIdType>(faces->GetTuple1(t));
  }
  return triangles;
}

/// A tessellator that has run, and its triangles.
struct Result
{
  vtkNew<vtkNURBSTessellator> Filter;
  vtkPolyData* Mesh = nullptr;
  vtkPolyData* Lines = nullptr;
  std::vector<Triangle> Triangles;

  void Run(vtkUnstructuredGrid* grid)
  {
    this->Filter->SetInputData(grid);
    this->Filter->Update();
    this->Mesh = vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(0));
    this->Lines = vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(1));
    this->Triangles = TrianglesOf(this->Mesh);
  }

  double FaceError(vtkIdType face) const
  {
    return this->Mesh->GetFieldData()->GetArray("FaceCertifiedError")->GetTuple1(face);
  }
};

Coordinates Key(const Vec3& p)
{
  return { p[0] + 0.0, p[1] + 0.0, p[2] + 0.0 };
}

Segment Undirected(const Vec3& a, const Vec3& b)
{
  return std::minmax(Key(a), Key(b));
}

/// How often each edge of the triangles is there, by its exact coordinates: uses one way minus uses
/// the other way, which is 0 inside of an oriented surface.
std::map<Segment, std::pair<int, int>> EdgesOf(const std::vector<Triangle>& triangles)
{
  std::map<Segment, std::pair<int, int>> edges;
  for (const Triangle& triangle : triangles)
  {
    for (int c = 0; c < 3; ++c)
    {
      const Vec3& a = triangle.Corners[c].Point;
      const Vec3& b = triangle.Corners[(c + 1) % 3].Point;
      if (Key(a) != Key(b))
      {
        auto& uses = edges[Undirected(a, b)];
        ++(Key(a) < Key(b) ? uses.first : uses.second);
      }
    }
  }
  return edges;
}

/// The segments of all polylines whose edge is used once: where the model is open.
std::map<Segment, int> OpenSegments(vtkPolyData* lines)
{
  std::map<Segment, int> segments;
  vtkNew<vtkIdList> ids;
  for (vtkIdType l = 0; l < lines->GetNumberOfLines(); ++l)
  {
    lines->GetLines()->GetCellAtId(l, ids);
    for (vtkIdType k = 0; k + 1 < ids->GetNumberOfIds(); ++k)
    {
      Vec3 a, b;
      lines->GetPoint(ids->GetId(k), a.data());
      lines->GetPoint(ids->GetId(k + 1), b.data());
      ++segments[Undirected(a, b)];
    }
  }
  for (auto it = segments.begin(); it != segments.end();)
  {
    it = it->second == 1 ? std::next(it) : segments.erase(it);
  }
  return segments;
}

TEST(TessellatorMeshes, AreOpenExactlyWhereTheModelIs)
{
  for (int shape = vtkNURBSShapeSource::SPHERE; shape <= vtkNURBSShapeSource::CAR_BODY; ++shape)
  {
    for (const double tolerance : { 1e-2, 1e-3 })
    {
      SCOPED_TRACE("shape " + std::to_string(shape) + " at " + std::to_string(tolerance));
      Result result;
      result.Filter->SetTolerance(tolerance);
      result.Run(Make(shape));
      const auto expected = OpenSegments(result.Lines);
      if (shape <= vtkNURBSShapeSource::CONE)
      {
        EXPECT_TRUE(expected.empty());
      }
      std::size_t open = 0, strange = 0, misdirected = 0;
      for (const auto& [segment, uses] : EdgesOf(result.Triangles))
      {
        const bool single = uses.first + uses.second == 1;
        open += single;
        strange += single && expected.count(segment) == 0;
        misdirected += !single && uses.first != uses.second;
      }
      EXPECT_EQ(open, expected.size());
      EXPECT_EQ(strange, 0u);
      EXPECT_EQ(misdirected, 0u);
    }
  }
}

TEST(TessellatorMeshes, AreaAndVolumeConverge)
{
  struct Solid
  {
    int Shape;
    double Area, Volume;
  };
  // The shape source's defaults: radius 1, tube radius 0.3, height 2.
  const Solid solids[] = { { vtkNURBSShapeSource::SPHERE, 4.0 * Pi, 4.0 * Pi / 3.0 },
    { vtkNURBSShapeSource::TORUS, 4.0 * Pi * Pi * 0.3, 2.0 * Pi * Pi * 0.09 },
    { vtkNURBSShapeSource::CYLINDER, 6.0 * Pi, 2.0 * Pi },
    { vtkNURBSShapeSource::CONE, Pi * (1.0 + std::sqrt(5.0)), 2.0 * Pi / 3.0 } };
  for (const Solid& solid : solids)
  {
    for (const double tolerance : { 1e-2, 1e-3, 1e-4 })
    {
      SCOPED_TRACE("shape " + std::to_string(solid.Shape) + " at " + std::to_string(tolerance));
      Result result;
      result.Filter->SetToleranceModeToAbsolute();
      result.Filter->SetAbsoluteTolerance(tolerance);
      result.Run(Make(solid.Shape));
      double area = 0.0, volume = 0.0;
      for (const Triangle& triangle : result.Triangles)
      {
        area += 0.5 * triangle.Cross().norm();
        volume += triangle.Cross().dot(triangle.Corners[0].Point) / 6.0;
      }
      // No point between mesh and surface is farther from the surface than the tolerance. The volume
      // is positive because triangles run counter-clockwise seen from outside.
      EXPECT_NEAR(volume, solid.Volume, 1.05 * tolerance * solid.Area);
      // Curvatures are at most 1 / 0.3; facets are inclined to the surface in proportion to
      // the root of tolerance and curvature.
      EXPECT_NEAR(area, solid.Area, 8.0 * tolerance / 0.3 * solid.Area);
    }
  }
}

TEST(TessellatorMeshes, PlanarFacesHaveTheirAreas)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToPlate();
  source->SetPlateHoles(5, 2);
  source->Update();
  for (const double tolerance : { 1e-2, 1e-4 })
  {
    Result result;
    result.Filter->SetToleranceModeToAbsolute();
    result.Filter->SetAbsoluteTolerance(tolerance);
    result.Run(source->GetOutput());
    double area = 0.0;
    for (const Triangle& triangle : result.Triangles)
    {
      area += 0.5 * triangle.Cross()[2]; // Signed: a folded triangle would be missed twice.
      EXPECT_GE(triangle.Cross()[2], 0.0);
      EXPECT_EQ(triangle.Corners[0].Point[2], 0.0);
    }
    double length = 0.0;
    for (const auto& segment : OpenSegments(result.Lines))
    {
      length += (Vec3(segment.first.first.data()) - Vec3(segment.first.second.data())).norm();
    }
    EXPECT_NEAR(area, source->GetPlateArea(), tolerance * length);
  }
}

/// The largest of all triangles: length of a side, and angle in degrees between normals at corners.
struct Extremes
{
  double Length = 0.0, Angle = 0.0;

  explicit Extremes(const std::vector<Triangle>& triangles)
  {
    for (const Triangle& triangle : triangles)
    {
      for (int c = 0; c < 3; ++c)
      {
        const Corner& a = triangle.Corners[c];
        const Corner& b = triangle.Corners[(c + 1) % 3];
        this->Length = std::max(this->Length, (a.Point - b.Point).norm());
        this->Angle = std::max(this->Angle,
          std::atan2(a.Normal.cross(b.Normal).norm(), a.Normal.dot(b.Normal)) * 180 / Pi);
      }
    }
  }
};

/// Compares every side and every pair of normals with the limits, one limit at a time and both.
void ExpectLimits(vtkUnstructuredGrid* grid, double length, double angle)
{
  for (const double tolerance : { 1e-2, 1e-3 })
  {
    for (int limits = 1; limits <= 3; ++limits)
    {
      SCOPED_TRACE("limits " + std::to_string(limits) + " at " + std::to_string(tolerance));
      Result free, limited;
      free.Filter->SetTolerance(tolerance);
      free.Run(grid);
      limited.Filter->SetTolerance(tolerance);
      limited.Filter->SetMaximumEdgeLength(limits & 1 ? length : 0.0);
      limited.Filter->SetMaximumAngle(limits & 2 ? angle : 0.0);
      limited.Run(grid);
      const Extremes found(limited.Triangles);
      if (limits & 1)
      {
        EXPECT_LE(found.Length, length * (1.0 + 1e-6));
        EXPECT_GT(found.Length, 0.5 * length); // Not much finer than asked for.
      }
      if (limits & 2)
      {
        EXPECT_LE(found.Angle, angle + 1e-3);
      }
      EXPECT_GE(limited.Triangles.size(), free.Triangles.size());
      EXPECT_LE(limited.Filter->GetNumberOfCappedFaces(), free.Filter->GetNumberOfCappedFaces());
      std::size_t odd = 0;
      const auto open = OpenSegments(limited.Lines);
      for (const auto& [segment, uses] : EdgesOf(limited.Triangles))
      {
        odd += uses.first + uses.second == 1 && open.count(segment) == 0;
      }
      EXPECT_EQ(odd, 0u);
    }
  }
}

TEST(TessellatorLimits, HoldForEveryTriangleOfShapes)
{
  for (const int shape : { vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::TORUS,
         vtkNURBSShapeSource::CYLINDER, vtkNURBSShapeSource::CONE })
  {
    SCOPED_TRACE("shape " + std::to_string(shape));
    ExpectLimits(Make(shape), 0.15, 8.0);
  }
}

TEST(TessellatorLimits, HoldForEveryTriangleOfAPlateWithHoles)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToPlate();
  source->SetPlateHoles(4, 3);
  source->Update();
  ExpectLimits(source->GetOutput(), 0.12, 10.0);
}

TEST(TessellatorLimits, HoldForEveryTriangleOfACarBody)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(vtkNURBSShapeSource::CAR_BODY);
  source->SetNumberOfPatches(50);
  source->Update();
  ExpectLimits(source->GetOutput(), 120.0, 4.0); // A car of 4.4 m.
}

TEST(TessellatorLimits, HoldForEveryTriangleOfACADFile)
{
  const std::string file = "/usr/share/opencascade/data/step/linkrods.step";
  ASSERT_TRUE(vtksys::SystemTools::FileExists(file))
    << file << " is not there (Debian package occt-misc)";
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  const auto models = vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
  ExpectLimits(vtkUnstructuredGrid::SafeDownCast(models->GetPartition(0, 0)), 0.5, 10.0);
}

/// The edges of the car body's holes are fitted to their trim curves: they miss these by up to a few
/// tenths of the tolerance, but nowhere at the fit's knots. The polylines must leave room for that.
TEST(TessellatorMeshes, EdgesLeaveRoomForTheGapsOfTheirFaces)
{
  Result result;
  result.Run(Make(vtkNURBSShapeSource::CAR_BODY));
  EXPECT_EQ(result.Filter->GetNumberOfCappedFaces(), 0);
  EXPECT_LE(result.Filter->GetCertifiedError(), result.Filter->GetToleranceUsed());
}

/// Distance of a point from the closed form of a face.
double Deviation(int shape, vtkIdType face, const Vec3& p)
{
  const double r = std::hypot(p[0], p[1]);
  switch (shape)
  {
    case vtkNURBSShapeSource::SPHERE:
      return std::abs(p.norm() - 1.0);
    case vtkNURBSShapeSource::TORUS:
      return std::abs(std::hypot(r - 1.0, p[2]) - 0.3);
    case vtkNURBSShapeSource::CYLINDER:
      return face == 0 ? std::abs(r - 1.0) : std::min(std::abs(p[2]), std::abs(p[2] - 2.0));
    case vtkNURBSShapeSource::CONE:
      return face == 0 ? std::abs(r - 1.0 + 0.5 * p[2]) / std::sqrt(1.25) : std::abs(p[2]);
    default:
      return std::abs(p[2]);
  }
}

/// Calls body(point, uv) at places spread over a triangle, its corners and edges included.
template <typename Body>
void ForSamples(const Triangle& triangle, int steps, const Body& body)
{
  const auto& c = triangle.Corners;
  for (int i = 0; i <= steps; ++i)
  {
    for (int j = 0; i + j <= steps; ++j)
    {
      const double a = static_cast<double>(i) / steps, b = static_cast<double>(j) / steps;
      body(Vec3((1.0 - a - b) * c[0].Point + a * c[1].Point + b * c[2].Point),
        Vec2((1.0 - a - b) * c[0].UV + a * c[1].UV + b * c[2].UV));
    }
  }
}

TEST(TessellatorMeshes, SamplesOfTrianglesAreWithinTheCertifiedError)
{
  for (int shape = vtkNURBSShapeSource::SPHERE; shape <= vtkNURBSShapeSource::PLATE; ++shape)
  {
    for (int method = 0; method < 3; ++method)
    {
      SCOPED_TRACE("shape " + std::to_string(shape) + " by method " + std::to_string(method));
      Result result;
      result.Filter->SetMethod(method);
      result.Run(Make(shape));
      EXPECT_EQ(result.Filter->GetNumberOfCappedFaces(), 0);
      EXPECT_LE(result.Filter->GetCertifiedError(), result.Filter->GetToleranceUsed());
      double worst = 0.0;
      for (const Triangle& triangle : result.Triangles)
      {
        ForSamples(triangle, 6, [&](const Vec3& p, const Vec2&) {
          const double deviation = Deviation(shape, triangle.Face, p);
          worst = std::max(worst, deviation);
          EXPECT_LE(deviation, result.FaceError(triangle.Face) + 1e-12);
        });
      }
      // A bound that is never near would be worth little.
      if (shape == vtkNURBSShapeSource::SPHERE || shape == vtkNURBSShapeSource::TORUS)
      {
        EXPECT_GT(worst, 0.2 * result.Filter->GetCertifiedError());
      }
    }
  }
}

/// Distance of p from the surface near (u, v), by Gauss-Newton steps: never less than the true one.
double DistanceNear(const nurbs::SurfaceView& surface, const Vec3& p, Vec2 uv)
{
  const nurbs::Interval u = surface.Domain(0), v = surface.Domain(1);
  double best = VTK_DOUBLE_MAX;
  for (int step = 0; step < 6; ++step)
  {
    const nurbs::SurfaceDerivatives d = nurbs::EvaluateDerivatives(surface, uv[0], uv[1], 1);
    best = std::min(best, (d.S - p).norm());
    const Vec3 r = p - d.S;
    const double a = d.Su.dot(d.Su), b = d.Su.dot(d.Sv), c = d.Sv.dot(d.Sv);
    const double determinant = a * c - b * b;
    if (!(determinant > 1e-14 * a * c))
    {
      break;
    }
    const double x = r.dot(d.Su), y = r.dot(d.Sv);
    uv[0] = u.Clamp(uv[0] + (c * x - b * y) / determinant);
    uv[1] = v.Clamp(uv[1] + (a * y - b * x) / determinant);
  }
  return best;
}

TEST(TessellatorMeshes, FreeFormSurfacesAreWithinTheCertifiedErrorBothWays)
{
  for (const int shape : { vtkNURBSShapeSource::TEAPOT, vtkNURBSShapeSource::SHEET })
  {
    SCOPED_TRACE(shape);
    Result result;
    const Grid grid = Make(shape);
    result.Run(grid);
    const auto view = vtkNURBSModel::View(grid);
    const auto& faces = view->GetModel().Faces;
    vtkNew<vtkStaticCellLocator> locator;
    locator->SetDataSet(result.Mesh);
    locator->BuildLocator();
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      const nurbs::SurfaceView& surface = faces[f].Geometry;
      const nurbs::Interval u = surface.Domain(0), v = surface.Domain(1);
      for (int k = 0; k < 30 * 30; ++k)
      {
        const double s = u.Min + u.Length() * (k % 30) / 29.0;
        const double t = v.Min + v.Length() * (k / 30) / 29.0;
        const Vec3 p = nurbs::Evaluate(surface, s, t);
        double closest[3], distance2 = 0.0;
        vtkIdType cell = -1;
        int sub = 0;
        locator->FindClosestPoint(p.data(), closest, cell, sub, distance2);
        EXPECT_LE(std::sqrt(distance2), result.FaceError(f) + 1e-9) << "face " << f;
      }
    }
    for (std::size_t t = 0; t < result.Triangles.size(); ++t)
    {
      const Triangle& triangle = result.Triangles[t];
      ForSamples(triangle, 3, [&](const Vec3& p, const Vec2& uv) {
        EXPECT_LE(DistanceNear(faces[triangle.Face].Geometry, p, uv),
          result.FaceError(triangle.Face) + 1e-9)
          << "triangle " << t << " of face " << triangle.Face;
      });
    }
  }
}

TEST(TessellatorMeshes, PointsAndNormalsAreThoseOfTheSurfaceAtTheirParameters)
{
  for (const int shape :
    { vtkNURBSShapeSource::CONE, vtkNURBSShapeSource::TEAPOT, vtkNURBSShapeSource::CAR_BODY })
  {
    SCOPED_TRACE(shape);
    Result result;
    const Grid grid = Make(shape);
    result.Run(grid);
    const auto view = vtkNURBSModel::View(grid);
    double gap = 1e-9; // Points of an edge may be off a face's own surface by the edge's tolerance.
    for (const nurbs::Edge& edge : view->GetModel().Edges)
    {
      gap = std::max(gap, 2.0 * edge.Tolerance);
    }
    for (const Triangle& triangle : result.Triangles)
    {
      const nurbs::Face& face = view->GetModel().Faces[triangle.Face];
      for (const Corner& corner : triangle.Corners)
      {
        const Vec3 p = nurbs::Evaluate(face.Geometry, corner.UV[0], corner.UV[1]);
        EXPECT_LE((p - corner.Point).norm(), gap) << "face " << triangle.Face;
        EXPECT_NEAR(corner.Normal.norm(), 1.0, 1e-6) << "face " << triangle.Face;
        const Vec3 n = nurbs::Normal(face.Geometry, corner.UV[0], corner.UV[1]);
        EXPECT_GT(corner.Normal.dot(n) * (face.Reversed ? -1.0 : 1.0), 0.9999)
          << "face " << triangle.Face << " at " << corner.UV.transpose();
      }
    }
  }
}

} // namespace
