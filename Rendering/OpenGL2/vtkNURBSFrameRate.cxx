// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFrameRate.h"

#include <algorithm>
#include <cmath>

void vtkNURBSFrameRate::Decide(double asked, double wanted, double seconds)
{
  // An interactor asks for 0.0001 frames a second when nothing moves.
  constexpr double Still = 0.1;
  constexpr double Most = 1.0 + 1.5; // triangles are off by 8 times as much then
  const bool measured = this->Measuring;
  this->Measuring = wanted > 0.0 && asked > Still;
  if (!this->Measuring)
  {
    this->Economy = 0.0;
    return;
  }
  if (!measured)
  {
    return;
  }
  const double excess = seconds * wanted; // over 1: too slow
  if (this->Economy < 1.0)
  {
    // Looking for points is worth several levels: done or not, without steps in between.
    this->Economy = excess > 1.0 ? 1.0 : 0.0;
    return;
  }
  // Vertices fall to a quarter a level; some slack, so that it does not swing to and fro.
  const double change = 0.5 * std::log2(excess);
  if (excess > 1.0 || excess < 0.5)
  {
    this->Economy += std::min(std::max(change, -0.25), 0.25);
  }
  this->Economy = std::min(std::max(this->Economy, 1.0), Most);
}
