// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSCADReader
 * @brief Reads STEP, IGES and BREP files as exact trimmed NURBS models.
 *
 * Every face is converted to an exact rational B-spline surface with its trim curves; edges that
 * faces share stay shared (see vtkNURBSModel for the arrays). OpenCASCADE parses the file.
 *
 * The output is a vtkPartitionedDataSetCollection. Each instance of a part (a product of a STEP
 * file that is no assembly itself) is one model, that is one vtkPartitionedDataSet with one
 * vtkUnstructuredGrid, placed as in the file; the vtkDataAssembly holds the assembly tree, with the
 * attributes "label" (product name, UTF-8) and "instance" (name of the use in its assembly) on its
 * nodes. IGES and BREP files become one model. With SingleModel all becomes one model.
 *
 * Beside the arrays of vtkNURBSModel, cells have `ConversionError`: the measured distance of the
 * converted surface from OpenCASCADE's (rounding, but for offset surfaces, which have no exact form).
 * `FaceId` counts the faces in the order of OpenCASCADE's TopExp_Explorer over the file's root
 * shape, each instance counted. `Color` is there if the file has any colour.
 *
 * A file that can't be read gives one error, an ErrorCode that is not 0 and an empty output. A face that can't be converted is
 * named in a warning and in the field data `UnconvertedFaces`; the others are kept.
 *
 * Asked for a piece, every process reads the file and keeps its share of the faces, which are dealt in
 * order over all models by their estimated cost (nurbs::DealFaces). The output has the same models and
 * the same assembly everywhere, with an empty partition where a process has no face of a model; FaceId
 * does not depend on pieces, and a piece has EdgeGlobalId and VertexGlobalId (see vtkNURBSModel).
 *
 * Reports progress and obeys AbortExecute.
 *
 * @sa vtkNURBSModel
 */
#ifndef vtkNURBSCADReader_h
#define vtkNURBSCADReader_h

#include "vtkNURBSFiltersSourcesModule.h" // For export macro
#include "vtkPartitionedDataSetCollectionAlgorithm.h"

class VTKNURBSFILTERSSOURCES_EXPORT vtkNURBSCADReader
  : public vtkPartitionedDataSetCollectionAlgorithm
{
public:
  static vtkNURBSCADReader* New();
  vtkTypeMacro(vtkNURBSCADReader, vtkPartitionedDataSetCollectionAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Path of the file. Its format is told by its content, not by its extension. No default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /// What LengthUnit may be.
  enum LengthUnits
  {
    MILLIMETRES = 0,
    METRES = 1,
    FILE_UNIT = 2
  };

  ///@{
  /**
   * Unit of the output's points, told in its field data `LengthUnit`: millimetres (default),
   * metres, or the unit that the file is written in. BREP files know no unit and are taken as
   * millimetres.
   */
  vtkSetClampMacro(LengthUnit, int, MILLIMETRES, FILE_UNIT);
  vtkGetMacro(LengthUnit, int);
  void SetLengthUnitToMillimetres() { this->SetLengthUnit(MILLIMETRES); }
  void SetLengthUnitToMetres() { this->SetLengthUnit(METRES); }
  void SetLengthUnitToFileUnit() { this->SetLengthUnit(FILE_UNIT); }
  ///@}

  ///@{
  /**
   * Put all instances into one model instead of one model each. Default: off. The assembly then has
   * the file as its only node; the face attributes stay.
   */
  vtkSetMacro(SingleModel, bool);
  vtkGetMacro(SingleModel, bool);
  vtkBooleanMacro(SingleModel, bool);
  ///@}

  /**
   * 1 if the content of the file looks like STEP, IGES or BREP and is not cut short, else 0.
   */
  static int CanReadFile(const char* fileName);

  ///@{
  /**
   * Of the last execution: seconds that OpenCASCADE took to parse the file and make its shapes, and
   * that the conversion of these took.
   */
  vtkGetMacro(ParseSeconds, double);
  vtkGetMacro(ConvertSeconds, double);
  ///@}

protected:
  vtkNURBSCADReader();
  ~vtkNURBSCADReader() override;

  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  char* FileName = nullptr;
  int LengthUnit = MILLIMETRES;
  bool SingleModel = false;
  double ParseSeconds = 0.0;
  double ConvertSeconds = 0.0;

private:
  vtkNURBSCADReader(const vtkNURBSCADReader&) = delete;
  void operator=(const vtkNURBSCADReader&) = delete;

  struct Work;
  bool Load(Work& work);
  void MakeModels(Work& work);
  void FillOutput(Work& work, vtkPartitionedDataSetCollection* output);
};

#endif
