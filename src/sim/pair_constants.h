#pragma once
// From materials to the constants that laws use, and what else must be known of a law without its type.

#include <array>
#include <vector>

#include "sim/laws/contact.h"
#include "sim/model.h"

namespace tsubu::sim {

struct LawTraits {
  int stateSize;  ///< doubles of memory per contact
  bool turns, rolls;
};
LawTraits lawTraits(std::size_t law);

/// Which pairs of materials can meet: grains and streams with each other and with walls. materials × materials.
std::vector<char> pairsThatMeet(const Model& model);

/// \brief Law::Pair for every pair of materials, row by row, as bytes.
/// Throws Error(scene) that names law, pair and property when a pair that can meet lacks what the law reads.
std::vector<unsigned char> preparePairs(const Model& model, std::size_t law);

/// One kind of contacts, between grains or with walls: when all its pairs have the same constants (materials that differ in density or
/// colour only), kernels need not look them up.
struct PairClass {
  bool alike;
  std::size_t first;  ///< of the pairs that can meet, as a place in the table
};
struct PairClasses {
  PairClass grains, walls;
};
PairClasses classesOfPairs(const Model& model, const std::vector<unsigned char>& pairConstants);

/// How one contact of a pair of materials can swing: along the normal, across it, rolling. `inverseMass`: 1/m_a + 1/m_b, 1/kg.
std::array<ContactMode, 3> contactModes(const Model& model, std::size_t law, std::size_t a, std::size_t b, double inverseMass);

}  // namespace tsubu::sim
