// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSPieces.h
 * @brief What a filter does about the other processes' pieces of a model.
 *
 * Under MPI every process has a piece of each model: some of its faces. A filter for which a face is
 * not alone (edges that faces share, faces that hide others) gathers the others' faces, works on the
 * model that results just as it would on one process, and keeps what became of its own faces:
 *
 *     vtkNURBSPieces pieces(request, outputs);
 *     vtkDataObject* whole = pieces.Gather(input, problem);
 *     ...                      // input and outputs as ever, with `whole` as the input
 *     pieces.Keep(output);
 *
 * So the union of all processes' outputs is what one process would make, bit for bit. Partitions of
 * a block that one process read are put together in the same way. Without other processes, and with
 * one partition a block, nothing is done: Gather returns the input.
 *
 * Processes work together only if the request is for the piece of this process out of as many as
 * there are: ParaView's are. A pipeline that one of several processes updates for itself asks for all
 * in one piece and waits for nobody.
 */
#ifndef vtkNURBSPieces_h
#define vtkNURBSPieces_h

#include "Types.h"
#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkNURBSModelView.h"
#include "vtkSmartPointer.h"
#include "vtkType.h" // For vtkIdType

#include <array>  // For std::array
#include <map>    // For std::map
#include <string> // For std::string
#include <vector> // For std::vector

class vtkDataObject;
class vtkDataSetAttributes;
class vtkIdTypeArray;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;
class vtkPolyData;
class vtkUnstructuredGrid;

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSPieces
{
public:
  /// Of this process alone.
  vtkNURBSPieces();
  /// Of a filter's RequestData.
  vtkNURBSPieces(vtkInformation* request, vtkInformationVector* outputs);
  ~vtkNURBSPieces();
  vtkNURBSPieces(const vtkNURBSPieces&) = delete;
  vtkNURBSPieces& operator=(const vtkNURBSPieces&) = delete;

  /// The piece that a source is asked for, and of how many; returns false if it is all.
  static bool IsPieceAsked(vtkInformation* output, int& piece, int& pieces);

  /// True if other processes work on the same request.
  bool IsParallel() const { return this->Controller != nullptr; }

  enum Scope
  {
    ALL,       ///< The faces of all processes.
    NEIGHBOURS ///< Own faces, and those of others that have an edge or vertex with them in common.
  };

  /// Faces of all processes, in the order of processes and their cells; the input itself if there are
  /// no others. What is wrong with the input of any process is written to `problem`. Owned by this.
  vtkDataObject* Gather(vtkDataObject* input, std::string& problem, Scope scope = ALL);

  /// Identity of the faces and edges of what was gathered, the same on all processes: of each grid that
  /// has cells, in order. Of a face the owner's rank and a number there.
  struct Identity
  {
    std::vector<char> IsGhost; ///< One a face: it is another process's.
    std::vector<std::array<std::int64_t, 2>> Faces;
    std::vector<std::int64_t> Edges, Vertices;
  };
  Identity GetIdentity() const;

  /// True if Gather would return what `before` did: no process's input has changed since.
  bool IsUpToDate(vtkDataObject* input) const;

  /// Drops the cells of other processes' faces from an output made of what Gather returned, and
  /// gives the others the attributes of their faces.
  void Keep(vtkDataObject* output) const;

  /// Marks cells of an output as those of faces, for outputs that have no face attributes.
  static void CopyOwners(
    vtkUnstructuredGrid* grid, vtkIdTypeArray* faces, vtkDataSetAttributes* target);

  /// Extremes and sums over all processes, in place.
  void Largest(double* values, int count) const;
  void Sum(vtkIdType* values, int count) const;
  /// Of numbers by block, whichever process has it: extremes, sums.
  void Largest(std::map<unsigned int, double>& values) const;
  void Sum(std::map<unsigned int, vtkIdType>& values) const;
  /// The block of each grid of what was gathered that has cells, in order.
  std::vector<unsigned int> GetBlocks() const;
  /// The box around those of all processes.
  nurbs::Box3 Around(const nurbs::Box3& own) const;

  /// One message of every process, by rank.
  std::vector<std::vector<char>> Exchange(const std::vector<char>& own) const;

private:
  struct Grid
  {
    unsigned int Block = 0, Partition = 0;
    vtkUnstructuredGrid* Data = nullptr;
    vtkMTimeType Time = 0;
    vtkIdType FirstCell = 0; ///< Its cells' numbers among those of this process in the block.
  };
  void FindGrids(vtkDataObject* input, std::vector<Grid>& grids) const;
  using Raws = std::vector<vtkNURBSModelView::Raw>;
  /// The cells of every grid that a message is about.
  using Choice = std::vector<std::vector<vtkIdType>>;
  Raws MakeRaws(const std::string& problem) const;
  std::vector<char> Pack(const Raws& raws, const Choice& cells, const std::string& problem) const;
  Choice AllCells() const;
  std::vector<std::vector<std::int64_t>> FindKeys(const Raws& raws) const;
  std::vector<Choice> FindShared(const Raws& raws, std::string& problem);
  std::vector<std::vector<char>> ExchangeWithEach(
    const std::vector<std::vector<char>>& messages) const;
  void Merge(const std::vector<std::vector<char>>& messages, std::string& problem);
  vtkSmartPointer<vtkDataObject> KeepLeaf(const Grid& grid, vtkDataObject* leaf) const;
  vtkSmartPointer<vtkDataObject> KeepModel(const Grid& grid, vtkUnstructuredGrid* leaf) const;
  vtkSmartPointer<vtkDataObject> KeepMesh(const Grid& grid, vtkPolyData* leaf) const;
  void FinishLeaf(const Grid& grid, vtkDataObject* kept) const;

  vtkMultiProcessController* Controller = nullptr;
  int Rank = 0;
  vtkDataObject* Input = nullptr;
  std::vector<Grid> Grids;              ///< This process's.
  vtkSmartPointer<vtkDataObject> Whole; ///< Null: the input is used as it is.
  /// By block: the global ids of the edges and vertices of Whole, and its box.
  std::map<unsigned int, std::vector<std::int64_t>> EdgeIds, VertexIds;
  std::map<unsigned int, nurbs::Box3> Boxes;
};

#endif
