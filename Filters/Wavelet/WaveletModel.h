// SPDX-License-Identifier: BSD-3-Clause
/// @file WaveletModel.h
/// @brief A trimmed model as pyramids of samples: evaluated once, meshed at any level of detail.
///
/// Source: D. Tan, G. Zhao, H. Lu, "GPU based evaluation and LOD rendering of NURBS surfaces",
/// Computer-Aided Design & Applications 9 (2012), section 4.3. Where and why we differ:
/// Documentation/Papers/tan-2012-wavelets.md.
#pragma once

#include "FaceMesher.h"
#include "WaveletEdge.h"

namespace nurbs
{

struct WaveletSelection;

/// Options of WaveletModel.
struct WaveletOptions
{
  Wavelet Kind = Wavelet::Interpolating;
  FinestGrid Finest;
  ParallelFor Parallel = SerialFor;
  std::function<bool(double)> Progress; ///< Called with 0..1 (any thread); false: abort.
};

/// Length of the diagonal of the box around points of all faces, within the boxes of their loops.
double SampledDiagonal(
  const Model& model, const std::vector<std::string>& faceErrors, const ParallelFor& parallel);

/// Meshes of all faces.
struct WaveletMeshes
{
  std::vector<WaveletMesh> Faces; ///< One a face of the model.
  double Threshold = 0.0;         ///< Of a budget: no coefficient above it was left out.
  bool WithinBudget = true;       ///< False: the coarsest mesh has more triangles.
  bool Aborted = false;
};

/// A model's pyramids. Edges have pyramids of their own; all faces that use an edge take its points
/// bit for bit, so that neighbours fit at every level, and at different ones. Results do not depend
/// on the number of threads.
class WaveletModel
{
public:
  /// Evaluates and analyses. Sides of faces without loops that coincide become one edge
  /// (CompleteModel).
  /// @param faceErrors one string a face: "" or why it can't be used (it comes out as Failed).
  /// The model's views must stay valid. Throws Error unless the finest tolerance is positive and
  /// finite.
  WaveletModel(
    const Model& model, const std::vector<std::string>& faceErrors, const WaveletOptions& options);

  /// Replaces what is called meanwhile; see WaveletOptions.
  void SetProgress(std::function<bool(double)> progress) { this->Options.Progress = progress; }
  /// True if Progress ended the work; there is nothing to mesh then.
  bool IsAborted() const { return this->Aborted; }
  /// Levels of the face or edge that has the most, at least 1. Level 0 is the finest.
  int Levels() const;
  /// Null: the face can't be used.
  const WaveletFace* GetFace(std::int64_t face) const { return this->Faces[face].get(); }
  /// Samples of all faces' finest grids.
  std::int64_t SampleCount() const;

  /// Every face and edge on this level, or on its coarsest if that is finer.
  WaveletMeshes Level(int level) const;
  /// One level a face; an edge is as fine as the finest of its faces..
  WaveletMeshes MixedLevels(const std::vector<int>& levels) const;
  /// As coarse as cells, segments (Interpolating) or whole faces (other wavelets) can be for errors
  /// up to `tolerance` > 0. Faces that can't be so exact are Capped.
  WaveletMeshes MaximumError(double tolerance) const;
  /// The smallest threshold for which the mesh that has all coefficients above it keeps within
  /// `triangles`; the coarsest mesh if none does.
  WaveletMeshes TriangleBudget(std::int64_t triangles) const;

private:
  void SelectEdges(WaveletSelection& out,
    const std::function<bool(const WaveletEdge&, int)>& coarseLevel,
    const std::function<bool(const WaveletEdge&, int, int)>& coarseSegment) const;
  WaveletSelection SelectLevels(const std::vector<int>& levels) const;
  WaveletSelection SelectError(double tolerance) const;
  WaveletSelection SelectThreshold(double threshold) const;
  std::int64_t EstimateTriangles(double threshold) const;
  double LargestThreshold() const;
  double ThresholdOfEstimate(double triangles, double low, double high) const;
  WaveletMeshes Mesh(WaveletSelection& selection, double limit) const;
  void ShareLines(WaveletSelection& selection) const;
  void Uncross(WaveletSelection& selection) const;
  std::vector<std::vector<LevelLoopVertex>> Loops(
    std::int64_t face, const WaveletSelection& selection) const;
  void AppendCurve(std::int64_t curve, std::int64_t face, const WaveletSelection& selection,
    std::vector<LevelLoopVertex>& loop) const;
  void AppendPole(std::int64_t curve, std::int64_t face, const WaveletSelection& selection,
    std::vector<LevelLoopVertex>& part) const;
  FaceMeshJob Job(std::int64_t face, const WaveletSelection& selection, double limit) const;

  WaveletOptions Options;
  CompletedModel Data;
  std::vector<std::string> Errors; ///< One a face.
  std::vector<std::unique_ptr<WaveletFace>> Faces;
  std::vector<std::unique_ptr<WaveletEdge>> Edges; ///< Null: not used.
  std::vector<int> UseOfCurve;                     ///< Index of a trim curve's use in its edge.
  bool Aborted = false;
};

} // namespace nurbs
