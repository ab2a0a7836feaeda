// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What vtkNURBSMapper keeps. Its shaders are in vtkNURBSMapperShaders.cxx, all else is in vtkNURBSMapper.cxx.
#ifndef vtkNURBSMapperInternals_h
#define vtkNURBSMapperInternals_h

#include "vtkFloatArray.h"
#include "vtkNURBSBufferTexture.h"
#include "vtkNURBSContextWatch.h"
#include "vtkNURBSDrawnModel.h"
#include "vtkNURBSFaceLooks.h"
#include "vtkNURBSFrameRate.h"
#include "vtkNURBSGridIndices.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSTessellatedDrawing.h"
#include "vtkNURBSTileTextures.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

struct vtkNURBSMapper::Internals
{
  vtkNURBSDrawnModel Model;
  vtkNew<vtkNURBSContextWatch> Watch; ///< Of the window that the objects on the device belong to.
  bool ModelIsSent = false;
  bool TrimsAreSent = false;
  std::vector<int> MovedSinceSent;
  vtkMTimeType ModelVersion = 0; ///< Rises with every change of the model.

  vtkNURBSTileTextures Textures;
  vtkNURBSGridIndices Indices;
  vtkNURBSBufferTexture TrimPoints{ vtkNURBSBufferTexture::FLOAT4 };
  vtkNURBSBufferTexture TrimRecords{ vtkNURBSBufferTexture::INTEGER4 };
  vtkNURBSBufferTexture LookTexture{ vtkNURBSBufferTexture::COLOR };
  vtkNURBSBufferTexture FaceIds{ vtkNURBSBufferTexture::INTEGER4 };
  vtkNURBSBufferTexture LookColors{ vtkNURBSBufferTexture::COLOR };
  vtkNURBSTessellatedDrawing Tessellated;
  vtkNURBSFrameRate FrameRate;
  int Samples = 0; ///< Of a pixel, if fragments choose among them; else 0.
  vtkNURBSFaceLooks Looks;
  bool LooksAreSent = false;

  /// Stands for the input where the superclass asks for points and normals: one point.
  vtkNew<vtkPolyData> StandIn;
  bool StandInIsSent = false;

  nurbs::TileView View;
  vtkMTimeType ViewedVersion = 0;
  nurbs::TileSelection Selection;
  bool TilesAreReady = false;
  void SelectTiles();

  nurbs::Vec3 Shift = nurbs::Vec3::Zero();
  std::string LastError;

  Internals()
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    points->InsertNextPoint(0.0, 0.0, 0.0);
    vtkNew<vtkFloatArray> normals;
    normals->SetNumberOfComponents(3);
    normals->InsertNextTuple3(0.0, 0.0, 1.0);
    this->StandIn->SetPoints(points);
    this->StandIn->GetPointData()->SetNormals(normals);
  }
};

#endif
