// SPDX-License-Identifier: BSD-3-Clause
// A user's program with the kernels alone.
#include "Tessellator.h"
#include "WaveletModel.h"

#include <cstdio>

int main()
{
  nurbs::TessellatorOptions options;
  options.Tolerance = 1e-3;
  const nurbs::TessellationResult result = nurbs::Tessellate(nurbs::Model(), {}, options);
  std::printf("%zu faces\n", result.Meshes.size());
  nurbs::WaveletOptions levels;
  levels.Finest.Tolerance = 1e-3;
  const nurbs::WaveletModel model(nurbs::Model(), {}, levels);
  return result.Meshes.empty() && model.Levels() == 1 ? 0 : 1;
}
