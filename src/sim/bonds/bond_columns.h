#pragma once
// The bonds of one slab, column by column, and what the kernels need to walk them.

#include <array>
#include <cstdint>
#include <vector>

#include "core/line_vector.h"
#include "sim/bonds/bond_law.h"
#include "sim/grain_rows.h"

namespace tsubu::sim {

inline constexpr int bondChunk = 64;

/// What does not change of bonds. Where it is the same for all, as for grains of one size, its first chunk stands for every chunk and stays
/// in the cache.
template <class Number>
class BodyColumn {
 public:
  void push_back(Number value) {
    values_.push_back(value);
    alike_ = alike_ && value == values_.front();
  }
  void resize(std::size_t count) { values_.resize(count); }
  Number operator[](std::size_t k) const { return values_[k]; }
  Number& operator[](std::size_t k) { return values_[k]; }
  /// Of the chunk that begins with this bond.
  const Number* chunk(std::size_t first) const { return values_.data() + (alike_ ? 0 : first); }

 private:
  LineVector<Number> values_;
  bool alike_ = true;
};

/// Everything about bonds between grains that lies along the list. The ends are places of grains, the lower id first.
struct BondColumns {
  enum Name { shearX, shearY, shearZ, turnX, turnY, turnZ, rest, columns };

  std::vector<std::int32_t> i, j;
  std::array<LineVector<double>, columns> column;
  BodyColumn<double> radius, length;
  BodyColumn<float> critical, bendCritical;  ///< single: more digits than anybody knows of a damping

  std::size_t size() const { return i.size(); }
  double at(Name name, std::size_t k) const { return column[name][k]; }

  void add(std::int32_t first, std::int32_t second, const BondBody& body, const BondMemory& memory);
  /// Appends bond k of another list.
  void take(const BondColumns& from, std::size_t k);
  /// Keeps the bonds that are not marked, in their order.
  void drop(const std::vector<char>& marked);

  BondBody body(std::size_t k) const;
  BondMemory memory(std::size_t k) const;
};

/// The bench of a chunk of bonds: see Stage. Three columns for a vector.
struct alignas(64) BondStage {
  using Column = double[bondChunk];
  /// Difference of the velocities, and of each end r ω and 1/r.
  struct Motion {
    Column velocity[3], surfaceI[3], perRadiusI, surfaceJ[3], perRadiusJ;
  };

  // In.
  Column d[3], radiusSum;
  Motion half, now;  // `now` only when something is damped and the rows do not have the velocities of the half step

  // On the way: see BondPath.
  Column r, perRadiusSum, n[3], sheared[3], turned[3], rotation[3], scale;
  Column critical, bendCritical;  // which are kept as single numbers

  // Out: force on i, and the couples Q of both ends, moments included (T = −r Q).
  Column force[3], coupleI[3], coupleJ[3];
  Column loss, relaxed, broken;
};

/// The ends of bonds as rows: of grains, or of the places on a wall where bonds are fixed.
struct BondRows {
  const GrainRow* rows;
  const HalfStepRow* half;  ///< null but in velocity Verlet: the rows have the velocities of the half step
  ForceRow* forces;
};

/// What a pass over the bonds of one slab finds. Sums in eight lanes, as in Accounts.
struct BondFindings {
  double loss[8] = {};     ///< J: taken by dampers in this step
  double relaxed[8] = {};  ///< J: taken by relaxation since the step before
  std::vector<std::int32_t> broken;
  double released = 0;  ///< J: what the springs of those held half a step ago, when they last pulled

  static double sum(const double* lanes) {
    double total = 0;
    for (int l = 0; l < 8; ++l) total += lanes[l];
    return total;
  }
};

/// Which variant of the loop: what bonds do beside their springs, and with accounts of what dampers and relaxation take, or without.
struct BondPassKind {
  BondDamping damping;
  bool breakable;
  bool accounts;
};

/// Advances all bonds of a list by a step and adds their forces to the rows of both ends. Bonds that break do nothing any more and are
/// named in `found.broken`; they are still in the list.
using BondKernel = void (*)(const BondKind&, BondColumns&, const BondRows& first, const BondRows& second, double dt, BondStage&,
                            BondFindings& found);

}  // namespace tsubu::sim
