#pragma once
// The inner loops, compiled once for each instruction set and chosen when the program starts. All give the same bits.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "sim/bonds/bond_columns.h"
#include "sim/grain_rows.h"
#include "sim/kernel/stage.h"
#include "sim/laws/contact.h"
#include "sim/scheme.h"

namespace tsubu::sim {

/// A run of listed pairs (i < j) with their memory: component c of contact k at memory[c * stride + k].
struct PairRange {
  const std::int32_t* i;
  const std::int32_t* j;
  std::int64_t count;
  double* memory;
  std::size_t stride;
  const double* touch = nullptr;  ///< m: distance of the centres at which a pair begins to touch; 0 for r_i + r_j. Null: so for all
};

/// What a pass needs beyond the contacts themselves.
struct PassContext {
  const GrainRow* rows;
  ForceRow* forces;
  const std::uint16_t* material;  ///< per grain
  std::size_t materials;
  const double* pairs;            ///< constants of materials × materials, or of the one class
  StepOf step;
  bool observed = false;          ///< tell how deep contacts are and, with accounts, what springs store
  bool prefetch = false;          ///< the grains are more than the cache holds: ask for partners ahead of time
};

/// Which variant of the loops: one class of pairs or several; with accounts of what is dissipated or without.
struct PassKind {
  bool oneClass;
  bool accounts;
};

/// Adds the forces of a range of pairs to the force rows; `Real`: what the contacts are computed in.
template <class Real>
using PairKernelIn = void (*)(const PassContext&, const PairRange&, StageIn<Real>&, Accounts&);
using PairKernel = PairKernelIn<double>;
/// Computes `count` wall contacts that lie in the stage, memory included.
using WallKernel = void (*)(const PassContext&, int count, Stage&, Accounts&);

/// The columns of the state that moving grains reads and writes; null where the scheme or the scene has none.
struct MoveContext {
  GrainRow* rows;
  ForceRow* forces;
  HalfStepRow* half;
  PlaceRow* previous;
  AngleRow* turned;
  V3 gravity;  ///< m/s²
  double dt;   ///< s
};

/// What a pass over grains finds.
struct Motion {
  double fastest2 = 0;  ///< (m/s)²: the largest squared speed
  double travel2 = 0;   ///< largest (distance moved in the step / radius)²; NaN counts as infinite

  /// A grain goes with the square of this speed; `scale`: Δt/r.
  TSUBU_INLINE void add(double speed2, double scale) {
    const double way2 = speed2 * scale * scale;
    fastest2 = speed2 > fastest2 ? speed2 : fastest2;
    if (!(way2 <= travel2)) travel2 = way2 == way2 ? way2 : std::numeric_limits<double>::infinity();
  }
};

/// Moves grains [first, last) by one step (docs/physics.md, I1–I6) and clears their forces.
using MoveKernel = Motion (*)(const MoveContext&, std::int32_t first, std::int32_t last);

/// Which of `count` pairs are nearer than the sum of their radii and the skin (m): their places, in order. `kept` has room for `count`
/// rounded up to a multiple of four. Returns how many.
using NearKernel = std::int64_t (*)(const GrainRow* rows, const std::int32_t* i, const std::int32_t* j, std::int64_t count, double skin,
                                    std::int32_t* kept);

/// The loops for one instruction set; nullptr where it has none of its own for a law and kind.
struct Kernels {
  std::string_view isa;
  PairKernel (*pairPass)(std::size_t law, PassKind kind);
  PairKernelIn<float> (*singlePairPass)(std::size_t law, PassKind kind);
  WallKernel (*wallPass)(std::size_t law, PassKind kind);
  BondKernel (*bonds)(BondDamping, bool breakable);       ///< all of them
  MoveKernel (*move)(Integrator scheme, bool turns);      ///< all but Runge–Kutta
  NearKernel nearPairs;
};

/// A loop and how it wants its constants.
template <class Kernel>
struct Chosen {
  Kernel kernel;
  bool oneClass;
};
/// The loop to use. Laws that are not common have only one, portable and for several classes.
template <class Real>
Chosen<PairKernelIn<Real>> pairKernel(std::size_t law, PassKind kind);
Chosen<WallKernel> wallKernel(std::size_t law, PassKind kind);

/// Has the law loops in single precision? Laws that are not common have none.
bool hasSingleKernel(std::size_t law);

/// The kernels that this processor can run, the portable ones first, the widest last.
const std::vector<Kernels>& availableKernels();

/// The kernels in use: the widest, unless `useKernels` said otherwise.
const Kernels& kernels();

/// Forces one instruction set by name ("portable", "avx2", "avx512"). Throws Error(scene) when this processor or build has no such.
void useKernels(std::string_view isa);

}  // namespace tsubu::sim
