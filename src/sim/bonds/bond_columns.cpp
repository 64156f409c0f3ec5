#include "sim/bonds/bond_columns.h"

namespace tsubu::sim {

namespace {
template <class Visit>
void eachPair(BondColumns& to, const BondColumns& from, Visit&& visit) {
  visit(to.i, from.i);
  visit(to.j, from.j);
  for (std::size_t c = 0; c < to.column.size(); ++c) visit(to.column[c], from.column[c]);
  visit(to.radius, from.radius);
  visit(to.length, from.length);
  visit(to.critical, from.critical);
  visit(to.bendCritical, from.bendCritical);
}
}  // namespace

void BondColumns::add(std::int32_t first, std::int32_t second, const BondBody& body, const BondMemory& memory) {
  i.push_back(first);
  j.push_back(second);
  const double values[columns] = {memory.shear.x, memory.shear.y, memory.shear.z, memory.turn.x, memory.turn.y, memory.turn.z, memory.rest};
  for (std::size_t c = 0; c < columns; ++c) column[c].push_back(values[c]);
  radius.push_back(body.radius);
  length.push_back(body.length);
  critical.push_back(static_cast<float>(body.critical));
  bendCritical.push_back(static_cast<float>(body.bendCritical));
}

void BondColumns::take(const BondColumns& from, std::size_t k) {
  eachPair(*this, from, [k](auto& to, const auto& values) { to.push_back(values[k]); });
}

void BondColumns::drop(const std::vector<char>& marked) {
  eachPair(*this, *this, [&marked](auto& values, const auto&) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < marked.size(); ++k)
      if (!marked[k]) values[kept++] = values[k];
    values.resize(kept);
  });
}

BondBody BondColumns::body(std::size_t k) const { return {radius[k], length[k], critical[k], bendCritical[k]}; }

BondMemory BondColumns::memory(std::size_t k) const {
  return {{at(shearX, k), at(shearY, k), at(shearZ, k)}, {at(turnX, k), at(turnY, k), at(turnZ, k)}, at(rest, k)};
}

}  // namespace tsubu::sim
