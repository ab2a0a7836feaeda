// SPDX-License-Identifier: BSD-3-Clause
#include "GLB.h"

#include "Failure.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>

namespace nurbs
{
namespace
{

// sRGB to the linear light that glTF's colour factors are in (IEC 61966-2-1).
double Linear(unsigned char value)
{
  const double c = value / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

class Writer
{
public:
  explicit Writer(const GLBMesh& mesh)
    : Mesh(mesh)
    , LocalIndex(mesh.PointCount, 0)
    , Stamp(mesh.PointCount, -1)
  {
    this->Model.asset.version = "2.0";
    this->Model.asset.generator = "vtkNURBS";
    this->Model.buffers.resize(1);
  }

  const tinygltf::Model& Build()
  {
    const std::vector<std::vector<std::size_t>> triangles = this->TrianglesOfLooks();
    tinygltf::Node root;
    root.name = "model";
    root.scale.assign(3, this->Mesh.Metres);
    root.rotation = { -std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5) };
    this->Model.nodes.push_back(root);
    std::map<std::string, int> meshes;
    for (std::size_t look = 0; look < triangles.size(); ++look)
    {
      if (triangles[look].empty())
      {
        continue;
      }
      const auto& appearance = this->Mesh.Looks[look];
      const auto [named, fresh] =
        meshes.emplace(appearance.Name, static_cast<int>(this->Model.meshes.size()));
      if (fresh)
      {
        this->AddNode(appearance.Name);
      }
      tinygltf::Primitive primitive = this->MakePrimitive(triangles[look], static_cast<int>(look));
      primitive.material = this->Material(appearance.Colour);
      this->Model.meshes[static_cast<std::size_t>(named->second)].primitives.push_back(primitive);
    }
    tinygltf::Scene scene;
    scene.nodes = { 0 };
    this->Model.scenes.push_back(scene);
    this->Model.defaultScene = 0;
    return this->Model;
  }

private:
  const GLBMesh& Mesh;
  tinygltf::Model Model;
  std::vector<std::uint32_t> LocalIndex; // of a point, in the look that its stamp names
  std::vector<int> Stamp;
  std::map<GLBColour, int> Materials;

  std::vector<std::vector<std::size_t>> TrianglesOfLooks() const
  {
    std::vector<std::vector<std::size_t>> triangles(this->Mesh.Looks.size());
    for (std::size_t t = 0; t < this->Mesh.TriangleCount; ++t)
    {
      triangles[static_cast<std::size_t>(this->Mesh.Look[t])].push_back(t);
    }
    return triangles;
  }

  void AddNode(const std::string& name)
  {
    tinygltf::Mesh mesh;
    mesh.name = name;
    tinygltf::Node node;
    node.name = name;
    node.mesh = static_cast<int>(this->Model.meshes.size());
    this->Model.meshes.push_back(mesh);
    this->Model.nodes[0].children.push_back(static_cast<int>(this->Model.nodes.size()));
    this->Model.nodes.push_back(node);
  }

  int Material(const GLBColour& colour)
  {
    const auto [found, fresh] =
      this->Materials.emplace(colour, static_cast<int>(this->Model.materials.size()));
    if (fresh)
    {
      char name[8];
      std::snprintf(name, sizeof(name), "#%02x%02x%02x", colour[0], colour[1], colour[2]);
      tinygltf::Material material;
      material.name = name;
      material.doubleSided = true;
      material.pbrMetallicRoughness.baseColorFactor = { Linear(colour[0]), Linear(colour[1]),
        Linear(colour[2]), 1.0 };
      material.pbrMetallicRoughness.metallicFactor = 0.0;
      material.pbrMetallicRoughness.roughnessFactor = 0.5;
      this->Model.materials.push_back(material);
    }
    return found->second;
  }

  tinygltf::Primitive MakePrimitive(const std::vector<std::size_t>& triangles, int look)
  {
    std::vector<std::uint32_t> indices;
    std::vector<std::size_t> points;
    indices.reserve(3 * triangles.size());
    for (const std::size_t t : triangles)
    {
      for (int corner = 0; corner < 3; ++corner)
      {
        const auto p = static_cast<std::size_t>(this->Mesh.Triangles[3 * t + corner]);
        if (this->Stamp[p] != look)
        {
          this->Stamp[p] = look;
          this->LocalIndex[p] = static_cast<std::uint32_t>(points.size());
          points.push_back(p);
        }
        indices.push_back(this->LocalIndex[p]);
      }
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] = this->Vectors(this->Mesh.Points, points, true);
    if (this->Mesh.Normals)
    {
      primitive.attributes["NORMAL"] = this->Vectors(this->Mesh.Normals, points, false);
    }
    primitive.indices = this->Accessor(indices, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
      TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, indices.size());
    return primitive;
  }

  int Vectors(const double* values, const std::vector<std::size_t>& points, bool bounds)
  {
    std::vector<float> floats;
    floats.reserve(3 * points.size());
    std::vector<double> low(3, std::numeric_limits<double>::max());
    std::vector<double> high(3, std::numeric_limits<double>::lowest());
    for (const std::size_t p : points)
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        floats.push_back(static_cast<float>(values[3 * p + c]));
        low[c] = std::min(low[c], static_cast<double>(floats.back()));
        high[c] = std::max(high[c], static_cast<double>(floats.back()));
      }
    }
    const int accessor = this->Accessor(floats, TINYGLTF_TARGET_ARRAY_BUFFER,
      TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, points.size());
    if (bounds)
    {
      this->Model.accessors.back().minValues = low;
      this->Model.accessors.back().maxValues = high;
    }
    return accessor;
  }

  // Append to the buffer, whose every element has four bytes and so stays aligned.
  template <typename Value>
  int Accessor(
    const std::vector<Value>& values, int target, int component, int type, std::size_t count)
  {
    std::vector<unsigned char>& buffer = this->Model.buffers[0].data;
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = values.size() * sizeof(Value);
    view.target = target;
    buffer.insert(buffer.end(), bytes, bytes + view.byteLength);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(this->Model.bufferViews.size());
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    this->Model.bufferViews.push_back(view);
    this->Model.accessors.push_back(accessor);
    return static_cast<int>(this->Model.accessors.size()) - 1;
  }
};

} // namespace

//--------------------------------------------------------------------------------------------------
void WriteGLB(const GLBMesh& mesh, const std::string& path)
{
  const std::size_t bytes =
    mesh.TriangleCount * 12 + std::min(3 * mesh.TriangleCount, mesh.PointCount) * 24;
  if (bytes > std::numeric_limits<std::uint32_t>::max() / 10 * 9)
  {
    throw Failure("the mesh is too large for " + path + ": .glb holds less than 4 GiB");
  }
  Writer writer(mesh);
  const tinygltf::Model& model = writer.Build();
  std::ofstream file(path, std::ios::binary);
  tinygltf::TinyGLTF gltf;
  const bool written = file && gltf.WriteGltfSceneToStream(&model, file, false, true);
  file.close();
  if (!written || !file)
  {
    throw Failure("cannot write " + path);
  }
}

} // namespace nurbs
