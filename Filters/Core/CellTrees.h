// SPDX-License-Identifier: BSD-3-Clause
/// @file CellTrees.h
/// @brief The cells of patches, cut when a ray first comes near. Internal to PatchRays.
///
/// A tree a patch, of the pieces that PatchCutter cuts it into: its leaves are the cells that would be
/// made at once, so that rays find the same, whichever come first. For few rays most pieces are never
/// cut.
#pragma once

#include "BoxTree.h"
#include "PatchCutter.h"

#include <atomic>
#include <memory>
#include <mutex>

namespace nurbs
{

/// The trees of all patches. Rays may walk through them from many threads.
class CellTrees
{
public:
  /// Takes the patches of the model's faces, see PatchRays::Build; model and trims must outlive this.
  /// `size`: of the model, see PatchCutter; `rounding`: boxes are widened by four times that.
  CellTrees(const Model& model, const TrimIndex& trims, const std::vector<double>& reach,
    double size, double rounding, const ParallelFor& parallel);
  ~CellTrees();

  std::int64_t Count() const { return static_cast<std::int64_t>(this->Given.size()); }
  /// A patch as it was given, by its index.
  const BezierPatch& GivenPatch(std::int32_t patch) const { return this->Given[patch]; }
  std::int32_t FaceOf(std::int32_t patch) const { return this->Faces[patch]; }
  /// Of a patch's control points.
  const std::vector<Box3>& Boxes() const { return this->PatchBoxes; }

  /// The box of the control points of all cells, larger by up to 3e-7 of its size. Cuts what it needs.
  Box3 Bounds() const;

  /// Calls `visit(cell)` for the cells of a patch whose boxes the ray meets between tMin and tMax,
  /// which `visit` may make less, about from near to far.
  template <typename Visit>
  void Walk(
    std::int32_t patch, const BoxRay& ray, double tMin, double& tMax, const Visit& visit) const;

  /// Bytes of patches, boxes, cells and branches by now.
  std::size_t MemoryUse() const { return this->Bytes; }

private:
  /// A pointer whose lowest bits say to what: see Kind.
  using Child = std::uintptr_t;
  enum Kind : Child
  {
    Nothing = 0, ///< All is trimmed away.
    IsCell = 1,
    IsBranch = 2,
    IsPiece = 3 ///< A CutPiece to be halved; of a root, without a pointer: the patch, not judged.
  };
  /// A child and a box around what is left of it, which becomes smaller as more of it is made. Boxes are
  /// relative to Middle, in units of Unit, so that their precision is of the model's size, wherever it is.
  struct Slot
  {
    std::atomic<Child> Content{ Nothing };
    std::atomic<float> Bounds[2]
                             [3]; ///< Lower or upper; axis. Of nothing: the lower ones are higher.

    float Bound(int side, int axis) const
    {
      return this->Bounds[side][axis].load(std::memory_order_relaxed);
    }
    bool IsVoid() const { return this->Bound(0, 0) > this->Bound(1, 0); }
    void SetBounds(const Box3& relative);
    void SetVoid();
  };
  /// Fills a line of the cache.
  struct alignas(64) Branch
  {
    mutable Slot Halves[2];
  };
  /// What the patches of a face have in common.
  struct Owner
  {
    std::mutex Lock; ///< Held while a patch of it is cut.
    std::unique_ptr<CoverTest> Test;
  };

  template <typename T>
  static const T* As(Child child)
  {
    return reinterpret_cast<const T*>(child & ~Child(3));
  }
  /// The child, which is no piece.
  Child Made(std::int32_t patch, Slot& slot) const
  {
    const Child now = slot.Content.load(std::memory_order_acquire);
    return (now & 3) == IsPiece ? this->Make(patch, slot) : now;
  }
  Child Make(std::int32_t patch, Slot& slot) const;
  Child Judge(std::int32_t patch, CutPiece&& piece) const;
  double Extreme(int axis, int side) const;
  Box3 Relative(const Box3& box) const;
  static void Delete(Child child);
  static bool IsMet(const Slot& slot, const BoxRay& ray, double tMin, double tMax, double& entry);

  const Model& Source;
  const TrimIndex& Trims;
  std::vector<double> Reach;
  double Size;
  double Margin;
  Vec3 Middle = Vec3::Zero();      ///< Of all patches' boxes.
  double Unit = 1.0;               ///< The largest side of all of them together.
  std::vector<BezierPatch> Given;  ///< By face.
  std::vector<std::int32_t> Faces; ///< One a patch.
  std::vector<Box3> PatchBoxes;
  mutable std::vector<Owner> Owners; ///< One a face.
  mutable std::vector<Slot> Roots;   ///< One a patch.
  mutable std::atomic<std::size_t> Bytes{ 0 };
};

inline bool CellTrees::IsMet(
  const Slot& slot, const BoxRay& ray, double tMin, double tMax, double& entry)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int side = ray.Near[axis];
    const double a = (slot.Bound(side, axis) - ray.Origin[axis]) * ray.Inverse[axis];
    const double b = (slot.Bound(1 - side, axis) - ray.Origin[axis]) * ray.Inverse[axis];
    tMin = a > tMin ? a : tMin;
    tMax = b < tMax ? b : tMax;
  }
  entry = tMin;
  return tMin <= tMax;
}

template <typename Visit>
void CellTrees::Walk(
  std::int32_t patch, const BoxRay& ray, double tMin, double& tMax, const Visit& visit) const
{
  struct Waiting
  {
    Slot* At;
    double Entry;
  };
  BoxRay relative = ray;
  relative.Origin = (ray.Origin - this->Middle) / this->Unit;
  relative.Inverse = ray.Inverse * this->Unit;
  // One waits at each depth.
  Waiting stack[PatchCutter::MaxHalvings + 3];
  int size = 0;
  double start;
  if (IsMet(this->Roots[patch], relative, tMin, tMax, start))
  {
    stack[size++] = { &this->Roots[patch], start };
  }
  while (size > 0)
  {
    const Waiting next = stack[--size];
    if (next.Entry > tMax)
    {
      continue;
    }
    const Child child = this->Made(patch, *next.At);
    if ((child & 3) == IsCell)
    {
      visit(*As<PatchRays::Cell>(child));
    }
    else if ((child & 3) == IsBranch)
    {
      Slot* const halves = As<Branch>(child)->Halves;
      double entry[2];
      const bool met[2] = { IsMet(halves[0], relative, tMin, tMax, entry[0]),
        IsMet(halves[1], relative, tMin, tMax, entry[1]) };
      const int first = met[1] && (!met[0] || entry[1] < entry[0]) ? 1 : 0;
      for (const int k : { 1 - first, first })
      {
        if (met[k])
        {
          stack[size++] = { &halves[k], entry[k] };
        }
      }
      if (!met[first] && halves[0].IsVoid() && halves[1].IsVoid())
      {
        next.At->SetVoid();
      }
    }
  }
}

} // namespace nurbs
