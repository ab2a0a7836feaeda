// SPDX-License-Identifier: BSD-3-Clause
// A user's program with the kernels alone.
#include "Tessellator.h"

#include <cstdio>

int main()
{
  nurbs::TessellatorOptions options;
  options.Tolerance = 1e-3;
  const nurbs::TessellationResult result = nurbs::Tessellate(nurbs::Model(), {}, options);
  std::printf("%zu faces\n", result.Meshes.size());
  return result.Meshes.empty() ? 0 : 1;
}
