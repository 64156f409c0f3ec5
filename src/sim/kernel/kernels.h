#pragma once
// The inner loops, compiled once for each instruction set and chosen when the program starts. All give the same bits. Those that know no
// law are a translation unit of their own (grain_kernels.h): a change of them compiles in seconds, one of the laws' takes minutes.

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

/// The loops for one instruction set; nullptr where it has none of its own for a law and kind.
struct Kernels {
  std::string_view isa;
  PairKernel (*pairPass)(std::size_t law, PassKind kind);
  PairKernelIn<float> (*singlePairPass)(std::size_t law, PassKind kind);
  WallKernel (*wallPass)(std::size_t law, PassKind kind);
  BondKernel (*bonds)(BondDamping, bool breakable);       ///< all of them
  const GrainKernels* grains;                             ///< those that know no law
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
