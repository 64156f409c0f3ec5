#include "sim/bonds/bond_columns.h"

namespace tsubu::sim {

void BondColumns::add(std::int32_t first, std::int32_t second, const BondBody& body, const BondMemory& memory) {
  i.push_back(first);
  j.push_back(second);
  const double values[columns] = {memory.shear.x, memory.shear.y, memory.shear.z,   memory.turn.x, memory.turn.y,
                                  memory.turn.z,  memory.rest,    body.along,       body.bend,     body.radius,
                                  body.length,    body.critical,  body.bendCritical};
  for (std::size_t c = 0; c < columns; ++c) column[c].push_back(values[c]);
}

void BondColumns::take(const BondColumns& from, std::size_t k) {
  i.push_back(from.i[k]);
  j.push_back(from.j[k]);
  for (std::size_t c = 0; c < columns; ++c) column[c].push_back(from.column[c][k]);
}

void BondColumns::drop(const std::vector<char>& marked) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < size(); ++k) {
    if (marked[k]) continue;
    i[kept] = i[k];
    j[kept] = j[k];
    for (auto& values : column) values[kept] = values[k];
    ++kept;
  }
  i.resize(kept);
  j.resize(kept);
  for (auto& values : column) values.resize(kept);
}

BondBody BondColumns::body(std::size_t k) const {
  return {at(radius, k), at(springAlong, k), at(springBend, k), at(length, k), at(critical, k), at(bendCritical, k)};
}

BondMemory BondColumns::memory(std::size_t k) const {
  return {{at(shearX, k), at(shearY, k), at(shearZ, k)}, {at(turnX, k), at(turnY, k), at(turnZ, k)}, at(rest, k)};
}

}  // namespace tsubu::sim
