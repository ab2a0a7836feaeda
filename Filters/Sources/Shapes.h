// SPDX-License-Identifier: BSD-3-Clause
/// @file Shapes.h
/// @brief Exact analytic shapes, models of papers and two loads for scale tests, as trimmed models.
///
/// Every function appends to a builder. Edges that faces share have one index, a seam is one edge
/// used twice, a pole is an edge of degree 0, and all 3D curves are exact (their tolerance is
/// rounding: 1e-12 of the shape's size) unless a function says otherwise. Outsides agree: the
/// closed shapes' normals point outwards (see Face::Reversed). Sizes are lengths and must be
/// positive; otherwise Error is thrown and names the value.
#pragma once

#include "ModelBuilder.h"

namespace nurbs
{

/// A sphere around the origin: one biquadratic face with poles at +-z and a seam at +x.
void AddSphere(ModelBuilder& builder, double radius);

/// A torus around the z axis: one biquadratic face; its seams meet at (radius + tube, 0, 0).
/// Requires tube < radius.
void AddTorus(ModelBuilder& builder, double radius, double tube);

/// A cylinder from z = 0 to `height` around the z axis, with a seam at +x. With `capped` it is a
/// closed solid: side, bottom, top; the caps are trimmed planes.
void AddCylinder(ModelBuilder& builder, double radius, double height, bool capped);

/// A cone with its base at z = 0 and its apex (a pole) at z = height. With `capped` it is a closed
/// solid: side, base.
void AddCone(ModelBuilder& builder, double radius, double height, bool capped);

/// A disc in the plane z = 0: a bilinear face trimmed by a circle.
void AddDisc(ModelBuilder& builder, double radius);

/// A plate [0, width] x [0, depth] at z = 0 with holesX x holesY holes, in turn round and square;
/// every third hole has a round island of material, and every second island a hole again (loops
/// nested four deep). One bilinear face. holesX and holesY are 0 to 10,000.
void AddPlate(ModelBuilder& builder, double width, double depth, int holesX, int holesY);

/// The exact area of the material of AddPlate.
double PlateArea(double width, double depth, int holesX, int holesY);

/// Newell's teapot, 32 bicubic patches (with the bottom that was added later), 6.5 units long.
/// Patches that touch share their edges; the ends of spout and handle and the rims are open.
void AddTeapot(ModelBuilder& builder);

/// A wavy sheet [0, size] x [0, size] of one face without loops, `waves` waves in each direction of
/// the height `amplitude` (control points). `points` and `degree`: control points and degree in u
/// and v; 1 <= degree <= MaxDegree, points > degree. Rational: with weights between 0.5 and 1.5.
struct SheetOptions
{
  int Points[2] = { 40, 40 };
  int Degree[2] = { 3, 3 };
  double Size = 100.0;
  double Amplitude = 5.0;
  int Waves = 3;
  bool Rational = false;
};
void AddSheet(ModelBuilder& builder, const SheetOptions& options);

/// A load like a car: `faces` bicubic C1 faces that tile a smooth body of about 4.4 m length (units:
/// mm), in the mean. All outer boundaries are edges shared by the neighbours (exact). About a third
/// of the faces has no hole, a third one to three, a tenth a fine pattern of 6 to 16; one fifth of
/// the faces are plugs that fill a hole of the face before them and share its edge. The 3D curves of
/// holes are cubic fits with their measured deviation as tolerance. The result depends on `faces`
/// only; time and memory are linear.
void AddCarBody(ModelBuilder& builder, std::int64_t faces);

/// @name The models of Ruan, Zhang and Yong (2006)
/// Closed solids of rational Bezier patches, one a face, of degree 3 at most, without further trims;
/// the axis is z, the base at z = 0 (spring: the wire's middle starts there). Units: mm.
///@{

/// A vase, 226 mm high, its wall and bottom of revolution, with two handles that are sweeps: 76
/// faces. A handle takes the place of two patches of the wall and shares their boundaries.
void AddVase(ModelBuilder& builder);

/// A missile, 180 mm long and 20 mm thick: conical tail, cylinders, tangent ogive of 40 mm, four tail
/// fins and four wings of 1.5 mm thickness: 88 faces.
void AddMissile(ModelBuilder& builder);

/// A spring of 5.5 turns, 10 mm in radius, of a round wire of 1.5 mm radius with half balls at its
/// ends, that rises 5 mm a turn: 88 + 8 = 96 faces. Sections across the wire are exact circles, their
/// planes exactly across the helix; their middles are up to 7.4e-4 mm above or below the helix.
void AddSpring(ModelBuilder& builder);
///@}

} // namespace nurbs
