// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSTileTextures
 * @brief   evaluates tiles of surfaces on the GPU, into textures that stay there
 *
 * Holds control points and knots of a nurbs::SurfaceTable in buffer textures, and two RGBA32F
 * textures with the vertices of tiles: positions relative to their surface's origin, and unit
 * normals. New tiles are evaluated by de Boor's algorithm in two passes, along u from control points
 * to the rows of a patch, then along v (Tan, Zhao, Lu 2012, section 3.3.3). A pass draws one
 * rectangle a tile by instancing, one call for each degree that occurs, whatever the number of
 * surfaces.
 *
 * The layout of a tile's texel (four integers): x | y << 16, surface | log u << 24 | log v << 28,
 * span u | span v << 16, first cell u | first cell v << 16.
 * A surface's two texels: first point, control points in u, degree u | degree v << 8 | reversed << 16,
 * user value; first block of knots in u and in v, start of its trims, user value.
 *
 * Private to this module. The context of the window must be current.
 */
#ifndef vtkNURBSTileTextures_h
#define vtkNURBSTileTextures_h

#include "SurfaceTable.h"
#include "TileAtlas.h"
#include "vtkNURBSBufferTexture.h"
#include "vtkNew.h"

#include <string>
#include <vector>

class vtkOpenGLFramebufferObject;
class vtkOpenGLRenderWindow;
class vtkOpenGLVertexArrayObject;
class vtkShaderProgram;
class vtkTextureObject;

class vtkNURBSTileTextures
{
public:
  vtkNURBSTileTextures();
  ~vtkNURBSTileTextures();
  vtkNURBSTileTextures(const vtkNURBSTileTextures&) = delete;
  vtkNURBSTileTextures& operator=(const vtkNURBSTileTextures&) = delete;

  /// What a shader is told of a surface beside its table entry.
  struct SurfaceInfo
  {
    bool Reversed = false;
    int Trim = -1;          ///< First texel of its trims.
    double Tolerance = 0.0; ///< Largest distance from its neighbours along shared edges.
  };

  /// Why the device can't be used; "" if it can.
  static std::string GetMissingFeature(vtkOpenGLRenderWindow* window);

  /// Sends a table, and forgets all tiles. False, and GetError tells why, if it does not fit.
  bool SetTable(const nurbs::SurfaceTable& table, const std::vector<SurfaceInfo>& infos);
  /// Sends new infos of the surfaces of that table. Tiles stay.
  bool SetInfos(const nurbs::SurfaceTable& table, const std::vector<SurfaceInfo>& infos);
  /// Sends the moved control points of surfaces (ascending) of that table, and forgets their tiles.
  void MoveSurfaces(const nurbs::SurfaceTable& table, const std::vector<int>& surfaces);

  /// Makes these tiles ready to be drawn, evaluating those that are not in the textures yet. Tiles are
  /// sorted by shape: GetFirst(shape) to GetFirst(shape + 1) - 1. False if they do not fit.
  bool Prepare(vtkOpenGLRenderWindow* window, const nurbs::SurfaceTable& table,
    const std::vector<nurbs::Tile>& tiles);
  int GetFirst(int shape) const { return this->First[shape]; }

  /// Binds everything that nurbsTile.glsl and a vertex stage want, and sets the uniforms.
  void Activate(vtkOpenGLRenderWindow* window, vtkShaderProgram* program);
  void Deactivate(vtkOpenGLRenderWindow* window);

  /// Deletes all.
  void Release(vtkOpenGLRenderWindow* window);

  const std::string& GetError() const { return this->Error; }
  std::size_t GetBytesSent() const;
  /// Vertices that Prepare has evaluated since the start.
  long long GetEvaluatedVertices() const { return this->EvaluatedVertices; }
  vtkTextureObject* GetPositions() { return this->Positions; }
  vtkTextureObject* GetNormals() { return this->Normals; }
  /// Where the last Prepare put tile i (its order, not the caller's).
  const std::vector<int>& GetTileTexels() const { return this->TileTexels; }

private:
  struct Job
  {
    int Tile;
    int X, Y; ///< Place of its rows between the passes.
    int Samples[2];
    int Degree[2];
  };
  bool Send(vtkNURBSBufferTexture& buffer, const void* data, std::size_t bytes, const char* what);
  bool PlaceTiles(vtkOpenGLRenderWindow* window, const std::vector<nurbs::Tile>& sorted,
    const nurbs::SurfaceTable& table, std::vector<Job>& jobs);
  void MakeAtlas(vtkOpenGLRenderWindow* window, int pagesX, int pagesY);
  void Evaluate(vtkOpenGLRenderWindow* window, std::vector<Job>& jobs);
  void RunBatch(
    vtkOpenGLRenderWindow* window, std::vector<Job>& jobs, std::size_t first, std::size_t last);
  void RunPass(vtkOpenGLRenderWindow* window, const Job* jobs, std::size_t count, int dir);
  vtkShaderProgram* Program(vtkOpenGLRenderWindow* window, int dir, int degree);

  nurbs::TileAtlas Atlas;
  vtkNew<vtkTextureObject> Positions;
  vtkNew<vtkTextureObject> Normals;
  vtkNew<vtkTextureObject> Rows;
  vtkNew<vtkTextureObject> RowDerivatives;
  vtkNew<vtkOpenGLFramebufferObject> RowBuffer;
  vtkNew<vtkOpenGLFramebufferObject> AtlasBuffer;
  vtkNew<vtkOpenGLVertexArrayObject> NoAttributes;
  vtkNURBSBufferTexture Points{ vtkNURBSBufferTexture::FLOAT4 };
  vtkNURBSBufferTexture Knots{ vtkNURBSBufferTexture::FLOAT };
  vtkNURBSBufferTexture Surfaces{ vtkNURBSBufferTexture::INTEGER4 };
  vtkNURBSBufferTexture Origins{ vtkNURBSBufferTexture::FLOAT4 };
  vtkNURBSBufferTexture Tiles{ vtkNURBSBufferTexture::INTEGER4 };
  vtkNURBSBufferTexture Jobs{ vtkNURBSBufferTexture::INTEGER4 };
  std::vector<int> TileTexels;
  int First[nurbs::Tile::ShapeCount + 1] = {};
  long long EvaluatedVertices = 0;
  std::vector<SurfaceInfo> Infos;
  std::string Error;
};

#endif
