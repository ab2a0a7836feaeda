// SPDX-License-Identifier: BSD-3-Clause
#include "DeformingEdge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{

constexpr double SameParameter = 1e-9;        // Of the domain: one vertex.
constexpr double OnSide = 1e-9;               // Of the box: a curve along a side.
constexpr double OnCrease = 1e-7;             // Likewise, a vertex on a crease.
constexpr double Straight = 1e-12;            // Of the box: no bend.
constexpr int ClosedPieces = 4;               // That a closed edge has at least.
constexpr double ShortestPiece = 1.0 / 65536; // Of the domain.
constexpr int CreaseSamples = 64;
constexpr double Bent = 1e-4; // Of its extent: a piece that is worth straightening.
constexpr double ForcedShare =
  0.25;                           // Of the error that a piece was halved at for a face: to merge.
constexpr double OnePoint = 1e-9; // Of the control net: a pole.

} // namespace

DeformingEdge::DeformingEdge(
  const Model& model, std::int64_t index, std::vector<DeformingUse> uses, const Faces& faces)
  : Where(std::move(uses))
{
  const Edge& edge = model.Edges[index];
  this->Pole = IsDegenerate(edge);
  this->PoleVertex = edge.Vertex[0];
  this->Domain = model.TrimCurves[this->Where.front().Curve].Geometry.Domain();
  for (std::size_t u = 0; u < this->Where.size(); ++u)
  {
    DeformingUse& use = this->Where[u];
    const ParameterBox& box = faces[use.Face]->Used();
    const CurveView<2>& c = model.TrimCurves[use.Curve].Geometry;
    const double side[4] = { box.V0, box.U1, box.V1, box.U0 };
    const double near[2] = { OnSide * box.A(), OnSide * box.B() };
    for (int s = 0; s < 4 && use.Side < 0; ++s)
    {
      const int d = s % 2;
      bool on = true;
      const double forward = c.Point(c.Count - 1)[d] - c.Point(0)[d];
      for (int k = 0; k < c.Count && on; ++k)
      {
        const bool turns = k > 0 && forward * (c.Point(k)[d] - c.Point(k - 1)[d]) < 0.0;
        on = std::abs(c.Point(k)[1 - d] - side[s]) <= near[1 - d] && !turns;
      }
      use.Side = on && std::abs(forward) > near[d] ? s : -1;
    }
    if (use.Side < 0)
    {
      this->Inner.push_back(u);
    }
  }
  if (this->Pole)
  {
    this->Inner.clear();
    for (const DeformingUse& use : this->Where)
    {
      this->WasPoint.push_back(use.Side >= 0 && this->IsPoint(model, use));
    }
  }
  if (this->Inner.empty())
  {
    return;
  }
  std::vector<double> breaks = { this->Domain.Min, this->Domain.Max };
  this->AddCreases(model, faces, breaks);
  const bool closed = edge.Vertex[0] == edge.Vertex[1];
  const Piece whole = this->MakePiece(model, this->Domain.Min, this->Domain.Max);
  bool bent = false;
  for (std::size_t k = 0; k < this->Inner.size(); ++k)
  {
    const ParameterBox& box = faces[this->Where[this->Inner[k]].Face]->Used();
    const Vec2& bend = whole.Uses[k].Bend;
    bent = bent || bend[0] > Straight * box.A() || bend[1] > Straight * box.B();
  }
  const int least = closed ? ClosedPieces : bent ? 2 : 1;
  for (int k = 1; k < least; ++k)
  {
    breaks.push_back(this->Domain.Min + this->Domain.Length() * k / least);
  }
  std::sort(breaks.begin(), breaks.end());
  for (std::size_t k = 1; k < breaks.size(); ++k)
  {
    const double start = this->Pieces.empty() ? breaks[0] : this->Pieces.back().T1;
    if (breaks[k] - start > 1e-6 * this->Domain.Length())
    {
      this->Pieces.push_back(this->MakePiece(model, start, breaks[k]));
    }
  }
  this->Roots = this->Pieces.size();
}

// Whether the side of the surface that a use runs along is one point.
bool DeformingEdge::IsPoint(const Model& model, const DeformingUse& use) const
{
  const SurfaceView& surface = model.Faces[use.Face].Geometry;
  Box3 box;
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    box.extend(surface.Point(k));
  }
  return IsDegenerateSide(
    surface, 1 - use.Side % 2, use.Side == 1 || use.Side == 2, OnePoint * box.diagonal().norm());
}

bool DeformingEdge::HasOpened(const Model& model) const
{
  for (std::size_t u = 0; u < this->Where.size(); ++u)
  {
    if (this->WasPoint[u] && !this->IsPoint(model, this->Where[u]))
    {
      return true;
    }
  }
  return false;
}

void DeformingEdge::RemoveVertices(const Faces& faces)
{
  for (const DeformingUse& use : this->Where)
  {
    for (std::size_t k = 1; k + 1 < use.Vertices.size(); ++k)
    {
      faces[use.Face]->RemoveLoopVertex(use.Vertices[k]);
    }
  }
}

// Parameters of a use at a parameter of the edge; on sides and creases exactly.
Vec2 DeformingEdge::Parameters(
  const Model& model, const Faces& faces, std::size_t u, double t) const
{
  const DeformingUse& use = this->Where[u];
  const TrimCurve& curve = model.TrimCurves[use.Curve];
  const DeformingFace& face = *faces[use.Face];
  Vec2 uv = Evaluate(curve.Geometry, TrimParameter(curve, this->Domain, t));
  const ParameterBox& box = face.Used();
  const double low[2] = { box.U0, box.V0 };
  const double high[2] = { box.U1, box.V1 };
  for (int d = 0; d < 2; ++d)
  {
    uv[d] = std::clamp(uv[d], low[d], high[d]);
    const double near = OnCrease * (high[d] - low[d]);
    for (const double crease : face.Creases(d))
    {
      uv[d] = std::abs(uv[d] - crease) <= near ? crease : uv[d];
    }
  }
  if (use.Side >= 0)
  {
    uv[1 - use.Side % 2] = use.Side == 0 ? box.V0
      : use.Side == 1                    ? box.U1
      : use.Side == 2                    ? box.V1
                                         : box.U0;
  }
  return uv;
}

// The edge's parameter where a use that runs one way has a coordinate.
double DeformingEdge::ParameterOn(const Model& model, std::size_t u, int d, double value) const
{
  const TrimCurve& curve = model.TrimCurves[this->Where[u].Curve];
  const CurveView<2>& c = curve.Geometry;
  if (c.Degree == 1 && c.Count == 2 && c.Weight(0) == c.Weight(1))
  {
    const double part = (value - c.Point(0)[d]) / (c.Point(1)[d] - c.Point(0)[d]);
    return this->Domain.Min + part * this->Domain.Length();
  }
  double low = this->Domain.Min;
  double high = this->Domain.Max;
  const bool rising = c.Point(c.Count - 1)[d] > c.Point(0)[d];
  for (int k = 0; k < 60; ++k)
  {
    const double t = 0.5 * (low + high);
    const double at = Evaluate(c, TrimParameter(curve, this->Domain, t))[d];
    ((at < value) == rising ? low : high) = t;
  }
  return 0.5 * (low + high);
}

// Corners of inner uses, and where they cross creases of their faces: no piece may go over one.
void DeformingEdge::AddCreases(
  const Model& model, const Faces& faces, std::vector<double>& breaks) const
{
  for (const std::size_t u : this->Inner)
  {
    const TrimCurve& curve = model.TrimCurves[this->Where[u].Curve];
    const Interval own = curve.Geometry.Domain();
    for (const double corner : CreaseKnots(curve.Geometry.Knots, curve.Geometry.Degree))
    {
      breaks.push_back(
        this->Domain.Min + (corner - own.Min) / own.Length() * this->Domain.Length());
    }
    const auto at = [&](double t, int d) {
      return Evaluate(curve.Geometry, TrimParameter(curve, this->Domain, t))[d];
    };
    for (int d = 0; d < 2; ++d)
    {
      for (const double crease : faces[this->Where[u].Face]->Creases(d))
      {
        for (int k = 0; k < CreaseSamples; ++k)
        {
          double low = this->Domain.Min + this->Domain.Length() * k / CreaseSamples;
          double high = this->Domain.Min + this->Domain.Length() * (k + 1) / CreaseSamples;
          const bool below = at(low, d) < crease;
          if (below == (at(high, d) < crease))
          {
            continue;
          }
          for (int step = 0; step < 50; ++step)
          {
            const double middle = 0.5 * (low + high);
            (below == (at(middle, d) < crease) ? low : high) = middle;
          }
          breaks.push_back(0.5 * (low + high));
        }
      }
    }
  }
}

DeformingEdge::Piece DeformingEdge::MakePiece(const Model& model, double t0, double t1) const
{
  Piece piece;
  piece.T0 = t0;
  piece.T1 = t1;
  for (const std::size_t u : this->Inner)
  {
    const TrimCurve& curve = model.TrimCurves[this->Where[u].Curve];
    const Curve<2> part = Restrict(curve.Geometry, TrimParameter(curve, this->Domain, t0),
      TrimParameter(curve, this->Domain, t1));
    const Vec2& a = part.Points.front();
    const Vec2 chord = part.Points.back() - a;
    PieceUse use;
    use.Extent = chord.cwiseAbs();
    use.Bend = Vec2::Zero();
    Box2 box;
    for (const Vec2& p : part.Points)
    {
      const double s = chord.squaredNorm() > 0.0
        ? std::clamp((p - a).dot(chord) / chord.squaredNorm(), 0.0, 1.0)
        : 0.0;
      use.Bend = use.Bend.cwiseMax((p - a - s * chord).cwiseAbs());
      box.extend(p);
    }
    use.Box = { box.min()[0], box.max()[0], box.min()[1], box.max()[1] };
    piece.Uses.push_back(use);
  }
  return piece;
}

void DeformingEdge::Split(const Model& model, std::int32_t index)
{
  const double t0 = this->Pieces[index].T0;
  const double t1 = this->Pieces[index].T1;
  const double middle = 0.5 * (t0 + t1);
  std::int32_t child = std::int32_t(this->Pieces.size());
  if (this->FreePairs.empty())
  {
    this->Pieces.resize(this->Pieces.size() + 2);
  }
  else
  {
    child = this->FreePairs.back();
    this->FreePairs.pop_back();
  }
  this->Pieces[index].Child = child;
  this->Pieces[child] = this->MakePiece(model, t0, middle);
  this->Pieces[child + 1] = this->MakePiece(model, middle, t1);
  this->PiecesChanged = true;
}

bool DeformingEdge::CanSplit(std::int32_t index) const
{
  const Piece& piece = this->Pieces[index];
  return piece.Child < 0 && !piece.Free &&
    piece.T1 - piece.T0 > ShortestPiece * this->Domain.Length();
}

bool DeformingEdge::Force(const Model& model, const Faces& faces, std::int32_t index)
{
  if (!this->CanSplit(index))
  {
    return false;
  }
  double error = 0.0;
  this->Errs(faces, this->Pieces[index], 0.0, true, error);
  this->Pieces[index].ForcedAt = std::max(error, std::numeric_limits<double>::min());
  this->Split(model, index);
  return true;
}

bool DeformingEdge::Straighten(const Model& model, std::int32_t index)
{
  const auto bent = [](const PieceUse& use) {
    return use.Bend.maxCoeff() > Bent * use.Extent.maxCoeff();
  };
  const std::vector<PieceUse>& uses = this->Pieces[index].Uses;
  if (!this->CanSplit(index) || std::none_of(uses.begin(), uses.end(), bent))
  {
    return false;
  }
  this->Pieces[index].ForGood = true;
  this->Split(model, index);
  return true;
}

// The largest error of a piece over its uses, if it may be above (not above) the limit; what is known
// of it is used as far as it goes. See PatchErrors.h.
bool DeformingEdge::Errs(
  const Faces& faces, Piece& piece, double limit, bool above, double& error) const
{
  error = 0.0;
  bool largest = false;
  for (std::size_t k = 0; k < this->Inner.size(); ++k)
  {
    PieceUse& use = piece.Uses[k];
    DeformingFace& face = *faces[this->Where[this->Inner[k]].Face];
    const double moved =
      face.MovedSecond().Bow(use.Extent[0], use.Extent[1]) + face.MovedFirst().dot(use.Bend);
    const bool known = use.Resets == face.Resets();
    if (!known || (above ? use.Up + moved > limit : use.Low - moved <= limit))
    {
      const double exact =
        face.Second(use.Box).Bow(use.Extent[0], use.Extent[1]) + face.First(use.Box).dot(use.Bend);
      use.Up = exact - moved;
      use.Low = exact + moved;
      use.Resets = face.Resets();
    }
    error = std::max(error, above ? use.Up + moved : use.Low - moved);
    largest = largest || (above ? use.Up + moved : use.Low - moved) > limit;
  }
  return largest;
}

void DeformingEdge::AdaptPiece(
  const Model& model, const Faces& faces, std::int32_t index, double tolerance, double hysteresis)
{
  double error = 0.0;
  const std::int32_t child = this->Pieces[index].Child;
  if (child < 0)
  {
    const bool large =
      this->Pieces[index].T1 - this->Pieces[index].T0 > ShortestPiece * this->Domain.Length();
    if (this->Errs(faces, this->Pieces[index], tolerance, true, error) && large)
    {
      this->Split(model, index);
      this->AdaptPiece(model, faces, this->Pieces[index].Child, tolerance, hysteresis);
      this->AdaptPiece(model, faces, this->Pieces[index].Child + 1, tolerance, hysteresis);
      return;
    }
    this->LargestError = std::max(this->LargestError, error);
    return;
  }
  this->AdaptPiece(model, faces, child, tolerance, hysteresis);
  this->AdaptPiece(model, faces, child + 1, tolerance, hysteresis);
  if (this->Pieces[child].Child >= 0 || this->Pieces[child + 1].Child >= 0 ||
    this->Pieces[index].ForGood)
  {
    return;
  }
  Piece& piece = this->Pieces[index];
  const double limit = piece.ForcedAt > 0.0
    ? std::min(hysteresis * tolerance, ForcedShare * piece.ForcedAt)
    : hysteresis * tolerance;
  if (!this->Errs(faces, piece, limit, false, error))
  {
    piece.Child = -1;
    piece.ForcedAt = 0.0;
    this->LargestError = std::max(this->LargestError, error);
    this->Pieces[child].Free = this->Pieces[child + 1].Free = true;
    this->FreePairs.push_back(child);
    this->PiecesChanged = true;
  }
}

void DeformingEdge::Adapt(
  const Model& model, const Faces& faces, double tolerance, double hysteresis)
{
  this->LargestError = 0.0;
  for (std::size_t k = 0; k < this->Roots; ++k)
  {
    this->AdaptPiece(model, faces, std::int32_t(k), tolerance, hysteresis);
  }
}

// What the cells along the sides ask for.
void DeformingEdge::AddLines(const Model& model, const Faces& faces, std::vector<Mark>& marks) const
{
  std::vector<std::uint32_t> lines;
  for (std::size_t u = 0; u < this->Where.size(); ++u)
  {
    const DeformingUse& use = this->Where[u];
    if (use.Side < 0)
    {
      continue;
    }
    const DeformingFace& face = *faces[use.Face];
    const int d = use.Side % 2;
    const GridAxis& axis = face.Grid().Axis[d];
    double ends[2];
    for (int end = 0; end < 2; ++end)
    {
      ends[end] = this->Parameters(model, faces, u, end ? this->Domain.Max : this->Domain.Min)[d];
    }
    const double low = std::min(ends[0], ends[1]);
    const double high = std::max(ends[0], ends[1]);
    const double near = SameParameter * (high - low);
    face.SideLines(use.Side, lines);
    for (const std::uint32_t line : lines)
    {
      const double value = axis.Parameter(line);
      if (value < low - near || value > high + near)
      {
        continue;
      }
      const double t = value <= low + near
        ? (ends[0] < ends[1] ? this->Domain.Min : this->Domain.Max)
        : value >= high - near ? (ends[0] < ends[1] ? this->Domain.Max : this->Domain.Min)
                               : this->ParameterOn(model, u, d, value);
      marks.push_back({ t, std::int32_t(u), line });
    }
  }
}

void DeformingEdge::AddPieces(std::int32_t index, std::vector<Mark>& marks) const
{
  const Piece& piece = this->Pieces[index];
  if (piece.Child >= 0)
  {
    this->AddPieces(piece.Child, marks);
    this->AddPieces(piece.Child + 1, marks);
    return;
  }
  marks.push_back({ piece.T0, -1, index });
}

bool DeformingEdge::Update(const Model& model, const Faces& faces)
{
  std::vector<Mark> marks = { { this->Domain.Min, -1, -1 }, { this->Domain.Max, -1, -1 } };
  for (std::size_t k = 0; k < this->Roots; ++k)
  {
    this->AddPieces(std::int32_t(k), marks);
  }
  this->AddLines(model, faces, marks);
  std::stable_sort(
    marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.T < b.T; });
  const double near = SameParameter * this->Domain.Length();
  std::vector<double> t;
  std::vector<std::vector<std::int64_t>> lines;
  this->PieceOf.clear();
  for (const Mark& mark : marks)
  {
    if (t.empty() || mark.T > t.back() + near)
    {
      t.push_back(mark.T);
      lines.emplace_back(this->Where.size(), -1);
      this->PieceOf.push_back(this->PieceOf.empty() ? -1 : this->PieceOf.back());
    }
    if (mark.Use >= 0)
    {
      lines.back()[mark.Use] = mark.Line;
    }
    else if (mark.Line >= 0)
    {
      this->PieceOf.back() = std::int32_t(mark.Line);
    }
  }
  t.front() = this->Domain.Min;
  t.back() = this->Domain.Max;
  this->PiecesChanged = false;
  if (t == this->T && lines == this->LinesAt)
  {
    return false;
  }
  this->SetVertices(model, faces, t, lines);
  return true;
}

// Vertices that stay keep their places in the mesh.
void DeformingEdge::SetVertices(const Model& model, const Faces& faces,
  const std::vector<double>& t, const std::vector<std::vector<std::int64_t>>& lines)
{
  const double near = 0.5 * SameParameter * this->Domain.Length();
  const std::size_t count = t.size();
  for (std::size_t u = 0; u < this->Where.size(); ++u)
  {
    DeformingUse& use = this->Where[u];
    DeformingFace& face = *faces[use.Face];
    std::vector<std::int32_t> vertices(count, -1);
    std::size_t old = 0;
    std::vector<char> kept(this->T.size(), 0);
    for (std::size_t k = 1; k + 1 < count; ++k)
    {
      while (old < this->T.size() && this->T[old] < t[k] - near)
      {
        ++old;
      }
      const bool known = old > 0 && old + 1 < this->T.size() && this->T[old] <= t[k] + near;
      if (known)
      {
        vertices[k] = use.Vertices[old];
        kept[old] = 1;
        continue;
      }
      Vec2 uv = this->Parameters(model, faces, u, t[k]);
      if (lines[k][u] >= 0)
      {
        const int d = use.Side % 2;
        uv[d] = face.Grid().Axis[d].Parameter(std::uint32_t(lines[k][u]));
      }
      vertices[k] = face.AddLoopVertex(uv, this->Pole ? this->PoleVertex : -1);
    }
    for (std::size_t k = 1; k + 1 < this->T.size(); ++k)
    {
      if (!kept[k])
      {
        face.RemoveLoopVertex(use.Vertices[k]);
      }
    }
    vertices.front() = use.Ends[0];
    vertices.back() = use.Ends[1];
    for (std::size_t k = 0; k < count && use.Side >= 0; ++k)
    {
      face.SetLine(vertices[k], use.Side, lines[k][u]);
    }
    use.Vertices.swap(vertices);
  }
  this->T = t;
  this->LinesAt = lines;
}

} // namespace nurbs
