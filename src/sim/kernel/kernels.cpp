#include "sim/kernel/kernels.h"

#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/names.h"

namespace tsubu::sim {

extern const Kernels kernels_portable;
#ifdef TSUBU_X86
extern const Kernels kernels_avx2;
extern const Kernels kernels_avx512;
#endif

const std::vector<Kernels>& availableKernels() {
  static const std::vector<Kernels> available = [] {
    std::vector<Kernels> list{kernels_portable};
#ifdef TSUBU_X86
    __builtin_cpu_init();
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
    if (avx2) list.push_back(kernels_avx2);
    if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd"))
      list.push_back(kernels_avx512);
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
