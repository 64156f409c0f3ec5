#include "scene/alternatives.h"
#include "scene/describe.h"

namespace tsubu::scene {

namespace {

using namespace dimension;

constexpr std::uint64_t mostGrains = 100'000'000;

void describeSizes(Form& form, sim::SizeDistribution& radii) {
  static constexpr Choice keys[] = {{"min", "Uniform between min and max."},
                                    {"mean", "Normal, cut off at min and max."},
                                    {"radii", "A table of radii with their shares of the mass."}};
  using Spread = std::variant<sim::UniformRadius, sim::NormalRadius, sim::RadiusTable>;
  Spread spread;
  std::visit(
      [&spread]<class D>(const D& d) {
        if constexpr (!std::is_same_v<D, sim::ConstantRadius>) spread = d;
      },
      radii.kind);
  struct Each {
    Form& form;
    void operator()(sim::UniformRadius& d) const {
      form.quantity(required("min", "Smallest radius."), d.min, length, positive);
      form.quantity(required("max", "Largest radius."), d.max, length, positive);
    }
    void operator()(sim::NormalRadius& d) const {
      form.quantity(required("mean", "Mean radius (before the cut)."), d.mean, length, positive);
      form.quantity(required("deviation", "Standard deviation (before the cut)."), d.deviation, length, positive);
      form.quantity(required("min", "Radii below are drawn anew."), d.min, length, positive);
      form.quantity(required("max", "Radii above are drawn anew."), d.max, length, positive);
    }
    void operator()(sim::RadiusTable& d) const {
      form.quantities(required("radii", "The radii."), d.radii, length, positive);
      form.quantities(required("mass_fractions", "The share of each in the whole mass; together 1."), d.massFractions, number,
                      {0, 1, false, false});
    }
  };
  // The order of the alternatives is not the order of precedence: a normal distribution has a min as well.
  static constexpr Choice precedence[] = {keys[1], keys[2], keys[0]};
  static constexpr std::size_t meant[] = {1, 2, 0}, shown[] = {2, 0, 1};
  const std::size_t found = form.wantsAll() ? 0 : form.whichKey(precedence, shown[spread.index()], false);
  describeAlternative(form, spread, found == noneOfThem ? noneOfThem : meant[found], Each{form},
                      [](std::size_t i) { return fmt::format("with `{}`", keys[i].word); });
  std::visit([&radii](const auto& d) { radii.kind = d; }, spread);
}

void describeRadius(Form& form, sim::SizeDistribution& radii) {
  const Field field = required("radius", "Radius of the grains: a length, or a table that says how radii are distributed.");
  const bool plain = form.isPlain(field.key, std::holds_alternative<sim::ConstantRadius>(radii.kind));
  if (plain || form.wantsAll()) {
    sim::ConstantRadius constant;
    if (const auto* known = std::get_if<sim::ConstantRadius>(&radii.kind)) constant = *known;
    form.quantity(field, constant.radius, length, positive);
    radii.kind = constant;
  }
  if (!plain || form.wantsAll()) form.table(field, [&](Form& f) { describeSizes(f, radii); });
}

struct DescribeSource {
  Form& form;

  void operator()(Packing& packing) const {
    static constexpr Choice keys[] = {{"count", ""}, {"fill", ""}, {"mass", ""}};
    struct Amount {
      Form& form;
      void operator()(ByCount& by) const { form.integer(required("count", "How many grains."), by.grains, 1, mostGrains); }
      void operator()(ByFill& by) const {
        form.quantity(required("fill", "Volume of the grains over volume of the region."), by.fraction, number, {0, 0.64, false, false});
      }
      void operator()(ByMass& by) const { form.quantity(required("mass", "Mass of the grains together."), by.mass, mass, positive); }
    };
    describeRegion(form, packing.region);
    byKey(form, packing.amount, keys, true, Amount{form});
  }

  void operator()(Lattice& lattice) const {
    static constexpr Choice kinds[] = {{"sc", "Simple cubic."}, {"fcc", "Face-centred cubic."}, {"hcp", "Hexagonal, close-packed."}};
    describeRegion(form, lattice.region);
    words(form, {"lattice", "On which lattice the grains sit."}, lattice.kind, kinds);
    form.quantityOrAuto({"spacing", "Distance of neighbours. \"auto\": the largest diameter."}, lattice.spacing, length, positive);
    form.quantity({"jitter", "Random displacement, as a share of what the gap between neighbours allows."}, lattice.jitter, number, share);
  }

  void operator()(Inlet& inlet) const {
    static constexpr Dimension rates[] = {frequency, massRate};
    describeRegion(form, inlet.region);
    std::size_t kind = static_cast<std::size_t>(inlet.rateKind);
    form.quantityOfKinds(required("rate", "Grains per second (\"500 grains/s\"), or mass per second (\"0.2 kg/s\")."), inlet.rate, kind,
                         rates, positive);
    inlet.rateKind = static_cast<RateKind>(kind);
    form.quantity({"start", "When the stream begins."}, inlet.start, time, notNegative);
    form.quantity({"end", "When it ends."}, inlet.end, time, notNegativeOrForever);
    form.optionalInteger({"count", "At most so many grains. Absent: no limit."}, inlet.count, 1, mostGrains);
  }

  void operator()(FromFile& from) const {
    form.text(
        required("file", "CSV file with the columns x,y,z,radius[,vx,vy,vz,wx,wy,wz,material] in SI units; the path starts at the scene."),
        from.file);
    form.vector({"offset", "Added to every position."}, from.offset, length);
  }

  void operator()(Listed& listed) const { form.vectors(required("positions", "The centres of the grains."), listed.positions, length); }
};

// Keys that a reader of other people's scenes may expect here.
void describeMisplaced(Form& form) {
  static constexpr std::pair<std::string_view, std::string_view> keys[] = {{"rate", "It belongs to source = \"stream\"."},
                                                                           {"start", "It belongs to source = \"stream\"."},
                                                                           {"end", "It belongs to source = \"stream\"."},
                                                                           {"fill", "It belongs to source = \"packing\"."},
                                                                           {"mass", "It belongs to source = \"packing\"."},
                                                                           {"lattice", "It belongs to source = \"lattice\"."},
                                                                           {"spacing", "It belongs to source = \"lattice\"."},
                                                                           {"jitter", "It belongs to source = \"lattice\"."},
                                                                           {"file", "It belongs to source = \"file\"."},
                                                                           {"offset", "It belongs to source = \"file\"."},
                                                                           {"positions", "It belongs to source = \"list\"."},
                                                                           {"count", "It belongs to source = \"packing\" or \"stream\"."},
                                                                           {"radius", "The radii of source = \"file\" are in the file."}};
  if (form.wantsAll()) return;
  for (const auto& [key, sentence] : keys) form.misplaced(key, sentence);
}

void describeSource(Form& form, GrainSource& source) {
  static constexpr Choice kinds[] = {{"packing", "At random places in a region, without overlap."},
                                     {"lattice", "On the points of a lattice inside a region."},
                                     {"stream", "Appearing in a region at a rate, during the run."},
                                     {"file", "From a table."},
                                     {"list", "At given places."}};
  byWord(form, required("source", "Where the grains come from."), source.from, kinds, DescribeSource{form});
  if (!std::holds_alternative<FromFile>(source.from) || form.wantsAll()) describeRadius(form, source.radii);
  form.text({"material", "Name of the material; may be left out when there is only one."}, source.material);
  form.vector({"velocity", "Initial velocity."}, source.velocity, velocity);
  form.quantity({"velocity_spread", "Largest random deviation of each component of the velocity."}, source.velocitySpread, velocity,
                notNegative);
  form.vector({"spin", "Initial angular velocity."}, source.spin, angularVelocity);
  form.optionalQuantity({"temperature", "At the start; needs [heat]. Absent: that of [heat]."}, source.temperature, temperature, positive);
  describeMisplaced(form);
}

}  // namespace

void describeGrains(Form& form, Scene& scene) {
  form.table({"grains", "Where grains come from."}, [&](Form& f) {
    f.others({"name", "A source of grains."}, namedEntries(scene.grains, describeSource));
  });
}

}  // namespace tsubu::scene
