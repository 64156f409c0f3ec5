#pragma once
// The inner loops, compiled once for each instruction set and chosen when the program starts. All give the same bits. Contacts,
// bonds, and what knows no law (grain_kernels.h) are translation units of their own: a change of the last two compiles in seconds.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sim/bonds/bond_columns.h"
#include "sim/grain_rows.h"
#include "sim/kernel/stage.h"
#include "sim/laws/contact.h"
#include "sim/scheme.h"

namespace tsubu::sim {

struct GrainKernels;

/// A run of listed pairs (i < j) with their memory: component c of contact k at memory[c * stride + k].
template <class Real>
struct PairRangeIn {
  const std::int32_t* i;
  const std::int32_t* j;
  std::int64_t count;
  Real* memory;
  std::size_t stride;
  const double* touch = nullptr;  ///< m: distance of the centres at which a pair begins to touch; 0 for r_i + r_j. Null: so for all
};

/// A contact with a wall as it is put on the bench, in the world.
struct alignas(32) WallContactRow {
  double dx, dy, dz, unused0;  ///< m: from the wall to the centre of the grain
  double vx, vy, vz;           ///< m/s: of the wall where they touch
  double inverseMass;          ///< 1/kg: of the wall
  double wx, wy, wz, unused1;  ///< rad/s: of the wall
};

/// Contacts with walls. Their weights and classes lie in the stage already.
struct WallRange {
  const std::int32_t* grain;
  const WallContactRow* rows;
  int count;  ///< no more than a chunk
  double* memory;
  const std::int32_t* at;  ///< memory of contact k: from memory[at[k] * stateSize] on
};

/// What a pass needs beyond the contacts themselves.
struct PassContext {
  const GrainRow* rows;
  ForceRow* forces;
  const SingleRow* single;        ///< mixed precision: what contacts between grains read instead; null otherwise
  SingleForceRow* singleForces;   ///< and where the forces of all contacts go
  const std::uint16_t* material;  ///< per grain
  std::size_t materials;
  const double* pairs;  ///< constants of materials × materials, or of the one class
  StepOf step;
  bool observed = false;  ///< tell how deep contacts are and, with accounts, what springs store
  bool prefetch = false;  ///< the grains are more than the cache holds: ask for partners ahead of time
};

/// Which variant of the loops: one class of pairs or several; with accounts of what is dissipated or without.
struct PassKind {
  bool oneClass;
  bool accounts;
};

/// Adds the forces of a range of pairs to the force rows; `Real`: what the contacts are computed in.
template <class Real>
using PairKernelIn = void (*)(const PassContext&, const PairRangeIn<Real>&, StageIn<Real>&, Accounts&);
using PairKernel = PairKernelIn<double>;
/// Adds the forces of contacts with walls to the force rows; they stay in the stage.
using WallKernel = void (*)(const PassContext&, const WallRange&, Stage&, Accounts&);

/// The loops for one instruction set; nullptr where there is none for a law and kind (see `hasLoop` in passes.h).
struct Kernels {
  std::string_view isa;
  PairKernel (*pairPass)(std::size_t law, PassKind kind);
  PairKernelIn<float> (*singlePairPass)(std::size_t law, PassKind kind);
  WallKernel (*wallPass)(std::size_t law, PassKind kind);
  BondKernel (*bonds)(BondPassKind);  ///< all of them
  const GrainKernels* grains;         ///< those that know no law
};

/// A loop and how it wants its constants.
template <class Kernel>
struct Chosen {
  Kernel kernel;
  bool oneClass;
};
/// The loop to use. Laws that are not common have only one, for several classes and with accounts.
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
