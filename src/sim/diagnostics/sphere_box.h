#pragma once
// How much of a sphere lies in a box: in closed form, so that the parts in the cells of a grid add up to the sphere.

#include "core/vec.h"

namespace tsubu::sim {

/// \brief m³: the volume of the sphere within the box (D5). Corners may be infinite. Exact to rounding, about 1e-15 of the sphere.
double volumeWithin(const Box& box, const Vec3& centre, double radius);

/// Of the unit sphere, the volume where x ≥ a, y ≥ b and z ≥ c, for any a, b, c.
double volumeBeyond(double a, double b, double c);

}  // namespace tsubu::sim
