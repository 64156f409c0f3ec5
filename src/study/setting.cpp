#include "study/setting.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/names.h"
#include "sim/laws/catalogue.h"

namespace tsubu::study {

namespace {

std::string pathTo(std::initializer_list<std::string> keys) {
  std::string path;
  for (const std::string& key : keys) {
    const bool plain = std::all_of(key.begin(), key.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
    path += (path.empty() ? "" : ".") + (plain ? key : "\"" + key + "\"");
  }
  return path;
}

std::string number(double value) { return fmt::format("{:.10g}", value); }

/// Collects overrides of a scene.
class Writer {
 public:
  Writer(const scene::Scene& scene, std::string normalLaw) : scene_(scene), normalLaw_(std::move(normalLaw)) {}

  void set(std::initializer_list<std::string> keys, const std::string& value) { overrides_.push_back(pathTo(keys) + "=" + value); }
  void set(std::initializer_list<std::string> keys, double value) { set(keys, number(value)); }

  // Springs of all pairs, or the moduli of all materials; what the contact law does not read is left alone.
  void scaleStiffness(double factor) {
    std::size_t before = overrides_.size();
    if (normalLaw_ == "hertz") {
      for (const scene::Material& material : scene_.materials)
        scaleIn({"materials", material.name}, material.properties, sim::Property::youngModulus, factor);
    } else {
      scaleIn({"pairs"}, scene_.pairs.all, sim::Property::normalStiffness, factor);
      for (const scene::Pair& pair : scene_.pairs.special)
        scaleIn({"pairs", pair.first, pair.second}, pair.properties, sim::Property::normalStiffness, factor);
    }
    scaleIn({"pairs"}, scene_.pairs.all, sim::Property::tangentialStiffness, factor);
    for (const scene::Pair& pair : scene_.pairs.special)
      scaleIn({"pairs", pair.first, pair.second}, pair.properties, sim::Property::tangentialStiffness, factor);
    if (overrides_.size() == before) throw Error(ErrorKind::scene, "the scene gives no stiffness that could be scaled");
  }

  void coarsen(double factor) {
    if (!scene_.bonds.empty()) throw Error(ErrorKind::scene, "bonds belong to the places of their grains");
    for (const scene::GrainSource& source : scene_.grains) coarsen(source, factor);
    // The same modulus: a spring stands for the area that a grain has to carry, over its length. With Hertz it is so by itself.
    if (normalLaw_ != "hertz") stiffness *= factor;
  }

  void makeEqual() {
    std::size_t before = overrides_.size();
    for (const scene::GrainSource& source : scene_.grains) {
      if (std::holds_alternative<scene::FromFile>(source.from) || std::holds_alternative<sim::ConstantRadius>(source.radii.kind)) continue;
      set({"grains", source.name, "radius"}, std::cbrt(source.radii.meanCube()));
    }
    if (overrides_.size() == before) throw Error(ErrorKind::scene, "the grains of each source are alike already");
  }

  double stiffness = 1;  ///< factor that coarser grains bring

  scene::Overrides take() { return std::move(overrides_); }

 private:
  void scaleIn(std::initializer_list<std::string> table, const scene::Properties& properties, sim::Property property, double factor) {
    if (!properties[property]) return;
    std::string path = pathTo(table) + "." + std::string(sim::infoOf(property).key);
    overrides_.push_back(path + "=" + number(*properties[property] * factor));
  }

  void coarsen(const scene::GrainSource& source, double factor) {
    struct Each {
      Writer& writer;
      const scene::GrainSource& source;
      double factor;
      double fewer() const { return 1 / (factor * factor * factor); }
      void count(const char* key, std::uint64_t count) const {
        const auto left = std::llround(static_cast<double>(count) * fewer());
        if (left < 1) throw Error(ErrorKind::scene, fmt::format("of the source '{}' no grain would be left", source.name));
        writer.set({"grains", source.name, key}, fmt::format("{}", left));
      }
      void operator()(const scene::Packing& packing) const {
        if (const auto* by = std::get_if<scene::ByCount>(&packing.amount)) count("count", by->grains);
      }
      void operator()(const scene::Lattice& lattice) const {
        if (lattice.spacing) writer.set({"grains", source.name, "spacing"}, *lattice.spacing * factor);
      }
      void operator()(const scene::Inlet& inlet) const {
        if (inlet.rateKind == scene::RateKind::number) writer.set({"grains", source.name, "rate"}, inlet.rate * fewer());
        if (inlet.count) count("count", *inlet.count);
      }
      void operator()(const scene::FromFile&) const {
        throw Error(ErrorKind::scene, fmt::format("the grains of '{}' come from a file", source.name));
      }
      void operator()(const scene::Listed&) const {
        throw Error(ErrorKind::scene, fmt::format("the grains of '{}' have given places", source.name));
      }
    };
    std::visit(Each{*this, source, factor}, source.from);
    std::visit([&](const auto& radii) { scaleRadii(source, radii, factor); }, source.radii.kind);
  }

  void scaleRadii(const scene::GrainSource& source, const sim::ConstantRadius& r, double factor) {
    set({"grains", source.name, "radius"}, r.radius * factor);
  }
  void scaleRadii(const scene::GrainSource& source, const sim::UniformRadius& r, double factor) {
    set({"grains", source.name, "radius", "min"}, r.min * factor);
    set({"grains", source.name, "radius", "max"}, r.max * factor);
  }
  void scaleRadii(const scene::GrainSource& source, const sim::NormalRadius& r, double factor) {
    scaleRadii(source, sim::UniformRadius{r.min, r.max}, factor);
    set({"grains", source.name, "radius", "mean"}, r.mean * factor);
    set({"grains", source.name, "radius", "deviation"}, r.deviation * factor);
  }
  void scaleRadii(const scene::GrainSource& source, const sim::RadiusTable& r, double factor) {
    std::string list;
    for (const double radius : r.radii) list += (list.empty() ? "" : ", ") + number(radius * factor);
    set({"grains", source.name, "radius", "radii"}, "[" + list + "]");
  }

  const scene::Scene& scene_;
  std::string normalLaw_;
  scene::Overrides overrides_;
};

double smallestRadius(const scene::Scene& scene) {
  double smallest = scene::forever;
  for (const scene::GrainSource& source : scene.grains)
    if (!std::holds_alternative<scene::FromFile>(source.from)) smallest = std::min(smallest, source.radii.smallest());
  if (!std::isfinite(smallest)) throw Error(ErrorKind::scene, "the radii of the grains are in a file");
  return smallest;
}

// Evaluations of forces in a step.
double evaluations(const std::string& integrator) { return integrator == "rk4" ? 4 : 1; }

std::string nameOf(sim::Integrator integrator) {
  using I = sim::Integrator;
  switch (integrator) {
    case I::symplecticEuler:
      return "symplectic_euler";
    case I::explicitEuler:
      return "explicit_euler";
    case I::leapfrog:
      return "leapfrog";
    case I::centralDifferences:
      return "central_differences";
    case I::rungeKutta:
      return "rk4";
    case I::velocityVerlet:
      break;
  }
  return "velocity_verlet";
}

std::string nameOf(sim::Precision precision) { return precision == sim::Precision::mixed ? "mixed" : "double"; }

// Laws of a family other than the scene's, and other than none at all: that is a matter of features.
std::vector<std::string> othersIn(std::string_view family, const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const sim::LawFamily& f : sim::lawFamilies())
    for (const sim::LawInfo& law : f.laws)
      if (f.key == family && law.name != "none" && law.name != sim::chosenIn(scene.contact, family)) names.emplace_back(law.name);
  return names;
}

template <class Make>
Axis byNumber(std::string name, std::string unit, std::initializer_list<double> values, Make make) {
  Axis axis{std::move(name), std::move(unit), {}};
  for (const double value : values) axis.places.push_back({value, make(value)});
  return axis;
}

template <class Make>
Axis byName(std::string name, const std::vector<std::string>& words, Make make) {
  Axis axis{std::move(name), {}, {}};
  for (const std::string& word : words) axis.places.push_back({static_cast<double>(axis.places.size() + 1), make(word)});
  return axis;
}

}  // namespace

scene::Overrides overridesOf(const Setting& setting, const scene::Scene& scene) {
  Writer writer(scene, setting.normal.value_or(scene.contact.normal));
  if (setting.safety) {
    if (scene.simulation.timeStep) writer.set({"simulation", "time_step"}, "auto");
    writer.set({"simulation", "safety"}, *setting.safety);
  }
  if (setting.timeStep) writer.set({"simulation", "time_step"}, *setting.timeStep);
  if (setting.integrator) writer.set({"simulation", "integrator"}, *setting.integrator);
  const std::pair<const char*, const std::optional<std::string>*> laws[] = {
      {"normal", &setting.normal}, {"tangential", &setting.tangential}, {"rolling", &setting.rolling}, {"twisting", &setting.twisting}};
  for (const auto& [family, law] : laws)
    if (*law) writer.set({"contact", family}, **law);
  // A dashpot of no given strength is as strong as a step allows (T10).
  if (setting.tangential == "viscous" && !scene.pairs.all[sim::Property::tangentialDampingRate])
    writer.set({"pairs", std::string(sim::infoOf(sim::Property::tangentialDampingRate).key)}, 1e9);
  if (setting.tension) writer.set({"contact", "tension"}, *setting.tension ? "true" : "false");
  if (setting.precision) writer.set({"simulation", "precision"}, nameOf(*setting.precision));
  if (setting.rotation) writer.set({"contact", "rotation"}, *setting.rotation ? "true" : "false");
  if (setting.coarsening != 1) writer.coarsen(setting.coarsening);
  if (setting.softening * writer.stiffness != 1) writer.scaleStiffness(setting.softening * writer.stiffness);
  if (setting.skin) writer.set({"simulation", "skin"}, *setting.skin * setting.coarsening * smallestRadius(scene));
  if (setting.equalGrains) writer.makeEqual();
  return writer.take();
}

std::string labelOf(const Setting& s) {
  std::string label;
  const auto add = [&label](const std::string& text) { label += (label.empty() ? "" : ", ") + text; };
  if (s.safety) add(fmt::format("step {:.3g}", *s.safety));
  if (s.integrator) add(*s.integrator);
  if (s.softening != 1)
    add(s.softening < 1 ? fmt::format("stiffness / {:.3g}", 1 / s.softening) : fmt::format("stiffness x {:.3g}", s.softening));
  if (s.coarsening != 1) add(fmt::format("grains / {:.3g}", std::pow(s.coarsening, 3)));
  if (s.normal) add(*s.normal);
  if (s.tangential) add(*s.tangential == "none" ? "no friction" : *s.tangential);
  if (s.rolling && !(s.tangential == "none")) add(*s.rolling == "none" ? "no rolling resistance" : *s.rolling + " rolling");
  if (s.twisting && !(s.tangential == "none")) add(*s.twisting == "none" ? "no twisting resistance" : *s.twisting + " twisting");
  if (s.tension) add(*s.tension ? "tension" : "no tension");
  if (s.rotation) add(*s.rotation ? "rotation" : "no rotation");
  if (s.precision) add(nameOf(*s.precision) + " precision");
  if (s.skin) add(fmt::format("skin {:.3g} r", *s.skin));
  if (s.equalGrains) add("equal grains");
  return label;
}

double costFactor(const Setting& s, const scene::Scene& scene, double base) {
  double factor = std::sqrt(s.softening) / std::pow(s.coarsening, 4);  // fewer grains, and their contacts last longer
  if (s.safety) factor *= base / *s.safety;
  if (s.integrator) factor *= evaluations(*s.integrator) / evaluations(nameOf(scene.simulation.integrator));
  return factor;
}

const std::vector<std::string>& axisNames() {
  static const std::vector<std::string> names{"step", "stiffness", "integrator", "grains", "law", "memory", "rolling", "precision", "skin"};
  return names;
}

Axis axisOf(const std::string& name, const scene::Scene& scene) {
  const auto with = [](auto member) {
    return [member](const auto& value) {
      Setting setting;
      setting.*member = value;
      return setting;
    };
  };
  if (name == "step") return byNumber(name, "share of the stability limit", {0.1, 0.3, 0.5, 0.7, 0.9}, with(&Setting::safety));
  if (name == "stiffness") return byNumber(name, "softening factor", {1.0 / 3, 0.1, 0.03, 0.01}, with(&Setting::softening));
  if (name == "grains") return byNumber(name, "factor on the radii", {std::cbrt(2.0), std::cbrt(4.0)}, with(&Setting::coarsening));
  if (name == "skin") return byNumber(name, "smallest radii", {0.1, 0.3, 0.6}, with(&Setting::skin));
  if (name == "integrator") {
    std::vector<std::string> others{"rk4", "velocity_verlet", "leapfrog", "symplectic_euler"};
    std::erase(others, nameOf(scene.simulation.integrator));
    return byName(name, others, with(&Setting::integrator));
  }
  if (name == "law") return byName(name, othersIn("normal", scene), with(&Setting::normal));
  if (name == "memory") return byName(name, othersIn("tangential", scene), with(&Setting::tangential));
  if (name == "rolling") return byName(name, othersIn("rolling", scene), with(&Setting::rolling));
  if (name == "precision") {
    const bool mixed = scene.simulation.precision == sim::Precision::mixed;
    return {name, {}, {{1, with(&Setting::precision)(mixed ? sim::Precision::full : sim::Precision::mixed)}}};
  }
  std::vector<std::string> known = axisNames();
  known.emplace_back("picture");
  const auto nearest = nearestName(name, known);
  throw Error(ErrorKind::scene, fmt::format("There is no axis '{}': expected {}.", name, listNames(known)),
              nearest ? fmt::format("did you mean '{}'?", *nearest) : std::string());
}

std::vector<Feature> featuresOf(const scene::Scene& scene) {
  std::vector<Feature> features;
  const sim::ContactChoice& contact = scene.contact;
  const auto unless = [](bool there, const char* what) { return there ? std::string() : fmt::format("the scene does not model {}", what); };
  const bool rubs = contact.tangential != "none";
  Setting smooth;
  smooth.tangential = smooth.rolling = smooth.twisting = "none";
  features.push_back({"friction", smooth, unless(rubs, "it")});
  Setting rolling, twisting, memory, tension, equal;
  rolling.rolling = "none";
  features.push_back({"rolling resistance", rolling, unless(contact.rolling != "none", "it")});
  twisting.twisting = "none";
  features.push_back({"twisting resistance", twisting, unless(contact.twisting != "none", "it")});
  memory.tangential = "viscous";
  features.push_back({"memory of contacts", memory, unless(rubs && contact.tangential != "viscous", "any")});
  // Without rotation nothing rolls or twists, and what resists that goes with it.
  Setting held;
  held.rotation = false;
  if (contact.rolling != "none") held.rolling = "none";
  if (contact.twisting != "none") held.twisting = "none";
  const bool lasting = scene.magnets && std::any_of(scene.materials.begin(), scene.materials.end(), [](const scene::Material& m) {
                         return m.properties[sim::Property::magnetisation].has_value();
                       });
  features.push_back({"rotation", held,
                      !scene.bonds.empty() ? "bonds bend and twist"
                      : lasting            ? "lasting magnets turn"
                                           : unless(rubs && contact.rotation, "it")});
  tension.tension = !contact.tension;
  features.push_back({contact.tension ? "tension" : "one-sided contacts", tension, {}});
  equal.equalGrains = true;
  features.push_back({"sizes of grains", equal, {}});
  return features;
}

Setting combined(const Setting& first, const Setting& second) {
  Setting both = first;
  if (second.safety) both.safety = second.safety;
  if (second.timeStep) both.timeStep = second.timeStep;
  if (second.integrator) both.integrator = second.integrator;
  if (second.normal) both.normal = second.normal;
  if (second.tangential) both.tangential = second.tangential;
  if (second.rolling) both.rolling = second.rolling;
  if (second.twisting) both.twisting = second.twisting;
  if (second.tension) both.tension = second.tension;
  if (second.rotation) both.rotation = second.rotation;
  if (second.precision) both.precision = second.precision;
  if (second.skin) both.skin = second.skin;
  both.softening *= second.softening;
  both.coarsening *= second.coarsening;
  both.equalGrains = both.equalGrains || second.equalGrains;
  return both;
}

}  // namespace tsubu::study
