#pragma once
// THE list of contact laws. A law is a header beside this one, a test that mirrors it, and its name in one of the four lists below.
// The lists feed the scene reader and its messages, the reference page, the kernels, the law contract and the benchmarks.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sim/laws/constant_rolling.h"
#include "sim/laws/contact_law.h"
#include "sim/laws/elastic_plastic_rolling.h"
#include "sim/laws/hertz_normal.h"
#include "sim/laws/linear_normal.h"
#include "sim/laws/projected_friction.h"
#include "sim/laws/rolling.h"
#include "sim/laws/spring_friction.h"
#include "sim/laws/tangential.h"
#include "sim/laws/twisting.h"
#include "sim/laws/type_list.h"
#include "sim/laws/viscous_friction.h"
#include "sim/laws/viscous_rolling.h"

namespace tsubu::sim {

using NormalLaws = TypeList<LinearNormal, HertzNormal>;
using TangentialLaws = TypeList<Frictionless, SpringFriction, MindlinFriction, ViscousFriction, FrozenSpringFriction, LudingSpringFriction,
                                LimitedSpringFriction, MindlinDisplacementFriction, ProjectedFriction>;
using RollingLaws = TypeList<FreeRolling, ElasticPlasticRolling, ConstantRolling, ViscousRolling>;
using TwistingLaws = TypeList<FreeTwisting, SpringTwisting>;

/// Every combination, in the order of the lists.
using ContactLaws = Combinations<ContactLaw, NormalLaws, TangentialLaws, RollingLaws, TwistingLaws>;

/// Why a combination makes no sense; empty when it does.
template <class Law>
inline constexpr std::string_view objection =
    !Law::Tangential::acts && Law::rolls ? "grains without friction never turn"
    : Law::Tangential::needsGrowing && !Law::Normal::growing
        ? "Mindlin's spring follows the stiffness of a Hertz contact; the linear contact has the spring for it"
        : std::string_view();

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

/// The families with their laws, in the order of evaluation.
const std::vector<LawFamily>& lawFamilies();

struct ContactChoice;

/// The name that a choice gives for a family.
const std::string& chosenIn(const ContactChoice& choice, std::string_view family);

/// A law of a choice, and what it needs of every pair that can meet.
struct Reading {
  std::string_view family, law;
  Need need;
};
std::vector<Reading> readings(const ContactChoice& choice);

/// Index of the chosen combination in ContactLaws. Throws Error(scene) with the known names, or the reason why it makes no sense.
std::size_t lawIndex(const ContactChoice& choice);

/// What must be known of a law without its type.
struct LawTraits {
  int stateSize;                    ///< doubles of memory per contact
  int tangentialSize, rollingSize;  ///< of these, in this order; the rest resists twisting
  unsigned odd;                     ///< components that change sign when i and j change places, as bits
  bool turns, rolls, readsRadius;
  bool passive;      ///< never gives more energy than it got
  bool withinLimit;  ///< friction stays within Coulomb's limit
};

/// A law as plain functions of one contact: for observers, for the time step, for tests. The kernels use the type.
struct LawFunctions {
  std::string_view names[4];   ///< in the order of the families
  std::string_view objection;  ///< empty when the combination makes sense; nothing below is to be called otherwise
  LawTraits traits;
  std::size_t constants;  ///< doubles in Law::Pair
  void (*prepare)(const PairValues& values, bool tension, bool rescales, double* constants);
  /// One evaluation; `memory` (stateSize doubles) is brought up to date.
  ContactForce (*evaluate)(const double* constants, const Contact& contact, StepOf step, double* memory, ContactEnergy& energy);
  /// J: what the memory holds.
  double (*stored)(const double* constants, const Contact& contact, StepOf step, const double* memory);
  /// How a contact can swing: along the normal, across it, rolling, twisting. At an overlap (m) of grains with R* (m) and 1/m* (1/kg).
  std::array<ContactMode, 4> (*modes)(const double* constants, double overlap, double effectiveRadius, double inverseMass);
};
const LawFunctions& lawFunctions(std::size_t law);
std::size_t lawCount();

}  // namespace tsubu::sim
