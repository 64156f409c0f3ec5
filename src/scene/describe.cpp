#include "scene/describe.h"

#include <algorithm>

#include "scene/alternatives.h"
#include "sim/laws/catalogue.h"

namespace tsubu::scene {

namespace {

using namespace dimension;

void describeSimulation(Form& form, Simulation& s) {
  static constexpr Choice integrators[] = {
      {"symplectic_euler", "Velocity first, then position with the new velocity: first order."},
      {"velocity_verlet", "Half a kick, drift, half a kick; dashpots see velocities carried on: second order."},
      {"explicit_euler", "Both from the old values: first order, gains energy in every step (to see why it is not used)."},
      {"leapfrog", "Velocities at half steps, which contacts see: second order, first with dashpots."},
      {"central_differences", "Positions from the last two (Störmer): the path of leapfrog, with more rounding."},
      {"rk4", "Runge–Kutta: fourth order where contacts are smooth, four evaluations per step."}};
  static constexpr Choice precisions[] = {
      {"double", "Everything in double precision."},
      {"mixed", "Contacts between grains in single precision, from differences of places in double; all else in double."}};
  static constexpr Choice limits[] = {
      {"packing", "What a packing of the smallest grains bears, known before any contact is; one step for the whole run."},
      {"spectral", "What the live network of contacts and bonds bears, from its stiffest mode; steps follow it through the run."}};
  static constexpr Choice axes[] = {{"x", {}}, {"y", {}}, {"z", {}}};
  static constexpr Choice violations[] = {{"stop", "End the run with a sentence that says which grain, where, when and why."},
                                          {"warn", "Say it once and go on."}};
  form.quantity(required("end", "Simulated time at which the run ends."), s.end, time, positive);
  form.vector({"gravity", "Acceleration of gravity."}, s.gravity, acceleration);
  words(form, {"integrator", "How velocities and positions are advanced."}, s.integrator, integrators);
  words(form,
        {"precision", "What is computed in which numbers: contacts in single precision take less time (docs/tradeoff.md tells the error)."},
        s.precision, precisions);
  form.quantityOrAuto({"time_step", "\"auto\": the safety factor times the stability limit."}, s.timeStep, time, positive);
  words(form, {"limit", "What the automatic time step is a share of."}, s.limit, limits);
  form.quantity({"safety", "The automatic time step as a share of the stability limit."}, s.safety, number, {0, 1, false, false});
  form.integer({"seed", "Another seed gives other random numbers, and nothing else."}, s.seed, 0, std::numeric_limits<std::int64_t>::max());
  bool present = s.domain.has_value();
  sim::BoxRegion domain = s.domain.value_or(sim::BoxRegion{});
  form.optionalTable(
      {"domain", "Grains that leave this box are lost, or go on at its other end. Absent: a wide box around all that is there."}, present,
      [&](Form& f) {
        describeBox(f, domain);
        f.someWords({"periodic",
                     "Directions in which the box repeats itself: what leaves through one face comes in through the opposite "
                     "one. Walls are not repeated: let them go on beyond the box."},
                    s.periodic, axes);
      });
  s.domain = present ? std::optional(domain) : std::nullopt;
  form.quantityOrAuto({"skin", "How much farther than contact neighbours are listed. \"auto\": from the radii."}, s.skin, length, positive);
  form.boolean({"ledger", "Keep the energy ledger."}, s.ledger);
  form.boolean({"continuous",
                "Grains that go farther than travel_limit in a step are swept against others and walls, and meet them as hard spheres; "
                "otherwise that is a violation."},
               s.continuous);
  words(form, {"on_violation", "What happens when a grain overlaps too deeply or moves too far in a step."}, s.onViolation, violations);
  form.quantity({"overlap_limit", "Deepest overlap allowed, in radii of the smaller grain."}, s.overlapLimit, number, {0, 1, false, false});
  form.quantity({"travel_limit", "Longest way allowed in one step, in radii."}, s.travelLimit, number, {0, 1, false, false});
}

std::string& lawOf(sim::ContactChoice& choice, std::string_view family) { return const_cast<std::string&>(sim::chosenIn(choice, family)); }

void describeContact(Form& form, sim::ContactChoice& choice) {
  for (const sim::LawFamily& family : sim::lawFamilies()) {
    std::vector<Choice> choices;
    std::size_t index = 0;
    std::string& name = lawOf(choice, family.key);
    for (const sim::LawInfo& law : family.laws) {
      if (law.name == name) index = choices.size();
      choices.push_back({law.name, law.sentence});
    }
    const std::string sentence = fmt::format("The {} law.", family.key);
    form.word({family.key, sentence}, index, choices);
    if (index != noneOfThem) name = choices[index].word;
  }
  form.boolean({"tension", "May the normal force pull at the end of a contact, as a plain dashpot does?"}, choice.tension);
  form.boolean(
      {"rotation",
       "Do grains turn, where friction would turn them? Held, they slide and stick and do not roll: to see what rotation is worth."},
      choice.rotation);
  form.boolean({"rescale", "Does a Mindlin spring relax when its stiffness falls? Without, it creates energy (for comparison)."},
               choice.rescale);
}

void describeProperties(Form& form, Properties& properties, sim::Scope scope) {
  for (const sim::PropertyInfo& info : sim::propertyTable()) {
    if (info.scope != scope) continue;
    form.optionalQuantity({info.key, info.sentence}, properties[info.property], dimensionOf(info.unit), between(info.lower, info.upper));
  }
  for (const sim::PropertyInfo& info : sim::propertyTable()) {
    if (info.scope == scope) continue;
    form.misplaced(info.key, scope == sim::Scope::material
                                 ? "It belongs to a pair of materials: write it in [pairs], or in [pairs.a.b] for two."
                                 : "It belongs to one material: write it in [materials.name].");
  }
}

void describeMaterial(Form& form, Material& material) {
  describeProperties(form, material.properties, sim::Scope::material);
  form.optionalColour({"colour", "Of grains of this material, \"#rrggbb\". Absent: from the palette."}, material.colour);
}

// [pairs.first.second]: tables by the first name, and in each tables by the second.
struct Second {
  std::string name;
  Properties properties;
};
struct First {
  std::string name;
  std::vector<Second> seconds;
};

void describeFirst(Form& form, First& first) {
  for (const sim::PropertyInfo& info : sim::propertyTable()) form.misplaced(info.key, "Name the other material as well: [pairs.a.b].");
  Entries seconds =
      namedEntries(first.seconds, [](Form& f, Second& second) { describeProperties(f, second.properties, sim::Scope::pair); });
  seconds.open = true;
  form.others({"second", "Properties of two materials that meet, whichever is named first. They override those of all pairs."}, seconds);
}

void describeSpecialPairs(Form& form, std::vector<Pair>& special) {
  std::vector<First> firsts;
  for (Pair& pair : special) {
    auto first = std::find_if(firsts.begin(), firsts.end(), [&](const First& f) { return f.name == pair.first; });
    if (first == firsts.end()) first = firsts.insert(first, {pair.first, {}});
    first->seconds.push_back({pair.second, pair.properties});
  }
  Entries entries = namedEntries(firsts, describeFirst);
  entries.open = true;
  form.others({"first", "A material."}, entries);
  special.clear();
  for (const First& first : firsts) {
    for (const Second& second : first.seconds) special.push_back({first.name, second.name, second.properties});
  }
}

void describeOutput(Form& form, Output& output) {
  form.quantity({"fps", "Frames per second of the film."}, output.fps, frequency, positive);
  form.optionalQuantity({"slow_motion", "Seconds of film per simulated second; 1 when nothing is said."}, output.slowMotion, number,
                        positive);
  form.optionalQuantity({"frame_interval", "Simulated time from frame to frame: instead of slow_motion."}, output.frameInterval, time,
                        positive);
  form.quantityOrAuto({"ledger_interval",
                       "Simulated time between rows of the ledger, a whole number of frame intervals or a whole part of one. "
                       "\"auto\": with every frame."},
                      output.ledgerInterval, time, positive);
}

}  // namespace

void describeBox(Form& form, sim::BoxRegion& box) {
  form.vector(required("min", "The corner with the smallest coordinates."), box.min, length, VectorRule::mayBeInfinite);
  form.vector(required("max", "The corner with the largest coordinates."), box.max, length, VectorRule::mayBeInfinite);
}

void describeRegion(Form& form, sim::Region& region) {
  static constexpr Choice keys[] = {{"box", "An axis-aligned box."}, {"cylinder", "A cylinder from base to top."}};
  struct Each {
    Form& form;
    void operator()(sim::BoxRegion& box) const {
      form.table({keys[0].word, keys[0].sentence}, [&](Form& f) { describeBox(f, box); });
    }
    void operator()(sim::CylinderRegion& cylinder) const {
      form.table({keys[1].word, keys[1].sentence}, [&](Form& f) {
        f.vector(required("base", "Centre of one end."), cylinder.base, length);
        f.vector(required("top", "Centre of the other end."), cylinder.top, length);
        f.quantity(required("radius", "Radius of the cylinder."), cylinder.radius, length, positive);
      });
    }
  };
  byKey(form, region.shape, keys, true, Each{form});
}

void describe(Form& form, Scene& scene) {
  form.text({"title", "What the film shows, in a few words."}, scene.title);
  form.table(required("simulation", "What is computed, and for how long."), [&](Form& f) { describeSimulation(f, scene.simulation); });
  form.table({"contact", "The laws by which grains touch."}, [&](Form& f) { describeContact(f, scene.contact); });
  form.table(required("materials", "What grains and walls are made of."), [&](Form& f) {
    f.others({"name", "A material."}, namedEntries(scene.materials, describeMaterial));
  });
  form.table(required("pairs", "What happens between materials that touch: here for all pairs, grains with walls included."), [&](Form& f) {
    describeProperties(f, scene.pairs.all, sim::Scope::pair);
    describeSpecialPairs(f, scene.pairs.special);
  });
  describeGrains(form, scene);
  describeWalls(form, scene);
  describeBonds(form, scene);
  describeFields(form, scene);
  form.table({"output", "When frames and rows of the ledger are written."}, [&](Form& f) { describeOutput(f, scene.output); });
  describeDiagnostics(form, scene);
  describeObserve(form, scene);
  describePicture(form, scene);
}

}  // namespace tsubu::scene
