#pragma once
// What a crowd of grains does, in numbers (docs/physics.md, D1–D6): contacts and force chains, motion, stress; of a region as a whole and
// on a grid. Pure functions of an Instant.

#include <array>
#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "sim/diagnostics/instant.h"

namespace tsubu::sim {

/// D1, D2. A grain counts where its centre is, a contact where it touches.
struct ContactSurvey {
  static constexpr std::size_t most = 12;

  std::size_t betweenGrains = 0, withWalls = 0;
  double coordination = 0;                        ///< contacts per grain, walls included
  double withoutRattlers = 0;                     ///< the same of grains that have two at least
  std::size_t rattlers = 0;                       ///< grains with at most one contact
  std::array<std::size_t, most + 1> histogram{};  ///< grains with k contacts; the last: with `most` or more
  double meanForce = 0, largestForce = 0;         ///< N: normal forces
  double shareAboveMean = 0;                      ///< of the contacts: those of the force chains
  double loadAboveMean = 0;                       ///< of the sum of normal forces: what these carry
};

/// D3. Grains whose centre is in the region.
struct MotionSurvey {
  std::size_t grains = 0;
  double mass = 0;                   ///< kg
  Vec3 bulkVelocity = Vec3::Zero();  ///< m/s: of the centre of mass
  double temperature = 0;            ///< m²/s²: Σ m|v − V|²/(3 Σ m)
  double rotationTemperature = 0;    ///< m²/s²: Σ I|ω|²/(3 Σ m)
};

/// D4, Pa; compression is positive.
struct StressSurvey {
  double volume = 0;            ///< m³
  Mat3 contact = Mat3::Zero();  ///< Σ f ⊗ l/V
  Mat3 kinetic = Mat3::Zero();  ///< Σ m (v − V) ⊗ (v − V)/V

  Mat3 total() const { return contact + kinetic; }
  double pressure() const { return total().trace() / 3; }
};

struct Survey {
  ContactSurvey contacts;
  MotionSurvey motion;
  StressSurvey stress;
  double solidFraction = 0;  ///< D5
};

/// The smallest box around all grains, the domain where that is periodic; empty without grains.
Box boxAround(const Instant& instant);

/// Of the grains in a finite box, which lies in the domain where that is periodic.
Survey survey(const Instant& instant, const Box& region);

/// N and N m: what grains do to each wall, the torque about the origin of the world.
struct WallSurvey {
  std::size_t contacts = 0;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};
std::vector<WallSurvey> surveyWalls(const Instant& instant, std::size_t walls);

/// A box cut into equal cells.
struct Grid {
  Box box;
  std::array<int, 3> cells{1, 1, 1};

  std::size_t count() const {
    return static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(cells[2]);
  }
  Vec3 size() const { return box.sizes().cwiseQuotient(Vec3(cells[0], cells[1], cells[2])); }
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(cells[2]) +
           static_cast<std::size_t>(k);
  }
  Box cell(int i, int j, int k) const;
};

struct CellSurvey {
  double solidFraction = 0;
  MotionSurvey motion;
  StressSurvey stress;
};

/// One entry for each cell, in the order of Grid::index.
std::vector<CellSurvey> survey(const Instant& instant, const Grid& grid);

}  // namespace tsubu::sim
