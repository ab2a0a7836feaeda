// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSCADWriter
 * @brief Writes trimmed NURBS models as STEP, IGES or BREP files.
 *
 * The input is a surface model (vtkNURBSModel) or a composite data set of such: what the reader and
 * the sources give, visible regions, deformed and edited models. Every face is written as the
 * rational B-spline surface that it is, or, with AnalyticSurfaces, as the plane, cylinder, cone, sphere
 * or torus that this is, with its trimming loops. Faces that share edges in the model
 * share them in the file and become shells, and closed shells become solids, with cavities where
 * they have some (a closed shell that is turned inwards and lies in no solid stays a shell). Faces
 * without loops are written with their natural boundary, and share the sides that coincide.
 *
 * An edge has the model's 3D curve where there is one that fits, and else one that is computed from
 * a trim curve on its surface: exactly along u or v and on planes, otherwise within CurveTolerance.
 * Its tolerance is measured: the largest distance of its faces' own trim curves from it. Where faces
 * have been moved farther apart than Gap (and than the edge's tolerance), the edge is torn: each
 * face keeps its own, and they are told in a warning.
 *
 * | | STEP (AP214) | IGES | BREP |
 * |---|---|---|---|
 * | geometry, shared edges, solids | yes | yes | yes |
 * | unit: the field data LengthUnit (mm if missing) | yes | yes | always mm |
 * | colours: `Color` of each face | yes | yes | no |
 * | names: of blocks, and `Name` of each face | UTF-8 | of blocks, ASCII | no |
 * | tree: vtkDataAssembly with "label" and "instance" as in vtkNURBSCADReader | yes | no | no |
 * | trim curves in (u, v) | yes | no | yes |
 *
 * Blocks of one name that are the same part, moved (equal but for round-off, names and colours of faces
 * as well), become instances of one part in STEP and BREP.
 *
 * Not written: other arrays of faces, and FaceId (it counts faces in the order of the file again).
 *
 * A face that can't be written is named in a warning and left out. With Check, OpenCASCADE's
 * BRepCheck_Analyzer looks at each shape, and what it finds is told in a warning; the file is written
 * all the same. Errors set the error code and leave no new file: no file name, an ending that names no
 * format (without Format), no face that can be written, a unit that is not known, options out of
 * range, a file that can't be written.
 *
 * Reports progress and obeys AbortExecute, which leaves no file.
 *
 * @sa vtkNURBSCADReader vtkNURBSModel
 */
#ifndef vtkNURBSCADWriter_h
#define vtkNURBSCADWriter_h

#include "vtkNURBSFiltersSourcesModule.h" // For export macro
#include "vtkWriter.h"

#include <string> // For std::string

class VTKNURBSFILTERSSOURCES_EXPORT vtkNURBSCADWriter : public vtkWriter
{
public:
  static vtkNURBSCADWriter* New();
  vtkTypeMacro(vtkNURBSCADWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write. No default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /// What Format may be.
  enum Formats
  {
    BY_ENDING = 0,
    STEP = 1,
    IGES = 2,
    BREP = 3
  };

  ///@{
  /**
   * What kind of file: as FileName ends (.step .stp .iges .igs .brep .brp, default), or told.
   */
  vtkSetClampMacro(Format, int, BY_ENDING, BREP);
  vtkGetMacro(Format, int);
  void SetFormatToByEnding() { this->SetFormat(BY_ENDING); }
  void SetFormatToSTEP() { this->SetFormat(STEP); }
  void SetFormatToIGES() { this->SetFormat(IGES); }
  void SetFormatToBREP() { this->SetFormat(BREP); }
  ///@}

  ///@{
  /**
   * What computed edge curves may deviate from their trim curve on its surface, as a part of the
   * model's diagonal. Default 1e-7; must be positive. Where a curve can't be brought that close, the
   * edge's tolerance in the file says how close it is.
   */
  vtkSetMacro(CurveTolerance, double);
  vtkGetMacro(CurveTolerance, double);
  ///@}

  ///@{
  /**
   * How far apart faces may be that share an edge, as a part of the model's diagonal. Edges whose
   * stated tolerance is larger may be as far apart as that. Default 1e-4; must not be negative.
   */
  vtkSetMacro(Gap, double);
  vtkGetMacro(Gap, double);
  ///@}

  ///@{
  /**
   * Whether surfaces that are planes, cylinders, cones, spheres or tori, and edges that are lines or
   * circles, but for round-off (1e-12 of the largest coordinate), are written as such. Their (u, v) are
   * others then. Off: all are B-splines. Default: on.
   */
  vtkSetMacro(AnalyticSurfaces, bool);
  vtkGetMacro(AnalyticSurfaces, bool);
  vtkBooleanMacro(AnalyticSurfaces, bool);
  ///@}

  ///@{
  /**
   * Whether OpenCASCADE checks the shapes. Default: on.
   */
  vtkSetMacro(Check, bool);
  vtkGetMacro(Check, bool);
  vtkBooleanMacro(Check, bool);
  ///@}

  ///@{
  /**
   * Of the last file: faces written; cells that were split into several, that were written as analytic
   * surfaces, and that were left out; blocks that are
   * instances of the part of another one; solids,
   * shells that are no part of one, edges (without poles), of them those that faces share, those whose curve was computed, and edges of
   * the model that were torn; faces that BRepCheck_Analyzer found fault with; the largest tolerance
   * of an edge, in the model's unit. 0 before the first one and after an error.
   */
  vtkGetMacro(NumberOfFaces, vtkIdType);
  vtkGetMacro(NumberOfSplitFaces, vtkIdType);
  vtkGetMacro(NumberOfAnalyticFaces, vtkIdType);
  vtkGetMacro(NumberOfFailedFaces, vtkIdType);
  vtkGetMacro(NumberOfInstances, vtkIdType);
  vtkGetMacro(NumberOfSolids, vtkIdType);
  vtkGetMacro(NumberOfShells, vtkIdType);
  vtkGetMacro(NumberOfEdges, vtkIdType);
  vtkGetMacro(NumberOfSharedEdges, vtkIdType);
  vtkGetMacro(NumberOfComputedEdges, vtkIdType);
  vtkGetMacro(NumberOfTornEdges, vtkIdType);
  vtkGetMacro(NumberOfInvalidFaces, vtkIdType);
  vtkGetMacro(EdgeTolerance, double);
  ///@}

protected:
  vtkNURBSCADWriter();
  ~vtkNURBSCADWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkNURBSCADWriter(const vtkNURBSCADWriter&) = delete;
  void operator=(const vtkNURBSCADWriter&) = delete;

  struct Work;
  bool Fail(unsigned long code, const std::string& message);
  bool CheckOptions(Work& work);
  bool FindUnits(Work& work);
  bool Build(Work& work);
  void CheckShapes(const Work& work);
  bool Save(Work& work);
  bool Aborted();
  void ClearFigures();

  char* FileName = nullptr;
  int Format = BY_ENDING;
  double CurveTolerance = 1e-7;
  double Gap = 1e-4;
  bool AnalyticSurfaces = true;
  bool Check = true;

  vtkIdType NumberOfFaces = 0;
  vtkIdType NumberOfSplitFaces = 0;
  vtkIdType NumberOfAnalyticFaces = 0;
  vtkIdType NumberOfFailedFaces = 0;
  vtkIdType NumberOfInstances = 0;
  vtkIdType NumberOfSolids = 0;
  vtkIdType NumberOfShells = 0;
  vtkIdType NumberOfEdges = 0;
  vtkIdType NumberOfSharedEdges = 0;
  vtkIdType NumberOfComputedEdges = 0;
  vtkIdType NumberOfTornEdges = 0;
  vtkIdType NumberOfInvalidFaces = 0;
  double EdgeTolerance = 0.0;
};

#endif
