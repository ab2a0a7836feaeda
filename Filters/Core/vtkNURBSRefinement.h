// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSRefinement
 * @brief Makes the control nets of a model denser without changing any surface.
 *
 * For filters that move control points: a surface follows them only as closely as its net is dense,
 * and a plane of 2 x 2 control points does not bend at all. Every face gets a degree of at least
 * MinimumDegree, and knots until no two neighbouring control points are farther apart than
 * MaximumSpacing. A deformation with second derivatives up to M then moves the surface where it
 * should be but for about M / 3 spacing^2 (bicubic, even knots; DenseNet.h has the derivation), and
 * two faces that share an edge part by less than twice that, whatever their nets are.
 *
 * Input: a model of vtkNURBSModel, or a composite data set of models; blocks that are no model are
 * passed on as they are. Output: the same type and structure. New are the points, the point data
 * RationalWeights (other point data has no meaning on the new points and is left out), the cells,
 * the cell data Degree, NetSize and KnotStart, and the field data Knots; every other array of cells
 * and field data is the input's own object: FaceId, attributes, loops, trim curves, edges. As
 * parameters stay the same numbers, trims keep their place exactly.
 *
 * Every refined face gets points of its own, also where the input's cells share points. Faces that
 * are dense enough already keep their nets, and share points with each other as before. A model
 * without a face to refine is passed on as it is. Faces with errors are passed on unchanged and
 * named in one warning, those that reach MaximumControlPoints in another.
 *
 * Work is spread over faces by vtkSMPTools; the result does not depend on the number of threads.
 * AbortExecute leaves the output empty.
 */
#ifndef vtkNURBSRefinement_h
#define vtkNURBSRefinement_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkNURBSFiltersCoreModule.h" // For export macro

#include <vector> // For the faces

class vtkNURBSPieces;

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSRefinement : public vtkDataObjectAlgorithm
{
public:
  static vtkNURBSRefinement* New();
  vtkTypeMacro(vtkNURBSRefinement, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The degree that every face shall have at least in u and v. Default 3, 1 to 25 (clamped). With 1
   * a face that is bent has creases at its new knots, with 2 it is smooth (C1), with 3 C2.
   */
  vtkSetClampMacro(MinimumDegree, int, 1, 25);
  vtkGetMacro(MinimumDegree, int);
  ///@}

  ///@{
  /**
   * The longest distance of neighbouring control points. Default 0.05; must be positive.
   */
  vtkSetMacro(MaximumSpacing, double);
  vtkGetMacro(MaximumSpacing, double);
  ///@}

  /// What SpacingMode may be.
  enum SpacingModes
  {
    RELATIVE = 0,
    ABSOLUTE = 1
  };

  ///@{
  /**
   * What MaximumSpacing is measured in: the diagonal of the box around points of all surfaces of
   * the input (RELATIVE, default), or units of length (ABSOLUTE).
   */
  vtkSetClampMacro(SpacingMode, int, RELATIVE, ABSOLUTE);
  vtkGetMacro(SpacingMode, int);
  void SetSpacingModeToRelative() { this->SetSpacingMode(RELATIVE); }
  void SetSpacingModeToAbsolute() { this->SetSpacingMode(ABSOLUTE); }
  ///@}

  ///@{
  /**
   * The most control points that a face gets; its spacing is wider where they do not suffice. A
   * face that has more already, or would by its degree alone, stays as it is. Default 10,000, at
   * least 4.
   */
  vtkSetClampMacro(MaximumControlPoints, vtkIdType, 4, VTK_INT_MAX);
  vtkGetMacro(MaximumControlPoints, vtkIdType);
  ///@}

  ///@{
  /**
   * Cut the surface to the part of its domain that the trims reach, where that leaves the trims as
   * valid as they were: planes of CAD files can be far larger than their faces. Default on.
   */
  vtkSetMacro(ClampToTrims, bool);
  vtkGetMacro(ClampToTrims, bool);
  vtkBooleanMacro(ClampToTrims, bool);
  ///@}

  ///@{
  /**
   * Of the last update: faces with another net than before, faces that MaximumControlPoints kept
   * from MaximumSpacing or MinimumDegree, and control points of all faces of the output.
   */
  vtkGetMacro(NumberOfRefinedFaces, vtkIdType);
  vtkGetMacro(NumberOfCappedFaces, vtkIdType);
  vtkGetMacro(NumberOfControlPoints, vtkIdType);
  ///@}

protected:
  vtkNURBSRefinement();
  ~vtkNURBSRefinement() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSRefinement(const vtkNURBSRefinement&) = delete;
  void operator=(const vtkNURBSRefinement&) = delete;

  struct Part;
  double AbsoluteSpacing(const std::vector<Part>& parts, const vtkNURBSPieces& pieces) const;
  bool Refine(std::vector<Part>& parts, double spacing);
  void Summarize(const std::vector<Part>& parts, const vtkNURBSPieces& pieces);
  bool Make(vtkDataObject* input, const vtkNURBSPieces& pieces, vtkDataObject* output);

  int MinimumDegree = 3;
  double MaximumSpacing = 0.05;
  int SpacingMode = RELATIVE;
  vtkIdType MaximumControlPoints = 10000;
  bool ClampToTrims = true;

  vtkIdType NumberOfRefinedFaces = 0;
  vtkIdType NumberOfCappedFaces = 0;
  vtkIdType NumberOfControlPoints = 0;
};

#endif
