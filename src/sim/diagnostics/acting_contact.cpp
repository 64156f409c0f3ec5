#include "sim/diagnostics/acting_contact.h"

#include <algorithm>

namespace tsubu::sim {

template <class Real>
ActingContact contactIn(const StageIn<Real>& s, int q, std::int32_t first, std::int32_t second, bool rolls) {
  const Real distance = s.radiusSum[q] - s.overlap[q];
  const Vec3 along(s.dx[q], s.dy[q], s.dz[q]);  // with friction the kernel has left the direction here, otherwise the branch
  return {first, second, distance * along.normalized(), Vec3(s.fx[q], s.fy[q], s.fz[q]),
          rolls ? Vec3(s.mx[q], s.my[q], s.mz[q]) : Vec3(Vec3::Zero())};
}

template <class Real>
void passNoting(PairKernelIn<Real> kernel, const PassContext& context, const PairRangeIn<Real>& range, bool rolls, StageIn<Real>& stage,
                Accounts& accounts, std::vector<ActingContact>& acting) {
  for (std::int64_t first = 0; first < range.count; first += chunkSize) {
    PairRangeIn<Real> chunk = range;
    chunk.i += first, chunk.j += first, chunk.memory += first;
    if (chunk.touch) chunk.touch += first;
    chunk.count = std::min<std::int64_t>(chunkSize, range.count - first);
    kernel(context, chunk, stage, accounts);
    for (int q = 0; q < static_cast<int>(chunk.count); ++q)
      if (stage.overlap[q] > 0) acting.push_back(contactIn(stage, q, chunk.i[q], chunk.j[q], rolls));
  }
}

template ActingContact contactIn(const StageIn<double>&, int, std::int32_t, std::int32_t, bool);
template void passNoting(PairKernelIn<double>, const PassContext&, const PairRangeIn<double>&, bool, StageIn<double>&, Accounts&,
                         std::vector<ActingContact>&);
template void passNoting(PairKernelIn<float>, const PassContext&, const PairRangeIn<float>&, bool, StageIn<float>&, Accounts&,
                         std::vector<ActingContact>&);

}  // namespace tsubu::sim
