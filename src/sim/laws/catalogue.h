#pragma once
// THE list of contact laws. A law is a header beside this one, a test that mirrors it, and its name in one of the three lists below.
// The lists feed the scene reader and its messages, the reference page, the kernels, the law contract and the benchmarks.

#include <string>
#include <string_view>
#include <vector>

#include "sim/laws/constant_rolling.h"
#include "sim/laws/contact_law.h"
#include "sim/laws/elastic_plastic_rolling.h"
#include "sim/laws/linear_normal.h"
#include "sim/laws/rolling.h"
#include "sim/laws/spring_friction.h"
#include "sim/laws/tangential.h"
#include "sim/laws/type_list.h"

namespace tsubu::sim {

using NormalLaws = TypeList<LinearNormal>;
using TangentialLaws = TypeList<Frictionless, SpringFriction>;
using RollingLaws = TypeList<FreeRolling, ConstantRolling, ElasticPlasticRolling>;

/// Which combinations make sense: what does not turn cannot roll.
template <class Law>
inline constexpr bool makesSense = Law::Tangential::acts || !Law::Rolling::acts;

/// Every combination that makes sense, in the order of the lists.
using ContactLaws = Combinations<ContactLaw, NormalLaws, TangentialLaws, RollingLaws>;

/// A law in words.
struct LawInfo {
  std::string_view name;
  std::string_view sentence;
  std::vector<Need> reads;
};
struct LawFamily {
  std::string_view key;  ///< in the [contact] table of a scene
  std::vector<LawInfo> laws;
};

/// The three families with their laws, in the order of evaluation.
const std::vector<LawFamily>& lawFamilies();

struct ContactChoice;

/// Index of the chosen combination in ContactLaws. Throws Error(scene) with the known names, or the reason why it makes no sense.
std::size_t lawIndex(const ContactChoice& choice);

/// Calls `visitor.template operator()<Law>()` for the combination with this index: the run-time choice becomes a type, once per pass.
template <class Visitor>
decltype(auto) visitLaw(std::size_t index, Visitor&& visitor) {
  return visitType<ContactLaws>(index, visitor);
}

}  // namespace tsubu::sim
