// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressBar.h"

#include <boost/timer/progress_display.hpp>
#include <unistd.h>

#include <algorithm>
#include <iostream>

namespace nurbs
{

struct ProgressBar::Display
{
  static constexpr unsigned long Steps = 1000;
  boost::timer::progress_display Stars{ Steps, std::cerr, "" };
};

//--------------------------------------------------------------------------------------------------
ProgressBar::ProgressBar(bool wanted)
  : Started(std::chrono::steady_clock::now())
  , Wanted(wanted && isatty(STDERR_FILENO) == 1)
{}

//--------------------------------------------------------------------------------------------------
ProgressBar::~ProgressBar()
{
  this->Clear();
}

//--------------------------------------------------------------------------------------------------
void ProgressBar::Phase(double begin, double end)
{
  this->Begin = begin;
  this->End = end;
  this->Set(0.0);
}

//--------------------------------------------------------------------------------------------------
void ProgressBar::Set(double fraction)
{
  if (!this->Wanted ||
    std::chrono::steady_clock::now() - this->Started < std::chrono::milliseconds(500))
  {
    return;
  }
  if (!this->Bar)
  {
    this->Bar = std::make_unique<Display>();
  }
  const double whole = this->Begin + (this->End - this->Begin) * std::clamp(fraction, 0.0, 1.0);
  // Not the last step: the display ends the line with it, and Clear counts on two lines.
  const auto wanted =
    std::min(static_cast<unsigned long>(whole * Display::Steps), Display::Steps - 1);
  if (wanted > this->Bar->Stars.count())
  {
    this->Bar->Stars += wanted - this->Bar->Stars.count();
  }
}

//--------------------------------------------------------------------------------------------------
void ProgressBar::Clear()
{
  if (this->Bar)
  {
    this->Bar.reset();
    std::cerr << "\r\033[2A\033[J" << std::flush; // up over the scale, then clear to the end
  }
}

} // namespace nurbs
