// SPDX-License-Identifier: BSD-3-Clause
/// @file InnerPoint.h
/// @brief A point well inside a trimmed face: where its label or mark stands.
#pragma once

#include "Model.h"

#include <optional>

namespace nurbs
{

/// Parameters (u, v) of a point that the face's trims leave over, far from them: of a grid of samples
/// on the box of the loops, the one with the most samples around it that are inside; of equals the one
/// nearest to the middle of the box. The grid gets finer, up to 255 x 255, until a sample is inside.
/// None for a face without a control net, and where no sample is inside. Throws what FaceTrim throws.
std::optional<Vec2> InnerPoint(const Model& model, std::int64_t face);

} // namespace nurbs
