// SPDX-License-Identifier: BSD-3-Clause
/// @file RayCaster.h
/// @brief Where rays meet the exact trimmed surfaces of a model.
///
/// Surfaces are intersected as they are, without a mesh: PatchRays.h says how, BoxTree.h what finds
/// the patches, TrimIndex.h decides what is trimmed away.
///
/// Precision: hits lie on the surface to rounding, and on the ray to about 1e-13 of the model's
/// size (unless the ray grazes the surface: then to rounding across the ray, and to the square root
/// of that along it). No hit is lost between patches of a face. Between faces whose edges agree
/// within a tolerance only (Edge::Tolerance), a point that is outside of its face by up to twice
/// that counts where it lies beside two faces, or where else hits would not enter and leave by
/// turns: so no ray slips through, and none is stopped that passes.
#pragma once

#include "BoxTree.h"
#include "PatchRays.h"
#include "TrimIndex.h"

#include <limits>
#include <memory>

namespace nurbs
{

/// The points Origin + t Direction, Min <= t <= Max.
struct Ray
{
  Vec3 Origin = Vec3::Zero();
  Vec3 Direction = Vec3::UnitZ(); ///< Of any length over 0, in which t is measured.
  double Min = 0.0;
  double Max = std::numeric_limits<double>::infinity();
};

/// An intersection of a ray with a face.
struct RayHit
{
  std::int64_t Face = -1; ///< Index into Model::Faces.
  double U = 0.0;         ///< In the face's own parameters.
  double V = 0.0;
  double T = 0.0;
  Vec3 Point = Vec3::Zero();  ///< On the surface.
  Vec3 Normal = Vec3::Zero(); ///< Of unit length, towards the outside (see Face::Reversed).
  /// 1: from the outside to the inside; -1: the other way; 0: the ray touches the surface.
  int Crossing = 0;
};

/// Answers queries about one model. Constant once built, and safe to use from many threads.
class RayCaster
{
public:
  /// Builds the search structure, in time O(n log n) of the number of patches. The model must
  /// outlive the caster and not change; faces without a control net are left out. Throws what
  /// TrimIndex throws.
  explicit RayCaster(const Model& model, const ParallelFor& parallel = SerialFor);

  /// When surfaces are cut into what rays are tested against.
  enum class Cutting
  {
    AtOnce,
    /// Where rays come near, under locks: quicker if they are fewer than parts of the model, and look
    /// from one side. Their hits are the same.
    WhenMet
  };
  /// As above.
  RayCaster(const Model& model, Cutting cutting, const ParallelFor& parallel = SerialFor);

  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// The hit with the smallest t in the ray's range; of hits within 1e-9 of the model's size of each
  /// other, that on the first face. Returns false if there is none, and leaves `hit`. Throws Error if
  /// the direction is zero, or a number of the ray is NaN or an infinite vector.
  bool Nearest(const Ray& ray, RayHit& hit) const;

  /// True if there is a hit in the ray's range; the quickest question.
  bool IsBlocked(const Ray& ray) const;

  /// Replaces `hits` by all hits in the ray's range, by increasing t. A point where faces or a
  /// face's own borders meet gives one hit a direction of crossing (one hit in all if the ray goes
  /// through, two if it enters and leaves there), and so do surfaces that lie on each other within
  /// the edges' tolerance and face the same way. So hits through a closed model enter and leave by
  /// turns, save at a vertex that the ray meets exactly. A ray that runs within a surface along a
  /// curve has no hit with that face, but may have with its neighbours. Throws as Nearest does.
  void All(const Ray& ray, std::vector<RayHit>& hits) const;

  /// A box around what is left of the surfaces by trimming, a bit larger; empty if there is
  /// nothing.
  const Box3& Bounds() const { return this->Surfaces.Bounds(); }

  /// The tree over the parts of surfaces (cells, or with WhenMet patches), and the face of each: for
  /// searches by box.
  const BoxTree& GetTree() const { return this->Tree; }
  /// The face of a part.
  std::int64_t GetFace(std::int32_t part) const
  {
    return this->Forest ? this->Surfaces.FaceOf(part) : this->Surfaces.FaceOfCell(part);
  }

  /// The model given.
  const Model& GetModel() const { return *this->Source; }

  /// Trimming, as the queries see it.
  const TrimIndex& GetTrims() const { return this->Trims; }

  /// Bytes occupied, without those of the trim index.
  std::size_t MemoryUse() const;
  /// Parts of surfaces in the tree.
  std::int64_t PartCount() const
  {
    return this->Forest ? this->Surfaces.PatchCount() : this->Surfaces.CellCount();
  }

private:
  struct Cast;
  struct Candidate;
  enum class Place
  {
    Inside,
    Beside, ///< Outside of the face, but within its edges' tolerance.
    Outside
  };

  Place Locate(const PatchHit& hit) const;
  void Finish(const Cast& cast, const PatchHit& hit, RayHit& out) const;
  double Noise(const RayHit& a, const RayHit& b, const Vec3& direction) const;
  double Spread(const RayHit& a, const RayHit& b, const Vec3& direction) const;
  template <typename Found>
  void Walk(const Cast& cast, double& tMax, const Found& found) const;
  bool Gather(const Cast& cast, std::vector<Candidate>& found) const;
  void Merge(std::vector<Candidate>& found, const Vec3& direction) const;
  static void KeepNeeded(std::vector<Candidate>& found);

  const Model* Source;
  TrimIndex Trims;
  PatchRays Surfaces;
  std::shared_ptr<const CellTrees> Forest; ///< With WhenMet.
  BoxTree Tree;
  std::vector<double> Tolerance; ///< A face's largest of its edges.
  std::vector<double> Reach;     ///< How far outside a face a hit may count.
};

} // namespace nurbs
