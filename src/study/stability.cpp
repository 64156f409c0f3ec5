#include "study/stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "scene/build.h"

namespace tsubu::study {

namespace {

// The copies differ by this share of an overlap per step, and are called unstable when that has grown so much.
constexpr double hair = 1e-7, growth = 1e3;
// A clatter is louder than the beginning by this factor.
constexpr double louder = 2;
// What is tried: from and to, as shares of the spectral prediction; and how near to each other a stable and an unstable step come.
constexpr double shortest = 0.1, longest = 4, precision = 0.004;

// The wall as it stands, at rest.
sim::Wall frozen(const sim::Wall& wall, const TriangleMesh& mesh, const Pose& pose) {
  sim::Wall still = wall;
  still.motion = {};
  still.body.reset();
  if (const auto plane = wall.surface->asPlane()) {
    const Vec3 point = pose.toWorld(-plane->signedDistance(Vec3::Zero()) * plane->normal);
    still.surface = std::make_shared<const sim::Surface>(sim::Surface::plane(wall.name, point, pose.rotation * plane->normal));
  } else if (!pose.translation.isZero() || pose.rotation.w() != 1) {
    TriangleMesh moved = mesh;
    for (Vec3& vertex : moved.vertices) vertex = pose.toWorld(vertex);
    still.surface = std::make_shared<const sim::Surface>(moved);
  }
  return still;
}

/// The state of an instant as a model of its own.
sim::Model modelOf(const scene::Built& built, const Snapshot& snapshot) {
  sim::Model model = built.model;
  model.grains.clear();
  for (std::size_t g = 0; g < snapshot.grains(); ++g) {
    sim::Grain grain;
    grain.position = snapshot.position[g];
    grain.radius = snapshot.radius[g];
    grain.material = snapshot.material[g];
    if (!snapshot.orientation.empty()) grain.orientation = snapshot.orientation[g];
    model.grains.push_back(grain);
  }
  for (std::size_t w = 0; w < model.walls.size(); ++w) model.walls[w] = frozen(model.walls[w], built.walls[w].mesh, snapshot.walls[w]);
  model.streams.clear();
  model.sinks.clear();
  model.counters.clear();
  model.ledger = false;
  model.contactForces = false;
  model.watch.stop = false;
  return model;
}

/// Second differences of positions over three steps in a row, the largest of any grain, m. A mode at the end of stability changes its sign
/// in every step, and velocities of the instant, means over two half steps, do not see it; what drifts has none.
class Jerk {
 public:
  void add(std::uint64_t step, std::vector<Vec3> positions) {
    std::rotate(positions_.begin(), positions_.begin() + 1, positions_.end());
    std::rotate(steps_.begin(), steps_.begin() + 1, steps_.end());
    positions_[2] = std::move(positions);
    steps_[2] = step;
  }
  bool known() const { return !positions_[0].empty() && steps_[2] - steps_[0] == 2; }
  double now() const {
    double most = 0;
    for (std::size_t g = 0; g < positions_[2].size(); ++g) {
      const double jerk = (positions_[2][g] - 2 * positions_[1][g] + positions_[0][g]).norm();
      if (!(jerk <= most)) most = jerk;  // what is not a number stays
    }
    return most;
  }

 private:
  std::array<std::vector<Vec3>, 3> positions_;
  std::array<std::uint64_t, 3> steps_{};
};

/// Two copies of a state: one as it is, one stirred.
class Copies {
 public:
  Copies(sim::Model calm, sim::Model stirred) : calm_(std::move(calm), 1), stirred_(std::move(stirred), 1) {}

  void advance() {
    calm_.advance(1);
    stirred_.advance(1);
  }
  /// How many grains both have at least.
  std::size_t look() {
    calm_.fill(a_);
    stirred_.fill(b_);
    if (a_.grains() != b_.grains()) return 0;
    std::vector<Vec3> differences(a_.grains());
    for (std::size_t g = 0; g < a_.grains(); ++g) differences[g] = b_.position[g] - a_.position[g];
    apart.add(a_.step, std::move(differences));
    own.add(a_.step, a_.position);
    return a_.grains();
  }

  Jerk apart, own;  ///< of the difference, and of the calm one by itself

 private:
  sim::Simulation calm_, stirred_;
  Snapshot a_, b_;
};

// Of a state that does not stay as it is: the scheme makes energy, more than this share of what is turned over.
constexpr double created = 0.25;

/// Tries steps.
class Trier {
 public:
  Trier(sim::Model model, double overlap, int steps, const Stop& stop)
      : model_(std::move(model)), overlap_(overlap), steps_(steps), stop_(stop) {}

  /// Copies that part by a factor per step; or a state out of balance, which stirs itself and may end in a clatter that never dies down:
  /// the quietest moment of its second half is then louder than its beginning.
  bool unstable(double dt) const {
    const double way = hair * overlap_;
    try {
      Copies copies(with(dt, 0), with(dt, way / dt));
      double first = 0, quietest = std::numeric_limits<double>::infinity();
      copies.look();
      for (int n = 1; n <= steps_ && !(stop_ && stop_()); ++n) {
        copies.advance();
        // Far above the limit it takes a few steps until everything has flown apart: look at each of the first, then at three of 24.
        if (n >= 24 && n % 24 < 21) continue;
        if (copies.look() < model_.grains.size()) return true;
        if (!copies.apart.known()) continue;
        if (!(copies.apart.now() < growth * way)) return true;
        if (n == 2) first = copies.own.now();
        if (2 * n > steps_) quietest = std::min(quietest, copies.own.now());
      }
      return std::isfinite(quietest) && quietest > louder * first + way;
    } catch (const Error&) {
      return true;  // not a number
    }
  }

  /// Do copies part by themselves: at this step, in the time of all steps of `measured`, stirred as there, and by a tenth of that
  /// acceleration? Or do they get louder? Where a contact begins, its dashpot shows for a single step: every one is looked at.
  bool partsAnyway(double dt, double measured) const {
    const double way = hair * overlap_, enough = growth * way * (dt / measured) * (dt / measured);
    try {
      Copies copies(with(dt, 0), with(dt, way / measured));
      const int steps = static_cast<int>(steps_ * measured / dt);
      double first = 0, quietest = std::numeric_limits<double>::infinity();
      copies.look();
      for (int n = 1; n <= steps && !(stop_ && stop_()); ++n) {
        copies.advance();
        if (copies.look() < model_.grains.size()) return true;
        if (!copies.apart.known()) continue;
        if (!(copies.apart.now() < 0.1 * enough)) return true;
        if (n == 2) first = copies.own.now();
        if (2 * n > steps) quietest = std::min(quietest, copies.own.now());
      }
      return quietest > louder * first + enough / growth;
    } catch (const Error&) {
      return true;
    }
  }

  /// For a state that falls, slides or collides by itself, so that copies of it part whatever the step: does the scheme make energy? What
  /// is dissipated must come from somewhere, and a step that is too long keeps grains clattering at the expense of nobody.
  bool makesEnergy(double dt) const {
    sim::Model model = with(dt, hair * overlap_ / dt);
    model.ledger = true;
    try {
      sim::Simulation simulation(std::move(model), 1);
      const double held = simulation.ledger().elastic();
      for (int n = 0; n < steps_ && !(stop_ && stop_()); n += 10) {
        simulation.advance(10);
        const sim::Ledger ledger = simulation.ledger();
        if (!(ledger.residual() <= created * (ledger.turnover + held))) return true;
        if (simulation.grains() < model_.grains.size()) return true;
      }
      return false;
    } catch (const Error&) {
      return true;  // not a number
    }
  }

 private:
  sim::Model with(double dt, double speed) const {
    sim::Model model = model_;
    model.timeStep = dt;
    Random random(model.seed, 77);
    for (sim::Grain& grain : model.grains) {
      for (int k = 0; k < 3; ++k) grain.velocity[k] = random.uniform(-speed, speed);
      for (int k = 0; k < 3; ++k) grain.angularVelocity[k] = random.uniform(-speed, speed) / grain.radius;
    }
    return model;
  }

  sim::Model model_;
  double overlap_;
  int steps_;
  const Stop& stop_;
};

double meanOverlap(const sim::Instant& instant) {
  double sum = 0;
  for (const sim::ActingContact& contact : instant.contacts) {
    const double touch = instant.grains[static_cast<std::size_t>(contact.first)].radius +
                         (contact.withWall() ? 0 : instant.grains[static_cast<std::size_t>(contact.second)].radius);
    sum += touch - contact.branch.norm();
  }
  return sum / static_cast<double>(instant.contacts.size());
}

// Between a stable and an unstable step; false when there is no such place in the range. `close`: over which ratio it ends.
template <class Unstable>
bool bisect(const Unstable& unstable, double around, double close, const Stop& stop, double& measured) {
  double low = shortest * around, high = longest * around;
  if (unstable(low) || !unstable(high)) return false;
  while (high / low > 1 + close && !(stop && stop())) {
    // The prediction is the first guess: most often it halves the range at once.
    const double guess = low < 0.98 * around && high > around          ? 0.98 * around
                         : high > 1.02 * around && low < 1.02 * around ? 1.02 * around
                                                                       : std::sqrt(low * high);
    (unstable(guess) ? high : low) = guess;
  }
  measured = std::sqrt(low * high);
  return true;
}

// Copies that part far below the prediction may do so because grains collide: then they do it in the same time at a tenth of the step too.
void find(const Trier& trier, const Stop& stop, Stability& found) {
  const double around = std::isfinite(found.predicted.spectral) ? found.predicted.spectral : found.automatic;
  found.found = bisect([&](double dt) { return trier.unstable(dt); }, around, precision, stop, found.measured);
  if (!found.found)
    found.restless = trier.unstable(shortest * around);
  else if (found.measured < 0.9 * around)
    found.restless = trier.partsAnyway(shortest * around, found.measured);
  if (found.restless) found.found = bisect([&](double dt) { return trier.makesEnergy(dt); }, around, 5 * precision, stop, found.measured);
}

}  // namespace

std::optional<Stability> findStability(const StabilityRequest& request, const Stop& stop) {
  scene::Overrides overrides = request.overrides;
  overrides.emplace_back("simulation.limit=packing");  // one step on the way to the state that is tried
  const scene::Scene scene = scene::read(request.scene, overrides);
  scene::Built built = scene::build(scene);
  const scene::FramePlan plan = built.plan;
  sim::Model running = built.model;
  running.contactForces = true;
  sim::Simulation simulation(std::move(running), 1);
  const double until = request.at.value_or(static_cast<double>(plan.steps) * plan.timeStep);
  while (simulation.time() < until - 0.5 * plan.timeStep) {
    if (stop && stop()) return std::nullopt;
    simulation.advance(std::min<std::uint64_t>(100, static_cast<std::uint64_t>(std::llround((until - simulation.time()) / plan.timeStep))));
  }
  Snapshot snapshot;
  const sim::Instant instant = simulation.instant();
  simulation.fill(snapshot);

  Stability found;
  found.time = simulation.time();
  found.grains = instant.grains.size();
  found.contacts = instant.contacts.size();
  if (instant.contacts.empty() && built.model.bonds.empty())
    throw Error(ErrorKind::scene, fmt::format("At t = {:.4g} s nothing touches: there is nothing that could blow up.", found.time),
                "give another --at");
  found.automatic = plan.limit;
  found.limitedBy = plan.limitedBy;
  if (!built.model.bonds.empty()) found.notes.push_back("Bonds are made anew for the trial.");
  found.predicted = sim::limitsOf(simulation.network(), built.model, snapshot);
  const double overlap = instant.contacts.empty() ? 1e-3 * snapshot.radius[0] : meanOverlap(instant);
  find(Trier(modelOf(built, snapshot), overlap, request.steps, stop), stop, found);
  if (stop && stop()) return std::nullopt;
  found.safety = plan.timeStep / found.measured;
  if (found.restless)
    found.notes.push_back(
        "The state does not stay as it is: grains fall, slide or collide. Unstable is then where the scheme makes a quarter of the energy "
        "that is turned "
        "over, to 2 %; the stiffest mode takes all its contacts for stuck and closed. Try --at a time at which the scene rests.");
  if (!found.found)
    found.notes.push_back(found.restless ? "No step between a tenth and four times the prediction makes energy: what limits is how far "
                                           "grains go in a step, not stability."
                                         : "No step between a tenth and four times the prediction parts stable from unstable.");
  return found;
}

std::string tableOf(const Stability& s) {
  std::string text = fmt::format("t = {:.4g} s: {} grain{}, {} contact{}\n", s.time, s.grains, s.grains == 1 ? "" : "s", s.contacts,
                                 s.contacts == 1 ? "" : "s");
  if (s.found)
    text += fmt::format("blows up at    {:.4g} s, by trying\nthe scene      takes {:.3g} of that, set by {}\n", s.measured, s.safety,
                        s.limitedBy);
  const sim::StabilityLimits& p = s.predicted;
  const std::pair<const char*, double> rows[] = {{"Note: min(2 (m/k)^1/2, 2 m/eta), one contact", p.note},
                                                 {"Article: pi (m/k)^1/2, duration of a contact", p.duration},
                                                 {"Article: 2 (m/k)^1/2, one contact without dashpot", p.undamped},
                                                 {"one contact, spring and dashpot together (S2)", p.single},
                                                 {"Gershgorin, translations alone (S6)", p.gershgorin},
                                                 {"sum over contacts, rigorous (S7)", p.sum},
                                                 {"spectral: stiffest mode of the network (S8)", p.spectral},
                                                 {"automatic, before contacts are known (S3-S5)", s.automatic},
                                                 {"Rayleigh", p.rayleigh}};
  for (const auto& [name, limit] : rows) {
    text += fmt::format("{:<52}", name);
    if (!std::isfinite(limit))
      text += "says nothing here\n";
    else
      text += fmt::format(
          "{:<12}{}\n", fmt::format("{:.4g} s", limit),
          s.found ? fmt::format("{:.2f} of what is measured{}", limit / s.measured, limit > 1.03 * s.measured ? ": too long" : "")
                  : std::string());
  }
  for (const std::string& note : s.notes) text += fmt::format("note           {}\n", note);
  return text;
}

}  // namespace tsubu::study
