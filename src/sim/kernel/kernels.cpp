#include "sim/kernel/kernels.h"

#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/names.h"

namespace tsubu::sim {

extern const Kernels kernels_portable;
extern const Kernels kernels_avx2;
extern const Kernels kernels_avx512;

namespace {

#ifdef TSUBU_KERNEL_avx2
bool runsAvx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma"); }
#endif
#ifdef TSUBU_KERNEL_avx512
bool runsAvx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
}
#endif

}  // namespace

const std::vector<Kernels>& availableKernels() {
  static const std::vector<Kernels> available = [] {
    std::vector<Kernels> list{kernels_portable};
#ifdef TSUBU_KERNEL_avx2
    if (runsAvx2()) list.push_back(kernels_avx2);
#endif
#ifdef TSUBU_KERNEL_avx512
    if (runsAvx512()) list.push_back(kernels_avx512);
#endif
    return list;
  }();
  return available;
}

namespace {
const Kernels*& chosen() {
  static const Kernels* kernels = &availableKernels().back();
  return kernels;
}
}  // namespace

const Kernels& kernels() { return *chosen(); }

namespace {
template <class Kernel>
Chosen<Kernel> choose(Kernel (*Kernels::*pass)(std::size_t, PassKind), std::size_t law, PassKind kind) {
  const auto loopOf = kernels().*pass;
  if (const Kernel own = loopOf(law, kind)) return {own, kind.oneClass};
  return {loopOf(law, {.oneClass = false, .accounts = true}), false};
}
}  // namespace

template <>
Chosen<PairKernel> pairKernel<double>(std::size_t law, PassKind kind) {
  return choose(&Kernels::pairPass, law, kind);
}
template <>
Chosen<PairKernelIn<float>> pairKernel<float>(std::size_t law, PassKind kind) {
  return {kernels().singlePairPass(law, kind), kind.oneClass};
}
Chosen<WallKernel> wallKernel(std::size_t law, PassKind kind) { return choose(&Kernels::wallPass, law, kind); }

bool hasSingleKernel(std::size_t law) { return kernels_portable.singlePairPass(law, {true, false}) != nullptr; }

void useKernels(std::string_view isa) {
  std::vector<std::string> known;
  for (const Kernels& candidate : availableKernels()) {
    if (candidate.isa == isa) {
      chosen() = &candidate;
      return;
    }
    known.emplace_back(candidate.isa);
  }
  throw Error(ErrorKind::scene, fmt::format("Instruction set '{}' is not to be had here: expected {}.", isa, listNames(known)));
}

}  // namespace tsubu::sim
