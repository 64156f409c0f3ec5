#pragma once
// From materials to the constants that laws use.

#include <array>
#include <vector>

#include "sim/laws/catalogue.h"
#include "sim/model.h"

namespace tsubu::sim {

/// Which pairs of materials can meet: grains and streams with each other and with walls. materials × materials.
std::vector<char> pairsThatMeet(const Model& model);

/// Law::Pair of every pair of materials, row by row, as doubles. Pairs that never meet have zeros.
struct PairConstants {
  std::size_t size = 0;  ///< doubles of one pair
  std::vector<double> values;
  const double* of(std::size_t pair) const { return values.data() + pair * size; }
};

/// Throws Error(scene) that names law, pair and property when a pair that can meet lacks what the law reads.
PairConstants preparePairs(const Model& model, std::size_t law);

/// One kind of contacts, between grains or with walls: when all its pairs have the same constants (materials that differ in density or
/// colour only), kernels need not look them up.
struct PairClass {
  bool alike;
  std::size_t first;  ///< of the pairs that can meet, as a place in the table
};
struct PairClasses {
  PairClass grains, walls;
};
PairClasses classesOfPairs(const Model& model, const PairConstants& constants);

}  // namespace tsubu::sim
