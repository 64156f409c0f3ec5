#include "sim/laws/catalogue.h"

#include <cstring>

#include <fmt/format.h>

#include "core/error.h"
#include "core/names.h"
#include "sim/model.h"

namespace tsubu::sim {

namespace {

template <class List>
std::vector<LawInfo> describe() {
  std::vector<LawInfo> infos;
  forEachType(List{}, [&]<class Law>() { infos.push_back({Law::name, Law::sentence, {Law::reads.begin(), Law::reads.end()}}); });
  return infos;
}

std::size_t indexIn(const LawFamily& family, const std::string& name) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < family.laws.size(); ++i) {
    if (family.laws[i].name == name) return i;
    known.emplace_back(family.laws[i].name);
  }
  const auto nearest = nearestName(name, known);
  throw Error(ErrorKind::scene, fmt::format("Unknown {} law '{}': expected {}.", family.key, name, listNames(known)),
              nearest ? fmt::format("did you mean '{}'?", *nearest) : std::string());
}

// Structs of doubles and the doubles in them.
template <class T>
T fromDoubles(const double* from) {
  T value{};
  if constexpr (!std::is_empty_v<T>) std::memcpy(&value, from, sizeof(T));
  return value;
}

template <class Law>
struct AsFunctions {
  using Pair = typename Law::Pair;
  using Memory = typename Law::Memory;
  static_assert(numbersIn<Memory> == Law::stateSize && Law::stateSize <= mostMemory);

  static void prepare(const PairValues& values, bool tension, bool rescales, double* constants) {
    const Pair pair = Law::prepare(values, tension, rescales);
    std::memcpy(constants, &pair, sizeof(Pair));
  }
  static ContactForce evaluate(const double* constants, const Contact& contact, StepOf step, double* memory, ContactEnergy& energy) {
    const Pair pair = fromDoubles<Pair>(constants);
    Memory held = fromDoubles<Memory>(memory);
    Law::carry(contact.n, contact.frameAngle, held);
    const ContactForce force = Law::template evaluate<true>(pair, contact, step, held, energy);
    if constexpr (Law::stateSize > 0) std::memcpy(memory, &held, sizeof(Memory));
    return force;
  }
  static double stored(const double* constants, const Contact& contact, StepOf step, const double* memory) {
    const Pair pair = fromDoubles<Pair>(constants);
    const Memory held = fromDoubles<Memory>(memory);
    const double stiffness = Law::Normal::force(pair.normal, contact, step).stiffness;
    return Law::storedTangential(pair, held) + Law::storedRolling(pair, contact, stiffness, held);
  }
  static std::array<ContactMode, 4> modes(const double* constants, double overlap, double effectiveRadius, double inverseMass) {
    const Pair pair = fromDoubles<Pair>(constants);
    const double stiffness = Law::Normal::stiffness(pair.normal, overlap, effectiveRadius);
    const double damping = Law::Normal::damping(pair.normal, 1 / inverseMass, stiffness);
    return {ContactMode{stiffness * inverseMass, damping * inverseMass},
            Law::Tangential::mode(pair.tangential, stiffness, damping, inverseMass),
            Law::Rolling::mode(pair.rolling, stiffness, inverseMass), Law::Twisting::mode(pair.twisting, stiffness, inverseMass)};
  }
};

template <class Law>
LawFunctions functionsOf() {
  LawFunctions f{};
  f.names[0] = Law::Normal::name, f.names[1] = Law::Tangential::name, f.names[2] = Law::Rolling::name, f.names[3] = Law::Twisting::name;
  f.objection = objection<Law>;
  if constexpr (objection<Law>.empty()) {
    using F = AsFunctions<Law>;
    f.traits = {Law::stateSize,           Law::tangentialSize,         Law::rollingSize, Law::odd, Law::turns, Law::rolls, Law::readsRadius,
                Law::Tangential::passive, Law::Tangential::withinLimit};
    f.constants = static_cast<std::size_t>(numbersIn<typename Law::Pair>);
    f.prepare = &F::prepare, f.evaluate = &F::evaluate, f.stored = &F::stored, f.modes = &F::modes;
  }
  return f;
}

}  // namespace

const std::vector<LawFamily>& lawFamilies() {
  static const std::vector<LawFamily> families{{"normal", describe<NormalLaws>()},
                                               {"tangential", describe<TangentialLaws>()},
                                               {"rolling", describe<RollingLaws>()},
                                               {"twisting", describe<TwistingLaws>()}};
  return families;
}

const std::string& chosenIn(const ContactChoice& choice, std::string_view family) {
  return family == "normal"       ? choice.normal
         : family == "tangential" ? choice.tangential
         : family == "rolling"    ? choice.rolling
                                  : choice.twisting;
}

std::vector<Reading> readings(const ContactChoice& choice) {
  bool growing = false;
  forEachType(NormalLaws{}, [&]<class Normal>() { growing = growing || (Normal::growing && choice.normal == Normal::name); });
  std::vector<Reading> result;
  for (const LawFamily& family : lawFamilies()) {
    for (const LawInfo& law : family.laws) {
      if (law.name != chosenIn(choice, family.key)) continue;
      for (const Need need : law.reads) result.push_back({family.key, law.name, sharpened(need, growing)});
    }
  }
  return result;
}

std::size_t lawIndex(const ContactChoice& choice) {
  std::size_t index = 0;
  for (const LawFamily& family : lawFamilies()) index = index * family.laws.size() + indexIn(family, chosenIn(choice, family.key));
  const LawFunctions& law = lawFunctions(index);
  if (!law.objection.empty()) {
    throw Error(ErrorKind::scene,
                fmt::format("The laws {}, {}, {} and {} (normal, tangential, rolling, twisting) make no sense together: {}.", law.names[0],
                            law.names[1], law.names[2], law.names[3], law.objection));
  }
  return index;
}

const LawFunctions& lawFunctions(std::size_t law) {
  static const auto table = tableOf(ContactLaws{}, []<class Law>() { return functionsOf<Law>(); });
  return table[law];
}

std::size_t lawCount() { return ContactLaws::size; }

}  // namespace tsubu::sim
