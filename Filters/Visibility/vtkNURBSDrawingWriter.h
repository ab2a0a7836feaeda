// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSDrawingWriter
 * @brief Writes lines in a plane as an engineering drawing: SVG or PDF with true curves and layers.
 *
 * The input is a vtkPolyData of lines and polylines, or a composite data set of such, in the plane
 * (x right, y up; z is ignored), in model units: output 1 of vtkNURBSVisibleRegions with
 * ProjectLines on, or any other lines. Lines that go on in each other without a corner become one
 * path, and each path is fitted by as few cubic Bezier pieces and straight lines as Tolerance
 * allows, so that a circle is some six curves rather than hundreds of segments.
 *
 * | cell data | meaning; each may be missing |
 * |---|---|
 * | Visibility | 1 visible (default), 0 hidden: drawn dashed, below the visible ones |
 * | Kind | 0 silhouette, 1 boundary, 2 sharp edge (default), 3 smooth edge, 4 intersection |
 * | FaceId, EdgeId | where a line comes from; negative: none. In SVG: data-face, data-edge |
 *
 * The field data LengthUnit ("mm", "m", "in", ...; mm if missing) tells what a model unit is, for
 * the scale that the file states. In SVG, the groups "visible" and "hidden" hold a group a kind of
 * line, with an id as "hidden-sharp", the classes "hidden sharp", and paths in millimetres; all
 * groups are layers of Inkscape. A path of an assembly's part also has data-part, the part's name.
 * In PDF the kinds are layers that can be switched off.
 *
 * Errors set the error code and leave no file: no file name, an ending that is not .svg or .pdf
 * (without Format), no lines with a length, a coordinate that is not finite, a drawing that does
 * not fit its page, widths or a tolerance that are not positive, a file that can't be written.
 *
 * Source of the pieces: P. J. Schneider, "An algorithm for automatically fitting digitized curves",
 * Graphics Gems (1990), with changes that PathFit.h tells. Line widths, dashes and layers follow
 * ISO 128-2. Documentation/decisions/drawing-files.md tells which libraries write the files, and
 * why.
 *
 * @sa vtkNURBSVisibleRegions vtkNURBSSilhouette
 */
#ifndef vtkNURBSDrawingWriter_h
#define vtkNURBSDrawingWriter_h

#include "vtkNURBSFiltersVisibilityModule.h" // For export macro
#include "vtkWriter.h"

class VTKNURBSFILTERSVISIBILITY_EXPORT vtkNURBSDrawingWriter : public vtkWriter
{
public:
  static vtkNURBSDrawingWriter* New();
  vtkTypeMacro(vtkNURBSDrawingWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /// What Format may be.
  enum Formats
  {
    BY_ENDING = 0,
    SVG = 1,
    PDF = 2
  };

  ///@{
  /**
   * What kind of file: as FileName ends (.svg or .pdf, default), or told.
   */
  vtkSetClampMacro(Format, int, BY_ENDING, PDF);
  vtkGetMacro(Format, int);
  void SetFormatToByEnding() { this->SetFormat(BY_ENDING); }
  void SetFormatToSVG() { this->SetFormat(SVG); }
  void SetFormatToPDF() { this->SetFormat(PDF); }
  ///@}

  ///@{
  /**
   * Millimetres of paper a model unit. 0 (default): as large as fits PageSize, and an A4 sheet if
   * that is TIGHT.
   */
  vtkSetMacro(Scale, double);
  vtkGetMacro(Scale, double);
  ///@}

  /// What PageSize may be.
  enum PageSizes
  {
    TIGHT = 0,
    A4 = 1,
    A3 = 2,
    A2 = 3,
    A1 = 4,
    A0 = 5
  };

  ///@{
  /**
   * The page: as large as the drawing with its margin (TIGHT, default), or a sheet (ISO 216), in
   * whose middle the drawing is.
   */
  vtkSetClampMacro(PageSize, int, TIGHT, A0);
  vtkGetMacro(PageSize, int);
  ///@}

  /// What Orientation may be.
  enum Orientations
  {
    AUTOMATIC = 0,
    LANDSCAPE = 1,
    PORTRAIT = 2
  };

  ///@{
  /**
   * How the sheet lies: as suits the drawing (AUTOMATIC, default), or told. Nothing to a TIGHT
   * page, unless Scale is 0.
   */
  vtkSetClampMacro(Orientation, int, AUTOMATIC, PORTRAIT);
  vtkGetMacro(Orientation, int);
  ///@}

  ///@{
  /**
   * The distance of the drawing from the borders of the page at least, in millimetres. Default 10;
   * must not be negative.
   */
  vtkSetMacro(Margin, double);
  vtkGetMacro(Margin, double);
  ///@}

  ///@{
  /**
   * Whether hidden lines are drawn, but where another line is, within Tolerance: a visible one, or a
   * hidden one that is drawn already. Default: on.
   */
  vtkSetMacro(HiddenLines, bool);
  vtkGetMacro(HiddenLines, bool);
  vtkBooleanMacro(HiddenLines, bool);
  ///@}

  ///@{
  /**
   * Widths of lines in millimetres: visible silhouettes and boundaries (default 0.5), visible sharp
   * edges and intersections (0.35), visible and hidden smooth edges (0.18), other hidden lines
   * (0.25). Must be positive.
   */
  vtkSetMacro(OutlineWidth, double);
  vtkGetMacro(OutlineWidth, double);
  vtkSetMacro(EdgeWidth, double);
  vtkGetMacro(EdgeWidth, double);
  vtkSetMacro(SmoothWidth, double);
  vtkGetMacro(SmoothWidth, double);
  vtkSetMacro(HiddenWidth, double);
  vtkGetMacro(HiddenWidth, double);
  ///@}

  /// What ToleranceMode may be.
  enum ToleranceModes
  {
    RELATIVE = 0,
    ABSOLUTE = 1
  };

  ///@{
  /**
   * What Tolerance is measured in: the diagonal of the box around the lines (RELATIVE, default), or
   * model units (ABSOLUTE).
   */
  vtkSetClampMacro(ToleranceMode, int, RELATIVE, ABSOLUTE);
  vtkGetMacro(ToleranceMode, int);
  void SetToleranceModeToRelative() { this->SetToleranceMode(RELATIVE); }
  void SetToleranceModeToAbsolute() { this->SetToleranceMode(ABSOLUTE); }
  ///@}

  ///@{
  /**
   * The largest distance between the input's lines and what is drawn, both ways. Should be no finer
   * than what the lines were made for, else their vertices become corners. Default 1e-4; must be
   * positive.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * What the file tells of itself: a title (default: the file's name without folder and ending),
   * where the drawing comes from, such as a CAD file's name, and the view, such as "front". UTF-8.
   */
  vtkSetStringMacro(Title);
  vtkGetStringMacro(Title);
  vtkSetStringMacro(Source);
  vtkGetStringMacro(Source);
  vtkSetStringMacro(View);
  vtkGetStringMacro(View);
  ///@}

  ///@{
  /**
   * Of the last file: paths and their pieces (Bezier curves and straight lines), visible and
   * hidden; millimetres a model unit; the page in millimetres. 0 before the first one and after an
   * error.
   */
  vtkGetMacro(NumberOfVisiblePaths, vtkIdType);
  vtkGetMacro(NumberOfHiddenPaths, vtkIdType);
  vtkGetMacro(NumberOfCurves, vtkIdType);
  vtkGetMacro(NumberOfStraightLines, vtkIdType);
  vtkGetMacro(ScaleUsed, double);
  vtkGetVector2Macro(PageUsed, double);
  ///@}

protected:
  vtkNURBSDrawingWriter();
  ~vtkNURBSDrawingWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkNURBSDrawingWriter(const vtkNURBSDrawingWriter&) = delete;
  void operator=(const vtkNURBSDrawingWriter&) = delete;

  struct Work;
  bool Fail(unsigned long code, const std::string& message);
  bool CheckOptions();
  bool ChooseFormat(Work& work);
  bool Layout(Work& work);
  void Draw(Work& work);
  bool Save(const Work& work);

  char* FileName = nullptr;
  int Format = BY_ENDING;
  double Scale = 0.0;
  int PageSize = TIGHT;
  int Orientation = AUTOMATIC;
  double Margin = 10.0;
  bool HiddenLines = true;
  double OutlineWidth = 0.5;
  double EdgeWidth = 0.35;
  double SmoothWidth = 0.18;
  double HiddenWidth = 0.25;
  int ToleranceMode = RELATIVE;
  double Tolerance = 1e-4;
  char* Title = nullptr;
  char* Source = nullptr;
  char* View = nullptr;

  vtkIdType NumberOfVisiblePaths = 0;
  vtkIdType NumberOfHiddenPaths = 0;
  vtkIdType NumberOfCurves = 0;
  vtkIdType NumberOfStraightLines = 0;
  double ScaleUsed = 0.0;
  double PageUsed[2] = { 0.0, 0.0 };
};

#endif
