// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSFrameRate
 * @brief   how much a mapper leaves out so that pictures come quickly while the camera moves
 *
 * Economy is a number: 0 draws all. Up to 1, pixels take the triangles' points instead of looking for
 * their own; above, tiles are drawn by Economy - 1 levels coarser than they are evaluated, with all
 * values between levels. It changes by at most a quarter a frame, so that nothing jumps, and is 0 as
 * soon as the window asks for no more than a frame now and then. Private to vtkNURBSMapper.
 */
#ifndef vtkNURBSFrameRate_h
#define vtkNURBSFrameRate_h

class vtkNURBSFrameRate
{
public:
  /// Decides for a frame. asked: frames a second that the window wants; wanted: those that the mapper
  /// is to give then (0: draw all, always); seconds: what the last frame took to draw (ignored unless it was measured).
  void Decide(double asked, double wanted, double seconds);

  /// Whether the next Decide wants to know what this frame takes.
  bool IsMeasuring() const { return this->Measuring; }
  bool LooksForPoints() const { return this->Economy == 0.0; }
  double GetCoarserLevels() const { return this->Economy > 1.0 ? this->Economy - 1.0 : 0.0; }

private:
  double Economy = 0.0;
  bool Measuring = false;
};

#endif
