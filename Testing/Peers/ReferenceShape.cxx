// SPDX-License-Identifier: BSD-3-Clause
#include "ReferenceShape.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Precision.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace verify
{

namespace
{

template <class Reader>
TopoDS_Shape ReadExchange(const std::string& file)
{
  Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone)
  {
    throw std::runtime_error(file + ": not readable");
  }
  reader.TransferRoots();
  return reader.OneShape();
}

std::string Extension(const std::string& file)
{
  std::string e = file.substr(std::min(file.size(), file.rfind('.') + 1));
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return char(tolower(c)); });
  return e;
}

bool UsesEveryEdgeTwice(const ReferenceShape& shape, const Body& body)
{
  TopTools_DataMapOfShapeInteger uses;
  for (int f : body.Faces)
  {
    for (TopExp_Explorer e(shape.Faces[std::size_t(f)], TopAbs_EDGE); e.More(); e.Next())
    {
      if (!BRep_Tool::Degenerated(TopoDS::Edge(e.Current())))
      {
        Standard_Integer* count = uses.ChangeSeek(e.Current());
        count ? void(++*count) : void(uses.Bind(e.Current(), 1));
      }
    }
  }
  for (TopTools_DataMapOfShapeInteger::Iterator it(uses); it.More(); it.Next())
  {
    if (it.Value() % 2 != 0)
    {
      return false;
    }
  }
  return !uses.IsEmpty();
}

// The exploration below meets the faces in the same order as that of the root.
void CollectBodies(ReferenceShape& shape)
{
  int next = 0;
  auto collect = [&](const TopoDS_Shape& s) {
    Body body;
    for (TopExp_Explorer f(s, TopAbs_FACE); f.More(); f.Next())
    {
      body.Faces.push_back(next++);
    }
    body.Closed = UsesEveryEdgeTwice(shape, body);
    shape.Bodies.push_back(body);
  };
  std::vector<TopoDS_Shape> pending{ shape.Root };
  while (!pending.empty())
  {
    const TopoDS_Shape s = pending.back();
    pending.pop_back();
    if (s.ShapeType() == TopAbs_COMPOUND || s.ShapeType() == TopAbs_COMPSOLID)
    {
      std::vector<TopoDS_Shape> children;
      for (TopoDS_Iterator it(s); it.More(); it.Next())
      {
        children.push_back(it.Value());
      }
      pending.insert(pending.end(), children.rbegin(), children.rend());
    }
    else if (s.ShapeType() <= TopAbs_FACE)
    {
      collect(s);
    }
  }
}

struct EdgeOnFace
{
  TopoDS_Edge Edge;
  TopoDS_Face Face;
};

double PointGap(const TopoDS_Vertex& vertex, const gp_Pnt& p)
{
  return vertex.IsNull() ? 0.0 : BRep_Tool::Pnt(vertex).Distance(p);
}

double InDomain(double t, double first, double last, bool periodic)
{
  return periodic ? t : std::clamp(t, first, last);
}

// Distance of the lifted pcurve from the 3D curve at equal parameters, and of its ends from the
// vertices. Edges that are not "same parameter" are compared by nearest sample instead.
double EdgeGap(const EdgeOnFace& use)
{
  double first2 = 0.0, last2 = 0.0, first3 = 0.0, last3 = 0.0;
  const auto pcurve = BRep_Tool::CurveOnSurface(use.Edge, use.Face, first2, last2);
  if (pcurve.IsNull())
  {
    return 0.0;
  }
  TopLoc_Location place;
  auto curve = BRep_Tool::Curve(use.Edge, place, first3, last3);
  const BRepAdaptor_Surface surface(use.Face, Standard_False);
  auto lifted = [&](double s) {
    const gp_Pnt2d uv = pcurve->Value(first2 + s * (last2 - first2));
    return surface.Value(
      InDomain(uv.X(), surface.FirstUParameter(), surface.LastUParameter(), surface.IsUPeriodic()),
      InDomain(uv.Y(), surface.FirstVParameter(), surface.LastVParameter(), surface.IsVPeriodic()));
  };
  TopoDS_Vertex start, end;
  TopExp::Vertices(TopoDS::Edge(use.Edge.Oriented(TopAbs_FORWARD)), start, end);
  double gap = std::max(PointGap(start, lifted(0.0)), PointGap(end, lifted(1.0)));
  if (curve.IsNull() || BRep_Tool::Degenerated(use.Edge))
  {
    return gap;
  }
  auto in3d = [&](double s) {
    return curve->Value(first3 + s * (last3 - first3)).Transformed(place.Transformation());
  };
  gap = std::max({ gap, PointGap(start, in3d(0.0)), PointGap(end, in3d(1.0)) });
  const int steps = 256 + 8 * Geom2dAdaptor_Curve(pcurve, first2, last2).NbIntervals(GeomAbs_CN);
  const bool same = BRep_Tool::SameParameter(use.Edge);
  for (int i = 0; i <= steps; ++i)
  {
    const gp_Pnt p = lifted(double(i) / steps);
    double d = p.Distance(in3d(double(i) / steps));
    for (int k = 0; !same && k <= steps; ++k)
    {
      d = std::min(d, p.Distance(in3d(double(k) / steps)));
    }
    gap = std::max(gap, d);
  }
  return gap;
}

} // namespace

TopoDS_Shape ReadShape(const std::string& file)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const std::string extension = Extension(file);
  TopoDS_Shape shape;
  if (extension == "step" || extension == "stp")
  {
    shape = ReadExchange<STEPControl_Reader>(file);
  }
  else if (extension == "iges" || extension == "igs")
  {
    shape = ReadExchange<IGESControl_Reader>(file);
  }
  else
  {
    BRep_Builder builder;
    BRepTools::Read(shape, file.c_str(), builder);
  }
  if (shape.IsNull())
  {
    throw std::runtime_error(file + ": no shape in it");
  }
  BRepTools::Clean(shape);
  return shape;
}

ReferenceShape Describe(const TopoDS_Shape& root)
{
  ReferenceShape shape;
  shape.Root = root;
  for (TopExp_Explorer f(root, TopAbs_FACE); f.More(); f.Next())
  {
    shape.Faces.push_back(TopoDS::Face(f.Current()));
  }
  CollectBodies(shape);
  Bnd_Box box;
  BRepBndLib::AddOptimal(root, box, Standard_False, Standard_False);
  shape.Diagonal = box.IsVoid() ? 0.0 : box.CornerMin().Distance(box.CornerMax());
  return shape;
}

std::vector<FaceGap> MeasureGaps(const ReferenceShape& shape)
{
  TopTools_DataMapOfShapeInteger ids;
  std::vector<double> edgeGaps;
  std::vector<std::vector<int>> faceEdges(shape.Faces.size());
  std::vector<FaceGap> gaps(shape.Faces.size());
  for (std::size_t f = 0; f < shape.Faces.size(); ++f)
  {
    for (TopExp_Explorer e(shape.Faces[f], TopAbs_EDGE); e.More(); e.Next())
    {
      if (!ids.IsBound(e.Current()))
      {
        ids.Bind(e.Current(), int(edgeGaps.size()));
        edgeGaps.push_back(0.0);
      }
      const int id = ids.Find(e.Current());
      const double gap = EdgeGap({ TopoDS::Edge(e.Current()), shape.Faces[f] });
      faceEdges[f].push_back(id);
      edgeGaps[std::size_t(id)] = std::max(edgeGaps[std::size_t(id)], gap);
      gaps[f].Own = std::max(gaps[f].Own, gap);
    }
  }
  for (std::size_t f = 0; f < shape.Faces.size(); ++f)
  {
    for (int id : faceEdges[f])
    {
      gaps[f].Neighbours = std::max(gaps[f].Neighbours, edgeGaps[std::size_t(id)]);
    }
  }
  return gaps;
}

std::string SurfaceKind(const TopoDS_Face& face)
{
  static const std::map<GeomAbs_SurfaceType, std::string> names{ { GeomAbs_Plane, "plane" },
    { GeomAbs_Cylinder, "cylinder" }, { GeomAbs_Cone, "cone" }, { GeomAbs_Sphere, "sphere" },
    { GeomAbs_Torus, "torus" }, { GeomAbs_BezierSurface, "Bezier" },
    { GeomAbs_BSplineSurface, "B-spline" }, { GeomAbs_SurfaceOfRevolution, "revolution" },
    { GeomAbs_SurfaceOfExtrusion, "extrusion" }, { GeomAbs_OffsetSurface, "offset" } };
  const auto found = names.find(BRepAdaptor_Surface(face, Standard_False).GetType());
  return found == names.end() ? "other" : found->second;
}

} // namespace verify
