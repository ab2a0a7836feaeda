// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSGridIndices.h"

#include "vtkProperty.h"
#include "vtk_glew.h"

#include <vector>

namespace
{

using Indices = std::vector<unsigned short>;

void AppendTriangles(Indices& indices, int m, int n)
{
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const auto at = [&](int a, int b) {
        return static_cast<unsigned short>(i + a + (j + b) * (m + 1));
      };
      indices.insert(indices.end(), { at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1) });
    }
  }
}

void AppendLines(Indices& indices, int m, int n)
{
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= m; ++i)
    {
      const auto at = [&](int a, int b) {
        return static_cast<unsigned short>(i + a + (j + b) * (m + 1));
      };
      if (i < m)
      {
        indices.insert(indices.end(), { at(0, 0), at(1, 0) });
      }
      if (j < n)
      {
        indices.insert(indices.end(), { at(0, 0), at(0, 1) });
      }
    }
  }
}

} // namespace

void vtkNURBSGridIndices::Bind()
{
  if (this->Buffer)
  {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, this->Buffer);
    return;
  }
  Indices indices;
  for (int representation : { VTK_POINTS, VTK_WIREFRAME, VTK_SURFACE })
  {
    for (int shape = 0; shape < nurbs::Tile::ShapeCount; ++shape)
    {
      const int m = 1 << (shape % (nurbs::Tile::MaxLog + 1));
      const int n = 1 << (shape / (nurbs::Tile::MaxLog + 1));
      Range& range = this->Ranges[representation][shape];
      const std::size_t before = indices.size();
      range.Offset = before * sizeof(indices[0]);
      if (representation == VTK_SURFACE)
      {
        AppendTriangles(indices, m, n);
      }
      else if (representation == VTK_WIREFRAME)
      {
        AppendLines(indices, m, n);
      }
      else
      {
        for (int k = 0; k < (m + 1) * (n + 1); ++k)
        {
          indices.push_back(static_cast<unsigned short>(k));
        }
      }
      range.Count = static_cast<int>(indices.size() - before);
    }
  }
  glGenBuffers(1, &this->Buffer);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, this->Buffer);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
    static_cast<GLsizeiptr>(indices.size() * sizeof(indices[0])), indices.data(), GL_STATIC_DRAW);
}

void vtkNURBSGridIndices::Unbind()
{
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

void vtkNURBSGridIndices::Draw(int representation, int shape, int count) const
{
  const Range& range = this->Ranges[representation][shape];
  const GLenum mode = representation == VTK_SURFACE ? GL_TRIANGLES
    : representation == VTK_WIREFRAME               ? GL_LINES
                                                    : GL_POINTS;
  glDrawElementsInstanced(
    mode, range.Count, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(range.Offset), count);
}

void vtkNURBSGridIndices::Release()
{
  if (this->Buffer)
  {
    glDeleteBuffers(1, &this->Buffer);
    this->Buffer = 0;
  }
}
