#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scene/check.h"
#include "sim/pass.h"
#include "sim/time_step.h"

namespace tsubu::scene {

namespace {

constexpr double sphere = 4.0 / 3.0 * std::numbers::pi;

class ValueCheck {
 public:
  ValueCheck(const Scene& scene, const PositionOf& positionOf, Findings& findings)
      : scene_(scene), positionOf_(positionOf), findings_(findings) {}

  void all() {
    limit();
    precision();
    if (scene_.simulation.domain) domain(*scene_.simulation.domain);
    for (const GrainSource& source : scene_.grains) grains(source);
    for (const Wall& wall : scene_.walls) motions(wall);
    for (const Sink& sink : scene_.sinks) region({"sinks", sink.name}, sink.region);
    output();
    camera();
    looks();
  }

 private:
  void complain(const Path& path, std::string sentence, std::string hint = {}) {
    findings_.errors.push_back({positionOf_(path), std::move(sentence), std::move(hint)});
  }
  void warn(const Path& path, std::string sentence, std::string hint = {}) {
    findings_.warnings.push_back({positionOf_(path), std::move(sentence), std::move(hint)});
  }
  static Path inside(Path path, std::string key) {
    path.push_back(std::move(key));
    return path;
  }

  void limit() {
    const Simulation& s = scene_.simulation;
    if (s.limit != StepRule::spectral) return;
    if (s.timeStep)
      complain({"simulation", "limit"}, "The limit sets the automatic time step, and time_step is given.", "write one of them");
    try {
      sim::checkChangingSteps(s.integrator);
    } catch (const Error& error) {
      for (const Diagnostic& what : error.diagnostics()) complain({"simulation", "limit"}, what.message, what.hint);
    }
  }

  void precision() {
    const Simulation& s = scene_.simulation;
    try {
      sim::checkPrecision(s.precision, scene_.contact, s.integrator);
    } catch (const Error& error) {
      for (const Diagnostic& what : error.diagnostics()) complain({"simulation", "precision"}, what.message, what.hint);
    }
  }

  bool box(const Path& path, const sim::BoxRegion& b) {
    for (int k = 0; k < 3; ++k) {
      if (b.min[k] < b.max[k]) continue;
      complain(path, fmt::format("The box is empty: its {} runs from {} m to {} m.", "xyz"[k], b.min[k], b.max[k]),
               "min must lie below max");
      return false;
    }
    return true;
  }

  void domain(const sim::BoxRegion& b) {
    const Path path{"simulation", "domain"};
    if (!box(path, b)) return;
    for (int k = 0; k < 3; ++k) {
      if (!scene_.simulation.periodic[static_cast<std::size_t>(k)] || std::isfinite(b.max[k] - b.min[k])) continue;
      complain(inside(path, "periodic"), fmt::format("The domain is periodic along {} and has no end there.", "xyz"[k]),
               "give its min and max");
    }
  }

  bool region(const Path& owner, const sim::Region& r) {
    if (const auto* b = std::get_if<sim::BoxRegion>(&r.shape)) return box(inside(owner, "box"), *b);
    const auto& cylinder = std::get<sim::CylinderRegion>(r.shape);
    if (cylinder.base != cylinder.top) return true;
    complain(inside(owner, "cylinder"), "The cylinder has no height: base and top are the same point.");
    return false;
  }

  bool radii(const Path& path, const sim::SizeDistribution& sizes) {
    const auto ordered = [&](double low, double high) {
      if (low <= high) return true;
      complain(path, fmt::format("The smallest radius, {} m, is larger than the largest, {} m.", low, high));
      return false;
    };
    if (const auto* d = std::get_if<sim::UniformRadius>(&sizes.kind)) return ordered(d->min, d->max);
    if (const auto* d = std::get_if<sim::NormalRadius>(&sizes.kind)) {
      if (!ordered(d->min, d->max)) return false;
      if (d->min <= d->mean && d->mean <= d->max) return true;
      complain(path, fmt::format("The mean radius, {} m, is not between min and max.", d->mean));
      return false;
    }
    if (const auto* d = std::get_if<sim::RadiusTable>(&sizes.kind)) return table(path, *d);
    return true;
  }

  bool table(const Path& path, const sim::RadiusTable& d) {
    if (d.radii.size() != d.massFractions.size()) {
      complain(path, fmt::format("There are {} radii and {} mass fractions.", d.radii.size(), d.massFractions.size()),
               "one share for each radius");
      return false;
    }
    double sum = 0;
    for (const double share : d.massFractions) sum += share;
    if (std::abs(sum - 1) <= 1e-3) return true;
    complain(path, fmt::format("The mass fractions add up to {:.6g}; they must add up to 1.", sum));
    return false;
  }

  void grains(const GrainSource& source) {
    const Path path{"grains", source.name};
    if (std::holds_alternative<FromFile>(source.from)) return;
    if (!radii(inside(path, "radius"), source.radii)) return;
    std::visit([&](const auto& from) { this->source(path, source, from); }, source.from);
  }

  // A region for grains: not empty, finite, and wide enough for the largest of them.
  bool place(const Path& path, const sim::Region& r, const sim::SizeDistribution& sizes) {
    if (!region(path, r)) return false;
    if (!std::isfinite(r.volume())) {
      complain(inside(path, "box"), "The box is infinite: grains must have an end.");
      return false;
    }
    if (r.inradius() >= sizes.largest() * (1 - 1e-12)) return true;
    complain(path, fmt::format("The region is too narrow: the largest grains have a radius of {} m, and only {} m fits.", sizes.largest(),
                               r.inradius()));
    return false;
  }

  void source(const Path& path, const GrainSource& source, const Packing& packing) {
    if (!place(path, packing.region, source.radii)) return;
    const auto* count = std::get_if<ByCount>(&packing.amount);
    if (!count) return;
    const double fraction = static_cast<double>(count->grains) * sphere * source.radii.meanCube() / packing.region.volume();
    if (fraction <= 0.74) return;
    complain(inside(path, "count"), fmt::format("{} grains are {:.3g} times the volume of the region.", count->grains, fraction),
             fmt::format("at random about {} fit", static_cast<std::uint64_t>(static_cast<double>(count->grains) * 0.6 / fraction)));
  }

  void source(const Path& path, const GrainSource& source, const Lattice& lattice) {
    if (!place(path, lattice.region, source.radii)) return;
    if (!lattice.spacing || *lattice.spacing >= 2 * source.radii.largest() * (1 - 1e-12)) return;
    complain(inside(path, "spacing"),
             fmt::format("Neighbours {} m apart overlap: the largest diameter is {} m.", *lattice.spacing, 2 * source.radii.largest()));
  }

  void source(const Path& path, const GrainSource& source, const Inlet& inlet) {
    place(path, inlet.region, source.radii);
    if (inlet.start >= inlet.end)
      complain(inside(path, "end"), fmt::format("The stream ends at {} s, before it starts at {} s.", inlet.end, inlet.start));
  }

  void source(const Path&, const GrainSource&, const FromFile&) {}
  void source(const Path&, const GrainSource&, const Listed&) {}

  // An endless plane turns only about its normal: the world behind it must stay solid.
  void tilt(const Wall& wall, const Motion& motion) {
    const auto* plane = std::get_if<PlaneShape>(&wall.shape);
    const auto* rotate = std::get_if<Rotate>(&motion.kind);
    if (!plane || (!rotate && !std::holds_alternative<Rock>(motion.kind))) return;
    if (rotate && rotate->axis.normalized().cross(plane->normal.normalized()).norm() < 1e-9) return;
    complain({"walls", wall.name, "motion"}, fmt::format("The plane '{}' has no end and cannot tilt.", wall.name),
             "rotate it about its normal, or use a mesh");
  }

  void motions(const Wall& wall) {
    if (wall.body && !wall.motions.empty())
      complain({"walls", wall.name, "body"}, fmt::format("The wall '{}' cannot move both as it is told and under load.", wall.name),
               "leave out motion or body");
    for (const Motion& motion : wall.motions) tilt(wall, motion);
    for (const Motion& motion : wall.motions) {
      if (motion.start < motion.end) continue;
      complain({"walls", wall.name, "motion"}, fmt::format("A motion ends at {} s, before it starts at {} s.", motion.end, motion.start));
    }
  }

  void output() {
    const Output& o = scene_.output;
    if (o.frameInterval && o.slowMotion) {
      complain({"output", "frame_interval"}, "'frame_interval' and 'slow_motion' say the same in two ways; only one can be given.");
      return;
    }
    const double frame = frameInterval(o), ledger = ledgerInterval(o), ratio = frame < ledger ? ledger / frame : frame / ledger;
    if (std::abs(ratio - std::round(ratio)) > 1e-6 * ratio) {
      complain({"output", "ledger_interval"},
               fmt::format("The ledger's interval, {:.6g} s, and that of the frames, {:.6g} s, do not fit into each other.", ledger, frame),
               "one must be a whole number of the other");
    }
    const double frames = scene_.simulation.end / frame;
    if (frames > 1e6) {
      complain({"output"}, fmt::format("The film would have {:.0f} frames.", frames), "make fps, slow_motion or simulation.end smaller");
    }
  }

  void camera() {
    if (const auto* c = std::get_if<render::FixedCamera>(&scene_.camera)) view({"camera", "eye"}, c->eye, c->target, c->up);
    if (const auto* c = std::get_if<render::KeyFrameCamera>(&scene_.camera)) {
      for (std::size_t i = 0; i < c->frames.size(); ++i) {
        view({"camera", "frames"}, c->frames[i].eye, c->frames[i].target, c->frames[i].up);
        if (i > 0 && !(c->frames[i - 1].time < c->frames[i].time)) {
          complain({"camera", "frames"}, fmt::format("Key frame {} is not later than the one before.", i), "times must ascend");
        }
      }
      if (c->frames.empty()) complain({"camera", "frames"}, "A camera with key frames needs at least one.");
    }
  }

  void view(const Path& path, const Vec3& eye, const Vec3& target, const Vec3& up) {
    const Vec3 along = target - eye;
    if (along.norm() == 0)
      complain(path, "The camera stands where it looks.", "eye and target must differ");
    else if (along.cross(up).norm() <= 1e-9 * along.norm() * up.norm())
      complain(path, "The camera looks along its 'up'.", "give another 'up'");
  }

  void looks() {
    for (const Wall& wall : scene_.walls) {
      const bool translucent =
          wall.look == Look::translucent || (wall.look == Look::automatic && std::holds_alternative<PlaneShape>(wall.shape));
      if (wall.opacity && !translucent) {
        warn({"walls", wall.name, "opacity"}, fmt::format("The wall '{}' is not translucent: its opacity has no effect.", wall.name),
             "write look = \"translucent\"");
      }
    }
    const bool quantity = scene_.colours.by != render::ColourBy::uniform && scene_.colours.by != render::ColourBy::material;
    const Show& show = scene_.show;
    if (show.forceRange && show.forceRange->low < 0)
      complain({"show", "force_range"}, fmt::format("The forces that are drawn press: none is {} N.", show.forceRange->low), "begin at 0");
    if ((show.forceRange || show.forceRadius) && show.forces == render::ShownForces::none)
      warn({"show", show.forceRange ? "force_range" : "force_radius"}, "No forces are drawn.", "write forces = \"chains\" or \"all\"");
    if (scene_.colours.range && !quantity) warn({"colours", "range"}, "The colours show no quantity: their range has no effect.", "see by");
  }

  const Scene& scene_;
  const PositionOf& positionOf_;
  Findings& findings_;
};

}  // namespace

void checkValues(const Scene& scene, const PositionOf& positionOf, Findings& findings) { ValueCheck(scene, positionOf, findings).all(); }

}  // namespace tsubu::scene
