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
 *     const auto outcome = pieces.Run([&]() {
 *       vtkDataObject* whole = pieces.Gather(input);
 *       ...                      // input and outputs as ever, with `whole` as the input
 *       pieces.Keep(output);
 *       return !aborted;
 *     }, problem);
 *
 * So the union of all processes' outputs is what one process would make, bit for bit. Partitions of
 * a block that one process read are put together in the same way. Without other processes, and with
 * one partition a block, nothing is done: Gather returns the input.
 *
 * Processes work together only if the request is for the piece of this process out of as many as
 * there are: ParaView's are. A pipeline that one of several processes updates for itself asks for all
 * in one piece and waits for nobody.
 *
 * A process that fails, by an exception, or is aborted while it runs takes the others with it: in each
 * call that processes make together they first tell each other what they come for, and stop if one has
 * come for its end. So none waits for one that does not come, and all report the same error. Only what
 * ends a process without an exception ends the others, by MPI.
 */
#ifndef vtkNURBSPieces_h
#define vtkNURBSPieces_h

#include "Types.h"
#include "WorkShare.h"
#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkNURBSModelView.h"
#include "vtkSmartPointer.h"
#include "vtkType.h" // For vtkIdType

#include <array>      // For std::array
#include <functional> // For std::function
#include <map>        // For std::map
#include <string>     // For std::string
#include <vector>     // For std::vector

class vtkDataObject;
class vtkDataSetAttributes;
class vtkIdTypeArray;
class vtkInformation;
class vtkInformationIntegerKey;
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

  /// Marks a request for data whose input could not be made: Run fails, and tells the others.
  static vtkInformationIntegerKey* NO_INPUT();
  /// True if there are other processes at all.
  static bool HasOtherProcesses();
  /// True if data are what one of several processes has of a model.
  static bool IsPiece(vtkDataObject* data);

  /// True if other processes work on the same request.
  bool IsParallel() const { return this->Controller != nullptr; }
  /// How loops over what was gathered are divided among the processes.
  nurbs::WorkShare GetShare() const;
  /// The number of this process among them; 0 if there are no others.
  int GetRank() const { return this->Rank; }

  enum Outcome
  {
    DONE,
    ABORTED, ///< In some process.
    FAILED   ///< In some process.
  };
  /// Does what processes do together, and comes to the same end in all of them: calls with the word
  /// "processes" below are made in `work` only, by all, in the same order. `work` returns false if it
  /// was aborted, and throws std::exceptions. `problem`: what they say, "" if none failed; where it is
  /// not the same in all processes, a line "process 1: ..." each.
  Outcome Run(const std::function<bool()>& work, std::string& problem) const;
  /// Throws nurbs::Error if something is wrong ("": nothing is).
  static void ThrowIf(const std::string& problem);

  enum Scope
  {
    ALL,       ///< The faces of all processes.
    NEIGHBOURS ///< Own faces, and those of others that have an edge or vertex with them in common.
  };

  /// Faces of all processes, in the order of processes and their cells; the input itself if there are
  /// no others. Throws nurbs::Error if the input is no model. Owned by this.
  vtkDataObject* Gather(vtkDataObject* input, Scope scope = ALL);

  /// Identity of the faces and edges of what was gathered, the same on all processes: of each grid that
  /// has cells, in order. Of a face the owner's rank and a number there.
  struct Identity
  {
    std::vector<char> IsGhost; ///< One a face: it is another process's.
    std::vector<std::array<std::int64_t, 2>> Faces;
    std::vector<std::int64_t> Edges, Vertices;
  };
  Identity GetIdentity() const;

  /// True if Gather would return what it did: no input of all processes has changed since.
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

  /// The lines of all processes, by rank.
  void Join(std::vector<std::string>& lines) const;
  /// One message of all processes each, by rank.
  std::vector<std::vector<char>> Exchange(const std::vector<char>& own) const;

private:
  /// What processes come together for.
  enum Purpose
  {
    EXCHANGE,
    REDUCE,
    READY,
    END_DONE,
    END_ABORTED,
    END_FAILED
  };
  std::vector<vtkIdType> Meet(
    Purpose purpose, vtkIdType size = 0, const std::string& said = std::string()) const;
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
  std::vector<char> Pack(const Raws& raws, const Choice& cells) const;
  Choice AllCells() const;
  std::vector<std::vector<std::int64_t>> FindKeys(const Raws& raws) const;
  std::vector<Choice> FindShared(const Raws& raws);
  std::vector<std::vector<char>> ExchangeWithEach(
    const std::vector<std::vector<char>>& messages) const;
  void Merge(const std::vector<std::vector<char>>& messages);
  vtkSmartPointer<vtkDataObject> KeepLeaf(const Grid& grid, vtkDataObject* leaf) const;
  vtkSmartPointer<vtkDataObject> KeepModel(const Grid& grid, vtkUnstructuredGrid* leaf) const;
  vtkSmartPointer<vtkDataObject> KeepMesh(const Grid& grid, vtkPolyData* leaf) const;
  void FinishLeaf(const Grid& grid, vtkDataObject* kept) const;

  vtkMultiProcessController* Controller = nullptr;
  int Rank = 0;
  bool HasInput = true;
  vtkDataObject* Input = nullptr;
  std::vector<Grid> Grids;              ///< This process's.
  vtkSmartPointer<vtkDataObject> Whole; ///< Null: the input is used as it is.
  /// By block: the global ids of the edges and vertices of Whole, and its box.
  std::map<unsigned int, std::vector<std::int64_t>> EdgeIds, VertexIds;
  std::map<unsigned int, nurbs::Box3> Boxes;
};

#endif
