#pragma once
// What is measured of many grains, as pure functions (docs/physics.md, D7–D10).

#include <cstdint>
#include <span>
#include <vector>

#include "core/snapshot.h"
#include "core/vec.h"

namespace tsubu::study {

/// D7. Lacey's index of the grains marked in `kind` in cubic cells with this edge (m), weighted by the grains of a cell so that cells cut
/// by the surface do no harm: 0 when every cell is pure, 1 in the mean for grains mixed at random. NaN without two kinds.
double mixingIndex(std::span<const Vec3> positions, std::span<const char> kind, double cell);

/// D8. rad: the slope of a conical heap around the axis through `point` along `up` (any length): a straight line through the height of the
/// surface (the highest resting grain in each square of two diameters) against the distance from the axis, from 0.2 to 0.8 of the radius of
/// the heap. `gravity` in m/s²: a grain that is faster than (g d)^½/10 does not rest. NaN when there is no such surface.
double angleOfRepose(const Snapshot& snapshot, const Vec3& point, const Vec3& up, double gravity);

/// D9. m: the coordinate along `direction` (any length) that this share of the grains do not exceed; 1: the largest. NaN without grains.
double front(std::span<const Vec3> positions, const Vec3& direction, double share);

/// D10. Slope of the straight line through (x, y) of least squares; NaN with fewer than two places.
double slope(std::span<const double> x, std::span<const double> y);

/// The first x at which y rises to `level`, between two samples on the straight line; NaN when it never does.
double firstReach(std::span<const double> x, std::span<const double> y, double level);

}  // namespace tsubu::study
