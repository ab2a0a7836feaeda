// SPDX-License-Identifier: BSD-3-Clause
// What vtkNURBSMapper puts into its superclass's shaders, and what it tells them.
#include "vtkNURBSMapperInternals.h"

#include "vtkActor.h"
#include "vtkColorTransferFunction.h"
#include "vtkHardwareSelector.h"
#include "vtkOpenGLHelper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkShaderProgram.h"
#include "vtk_glew.h"

#include "nurbsExact.h"
#include "nurbsFragment.h"
#include "nurbsLook.h"
#include "nurbsTile.h"
#include "nurbsTrim.h"
#include "nurbsVertex.h"

#include <algorithm>
#include <cmath>

void vtkNURBSMapper::ReplaceShaderValues(
  std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer, vtkActor* actor)
{
  std::string fragment = shaders[vtkShader::Fragment]->GetSource();
  const auto substitute = [](std::string& source, const char* from, const std::string& to) {
    vtkShaderProgram::Substitute(source, from, to);
  };
  const bool exact = this->DrawsExactly(actor);
  const std::string defines = this->GetDefines(actor);
  std::string functions =
    defines + nurbsTile + nurbsTrim + (exact ? nurbsExact : "") + nurbsFragment;
  substitute(functions, "//NURBS::Look::Dec", exact ? nurbsLook : "");
  substitute(fragment, "//VTK::PositionVC::Dec", functions + "//VTK::PositionVC::Dec");
  if (this->Content->Samples > 0)
  {
    substitute(fragment, "//VTK::System::Dec",
      "//VTK::System::Dec\n#extension GL_ARB_sample_shading : require\n");
  }
  substitute(fragment, "//VTK::PositionVC::Impl",
    std::string("  nurbsBeginFragment();\n") +
      (this->HasLook(actor) ? "  nurbsBeginLook();\n" : "") + "  //VTK::PositionVC::Impl\n");
  // Before depth peeling, which looks at the depth of what stays.
  substitute(
    fragment, "//VTK::Depth::Impl", "  if (!nurbsIsSeen) { discard; }\n  //VTK::Depth::Impl\n");
  substitute(fragment, "//VTK::Color::Impl",
    "  //VTK::Color::Impl\n"
    "  nurbsColor(ambientIntensity, diffuseIntensity, ambientColor, diffuseColor, opacity);\n");
  this->ReplaceSelection(fragment);
  shaders[vtkShader::Fragment]->SetSource(fragment);

  this->Superclass::ReplaceShaderValues(shaders, renderer, actor);

  // The superclass has declared attributes; ours are variables that nurbsFetchVertex sets.
  std::string vertex = shaders[vtkShader::Vertex]->GetSource();
  std::string declarations = nurbsVertex;
  substitute(declarations, "//NURBS::Tile::Dec", defines + nurbsTile);
  substitute(vertex, "in vec3 normalMC;", "");
  substitute(vertex, "in vec4 vertexMC;", declarations);
  substitute(vertex, "void main()\n{", "void main()\n{\n  nurbsFetchVertex();\n");
  shaders[vtkShader::Vertex]->SetSource(vertex);

  if (exact)
  {
    // The surface's own point, normal, side and depth, instead of the triangles'.
    fragment = shaders[vtkShader::Fragment]->GetSource();
    substitute(fragment, "//VTK::Depth::Impl", "gl_FragDepth = gl_FragCoord.z;");
    substitute(fragment, "gl_FrontFacing", "nurbsFront");
    substitute(fragment, "gl_FragCoord.z", "nurbsDepth");
    substitute(fragment, "normalize(normalVCVSOutput)", "normalize(normalMatrix * nurbsNormal)");
    substitute(fragment, "in vec4 vertexVCVSOutput;", "uniform mat4 MCVCMatrix;");
    substitute(fragment, "vertexVCVSOutput", "MCVCMatrix * nurbsVertex");
    substitute(fragment, "in float clipDistancesVSOutput[6];", "uniform vec4 clipPlanes[6];");
    substitute(
      fragment, "clipDistancesVSOutput[planeNum]", "dot(clipPlanes[planeNum], nurbsVertex)");
    shaders[vtkShader::Fragment]->SetSource(fragment);
  }
}

// Whether something is to be seen that the triangles can't show.
bool vtkNURBSMapper::HasLook(vtkActor* actor)
{
  return this->Look != PLAIN || this->NumberOfIsoLines[0] > 0 || this->NumberOfIsoLines[1] > 0 ||
    actor->GetProperty()->GetEdgeVisibility();
}

// Whether fragments look for the surface itself: not for lines and points, which are the grid's.
bool vtkNURBSMapper::DrawsExactly(vtkActor* actor)
{
  return actor->GetProperty()->GetRepresentation() == VTK_SURFACE &&
    ((this->ExactFragments && this->Content->FrameRate.LooksForPoints()) || this->HasLook(actor));
}

std::string vtkNURBSMapper::GetDefines(vtkActor* actor)
{
  const Internals& c = *this->Content;
  std::string defines = "#define NURBS_MAX_LOG " + std::to_string(nurbs::Tile::MaxLog) + "\n";
  if (actor->GetProperty()->GetRepresentation() == VTK_SURFACE)
  {
    defines += "#define NURBS_SPREAD\n";
  }
  if (this->DrawsExactly(actor))
  {
    defines += "#define NURBS_EXACT\n#define NURBS_MAX_DEGREE " +
      std::to_string(c.Model.GetMaxDegree()) + "\n";
    if (c.Samples > 0)
    {
      defines += "#define NURBS_SAMPLES " + std::to_string(c.Samples) + "\n";
    }
    if (this->HasLook(actor))
    {
      defines += "#define NURBS_LOOK\n";
    }
  }
  return defines;
}

// Passes of a hardware selection that ask what was hit: the cell, the block of a composite, and the
// process that has it, if that is not the one that draws.
void vtkNURBSMapper::ReplaceSelection(std::string& fragment)
{
  std::string value;
  switch (this->LastSelectionState)
  {
    case vtkHardwareSelector::CELL_ID_LOW24:
      value = "nurbsIds().x & 0xffffff";
      break;
    case vtkHardwareSelector::CELL_ID_HIGH24:
      value = "(nurbsIds().x >> 24) & 0xff";
      break;
    case vtkHardwareSelector::COMPOSITE_INDEX_PASS:
      value = "nurbsIds().y";
      break;
    case vtkHardwareSelector::PROCESS_PASS:
      if (this->Content->Model.GetLeaves().empty() ||
        this->Content->Model.GetLeaves().front().Process < 0)
      {
        return;
      }
      value = "nurbsIds().z";
      break;
    default:
      return;
  }
  vtkShaderProgram::Substitute(fragment, "//VTK::Picking::Impl",
    "  int nurbsId = " + value +
      ";\n"
      "  gl_FragData[0] = vec4(float(nurbsId & 0xff), float((nurbsId >> 8) & 0xff),\n"
      "    float((nurbsId >> 16) & 0xff), 255.0) / 255.0;\n");
}

void vtkNURBSMapper::SetMapperShaderParameters(
  vtkOpenGLHelper& helper, vtkRenderer* renderer, vtkActor* actor)
{
  this->Superclass::SetMapperShaderParameters(helper, renderer, actor);
  Internals& c = *this->Content;
  auto* window = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
  vtkShaderProgram* program = helper.Program;
  c.Textures.Activate(window, program);
  const auto set = [&](const char* name, vtkNURBSBufferTexture& buffer) {
    if (program->IsUniformUsed(name))
    {
      program->SetUniformi(name, buffer.Activate(window));
    }
  };
  set("nurbsTrimPoints", c.TrimPoints);
  set("nurbsTrimRecords", c.TrimRecords);
  set("nurbsFaceLooks", c.LookTexture);
  set("nurbsFaceIds", c.FaceIds);
  const Eigen::Vector3f high = c.Shift.cast<float>();
  const Eigen::Vector3f low = (c.Shift - high.cast<double>()).cast<float>();
  program->SetUniform3f("nurbsShiftHigh", high.data());
  program->SetUniform3f("nurbsShiftLow", low.data());
  if (actor->GetProperty()->GetRepresentation() == VTK_SURFACE)
  {
    this->SetSurfaceParameters(window, program, actor);
  }
  if (this->HasLook(actor))
  {
    this->SetLookParameters(window, program, actor);
  }
}

void vtkNURBSMapper::SetSurfaceParameters(
  vtkOpenGLRenderWindow* window, vtkShaderProgram* program, vtkActor* actor)
{
  const Internals& c = *this->Content;
  Eigen::Matrix4d shift = Eigen::Matrix4d::Identity();
  shift.topRightCorner<3, 1>() = c.Shift;
  const Eigen::Matrix4d toClip = c.View.ModelToClip * shift;
  Eigen::Matrix4f matrix = toClip.cast<float>(); // column by column, as OpenGL wants it
  program->SetUniformMatrix4x4("nurbsToClip", matrix.data());
  int viewport[4];
  window->GetState()->vtkglGetIntegerv(GL_VIEWPORT, viewport);
  const float pixels[4] = { float(viewport[0]), float(viewport[1]), float(viewport[2]),
    float(viewport[3]) };
  program->SetUniform4f("nurbsViewport", pixels);
  // Each coarser level is off by four times as much; gaps of some pixels can be filled, not more.
  const double error = this->PixelError * std::pow(4.0, c.FrameRate.GetCoarserLevels());
  program->SetUniformf("nurbsMargin", static_cast<float>(std::min(0.1 + error, 4.0)));
  program->SetUniformi("nurbsOnce", actor->IsRenderingTranslucentPolygonalGeometry() ? 1 : 0);
  if (!this->DrawsExactly(actor))
  {
    return;
  }
  const Eigen::Vector3f axis = toClip.row(2).head<3>().transpose().normalized().cast<float>();
  program->SetUniform3f("nurbsDepthAxis", axis.data());
  vtkProperty* property = actor->GetProperty();
  program->SetUniformi("nurbsCulled",
    property->GetBackfaceCulling()      ? 1
      : property->GetFrontfaceCulling() ? 2
                                        : 0);
  if (c.Samples > 0)
  {
    std::vector<float> places(2 * c.Samples);
    for (int i = 0; i < c.Samples; ++i)
    {
      glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(i), places.data() + 2 * i);
    }
    for (float& place : places)
    {
      place -= 0.5f;
    }
    program->SetUniformi("nurbsSampleCount", c.Samples);
    program->SetUniform2fv(
      "nurbsSamples", c.Samples, reinterpret_cast<const float(*)[2]>(places.data()));
  }
}

vtkSmartPointer<vtkScalarsToColors> vtkNURBSMapper::GetLookColors()
{
  if (this->LookTable)
  {
    return this->LookTable;
  }
  this->UpdateModel();
  const double diagonal =
    this->LookLength > 0.0 ? this->LookLength : this->Content->Model.GetBounds().diagonal().norm();
  const double limit = this->Look == DRAFT_ANGLE ? 90.0
    : this->Look == GAUSSIAN_CURVATURE           ? 100.0 / (diagonal * diagonal)
                                                 : 10.0 / diagonal;
  auto table = vtkSmartPointer<vtkColorTransferFunction>::New();
  table->SetColorSpaceToDiverging();
  table->AddRGBPoint(-limit, 0.230, 0.299, 0.754);
  table->AddRGBPoint(limit, 0.706, 0.016, 0.150);
  return table;
}

void vtkNURBSMapper::SetLookParameters(
  vtkOpenGLRenderWindow* window, vtkShaderProgram* program, vtkActor* actor)
{
  constexpr int Colors = 256;
  Internals& c = *this->Content;
  const vtkSmartPointer<vtkScalarsToColors> table = this->GetLookColors();
  const double* range = table->GetRange();
  if (program->IsUniformUsed("nurbsLookTable"))
  {
    std::vector<unsigned char> colors;
    for (int i = 0; i < Colors; ++i)
    {
      const unsigned char* color =
        table->MapValue(range[0] + (range[1] - range[0]) * i / (Colors - 1));
      colors.insert(colors.end(), color, color + 4);
    }
    c.LookColors.Upload(colors.data(), colors.size());
    program->SetUniformi("nurbsLookTable", c.LookColors.Activate(window));
  }
  const auto set = [&](const char* name, int count, const float* values) {
    if (program->IsUniformUsed(name))
    {
      count == 1     ? program->SetUniformf(name, values[0])
        : count == 2 ? program->SetUniform2f(name, values)
                     : program->SetUniform3f(name, values);
    }
  };
  const float limits[2] = { float(range[0]), float(range[1]) };
  set("nurbsLookRange", 2, limits);
  const Eigen::Vector3f direction =
    Eigen::Map<const nurbs::Vec3>(this->LookDirection).normalized().cast<float>();
  set("nurbsLookDirection", 3, direction.data());
  const float stripes = static_cast<float>(this->NumberOfStripes);
  set("nurbsStripes", 1, &stripes);
  const float lines[2] = { float(this->NumberOfIsoLines[0]), float(this->NumberOfIsoLines[1]) };
  set("nurbsLineCounts", 2, lines);
  vtkProperty* property = actor->GetProperty();
  const float width = property->GetLineWidth();
  set("nurbsLineWidth", 1, &width);
  const double* edge = property->GetEdgeColor();
  const float color[3] = { float(edge[0]), float(edge[1]), float(edge[2]) };
  set("nurbsLineColor", 3, color);
  program->SetUniformi("nurbsLookKind", this->Look);
  program->SetUniformi("nurbsShowEdges", property->GetEdgeVisibility() ? 1 : 0);
}
