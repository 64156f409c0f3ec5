#include "sim/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/fields/magnet_pass.h"
#include "sim/laws/catalogue.h"
#include "sim/neighbours/slab_order.h"
#include "sim/pair_constants.h"
#include "sim/simulation_impl.h"
#include "sim/time_step.h"

namespace tsubu::sim {

namespace {

// The watch looks only so often, since it costs something, the more where no ledger is kept; at every step in the beginning, where most
// scenes go wrong. What goes wrong for good is seen a little later.
constexpr std::uint64_t watchEvery = 64, watchEveryWithLedger = 16;

// Grains that a cache of some 16 MB holds: asking for rows ahead of time pays beyond, and costs a little below.
constexpr std::size_t fitsCache = 60'000;

}  // namespace

Simulation::Impl::Impl(Model given, int threads)
    : model(std::move(given)),
      team(threads),
      law(lawIndex(model.contact)),
      traits(lawFunctions(law).traits),
      gravity(model.gravity, model.fields.gravity),
      pairs(traits.stateSize, traits.odd, model.precision == Precision::mixed),
      walls(model.walls, traits),
      moving(wallsUnderLoad(model)),
      passes(makePasses(model)),
      stages(static_cast<std::size_t>(threads)),
      singleStages(model.precision == Precision::mixed ? static_cast<std::size_t>(threads) : 0) {
  checkIntegrator(model);
  checkPrecision(model);
  checkRotation(model);
  checkContinuous(model);
  prepareLaws();
  for (const MovingWall& wall : moving) contactsOfMoving.push_back(stiffestContact(model, law, wall.wall()));
  checkPeriods(model);
  periods = Periods(model.domain, model.periodic);
  warnOfWalls();
  if (model.continuous) prepareSweep();
  prepareState();
  if (model.ledger) {
    computeForces();
    const Ledger start = ledgerNow();
    initialEnergy = start.mechanical() + start.dissipated() - start.work() - start.inserted + start.removed;
    turnover = 0;
  }
}

void Simulation::Impl::prepareLaws() {
  constants = preparePairs(model, law);
  classes = classesOfPairs(model, constants);
  scheme = schemeOf(model.integrator);
  if (model.integrator == Integrator::rungeKutta) rungeKutta.emplace(model, lawFunctions(law), constants);
  if (!(model.timeStep > 0)) throw Error(ErrorKind::scene, "The time step must be positive.");
  for (const Wall& wall : model.walls) {
    const auto plane = wall.surface->asPlane();
    if (!plane || wall.motion.still()) continue;
    for (const MotionPart& part : wall.motion.parts()) {
      const bool turnsInItself = !std::holds_alternative<Rocking>(part.kind) &&
                                 (!std::holds_alternative<Rotation>(part.kind) ||
                                  std::get<Rotation>(part.kind).axis.normalized().cross(plane->normal).norm() < 1e-9);
      if (!turnsInItself)
        throw Error(ErrorKind::scene, fmt::format("Wall '{}' is an unbounded plane and cannot tilt.", wall.name),
                    "use a mesh, or turn it about its normal");
    }
  }
}

// A grain that may go farther in a step than a wall is thick can be on its other side before it is noticed.
// Walls are not repeated by a periodic domain: one that ends at its boundary leaves a gap.
void Simulation::Impl::warnOfWalls() {
  double largest = 0;
  for (const Grain& grain : model.grains) largest = std::max(largest, grain.radius);
  for (const Stream& stream : model.streams) largest = std::max(largest, stream.radii.largest());
  const double travel = model.watch.travelLimit * largest;
  for (const Wall& wall : model.walls) {
    const double thickness = wall.surface->thinnest();
    if (thickness < travel && !model.continuous)
      warnings.push_back(fmt::format("Wall '{}' is {:.3g} m thick at its thinnest, less than the {:.3g} m that a grain may go in a step.",
                                     wall.name, thickness, travel));
    const Box bounds = wall.surface->bounds();
    for (int axis = 0; axis < 3; ++axis) {
      if (!periods.along(axis) || wall.surface->asPlane()) continue;
      const double low = bounds.min()[axis] - model.domain.min()[axis], high = model.domain.max()[axis] - bounds.max()[axis];
      const auto endsThere = [&](double inside) { return -2 * largest < inside && inside < largest; };
      if (endsThere(low) || endsThere(high))
        warnings.push_back(
            fmt::format("Wall '{}' ends near the periodic boundary along {}; walls are not repeated: let it go on beyond the domain "
                        "by {:.3g} m.",
                        wall.name, "xyz"[axis], 2 * largest));
    }
  }
}

void Simulation::Impl::prepareState() {
  if (model.counters.size() > 32) throw Error(ErrorKind::scene, fmt::format("There are {} counters, more than 32.", model.counters.size()));
  state.integrator = model.integrator;
  state.turns = grainsTurn(model);
  state.keepsOrientation = keepsOrientation(model);
  state.mixed = model.precision == Precision::mixed;
  state.conducts = model.heat;
  if (hasPermanentMagnets(model)) turnInterval = 1;
  state.reserve(model.grains.size());
  for (const Grain& grain : model.grains) addGrain(grain);
  model.grains = std::vector<Grain>();
  streams.resize(model.streams.size());
  counts.crossed.assign(model.counters.size(), 0);
  prepareArrivals();
  chooseDomain();
}

PassContext Simulation::Impl::context(PairClass pairClass, bool oneClass) {
  return {state.rows.data(),
          state.forces.data(),
          state.single.data(),
          state.singleForces.data(),
          state.material.data(),
          model.materials.size(),
          oneClass ? constants.of(pairClass.first) : constants.values.data(),
          stepOf(),
          observed,
          state.size() > fitsCache};
}

StepOf Simulation::Impl::stepOf() const {
  const double dt = evaluationStep();
  // Of a step that changes its length, what lies behind the present instant is half of the old one (I8).
  StepOf step{dt, changing && scheme.ahead > 0 ? 0.5 * model.timeStep / dt : scheme.lead};
  if (rungeKutta) step.turning = step.mean = 0;
  return step;
}

World Simulation::Impl::world(double t, double share) {
  return {model,
          state,
          slabs,
          slabOrder,
          pairs,
          periods,
          walls,
          team,
          gravity.now(),
          2 * largestSkin,
          t,
          stepOf(),
          model.timeStep,
          share,
          [this](std::int32_t i, std::int32_t j) { return contactEnergyOf(static_cast<std::size_t>(i), static_cast<std::size_t>(j)); }};
}

void Simulation::Impl::step() {
  computeForces(For::step);
  move();
}

void Simulation::Impl::computeForces(For whom) {
  if (forcesKnown) return;
  if (nextTimeStep > 0) beginChange();
  changeGravity();
  wallStep = walls.moveTo(time(), model.timeStep);
  placeMovingWalls();
  {
    Profile::Lap lap(profile, ProfilePart::lists);
    findDueLists();
    lap.next(ProfilePart::population);
    changePopulation();
    lap.next(ProfilePart::lists);
    refreshLists();
    lap.next(ProfilePart::population);
    bookArrivals();
  }
  if (gravity.changes() && model.ledger) gravity.settle(momentOfMass());

  const bool watched = steps < watchEvery || steps % (model.ledger ? watchEveryWithLedger : watchEvery) == 0;
  accountsKnown = model.ledger;
  observed = watched || whom == For::observer;
  if (rungeKutta) rungeKutta->keepMemory(pairs, walls);
  evaluateContacts(whom);
  book(1);
  Profile::Lap lap(profile, ProfilePart::other);
  for (const auto& pass : passes) {
    pass->addForces(world(time(), (rungeKutta ? RungeKutta::weight[0] : 1.0) * evaluationStep()));
    pass->count(counts);
  }
  loadMovingWalls();
  wallTravel += wallStep;
  if (firstArrival < state.nextId) startHalfSteps(state, firstArrival, gravity.now(), model.timeStep);
  firstArrival = state.nextId;
  forcesKnown = true;
  if (watched) watchOverlap();
}

// Nothing but contacts acts, and nobody but the grains feels it: what a slab needs to move is known before the pass has ended.
bool Simulation::Impl::contactsActAlone() const {
  return passes.empty() && moving.empty() && !rungeKutta && !pairs.hasImages() && firstArrival == state.nextId;
}

// Forces of all contacts, with what they put into the accounts (`last`). Where contacts act alone, a step moves a slab as soon as its
// forces are complete, while it lies in the cache.
void Simulation::Impl::evaluateContacts(For whom) {
  if (model.precision == Precision::mixed)
    evaluateContactsIn<float>(whom, singleStages);
  else
    evaluateContactsIn<double>(whom, stages);
  if (pairs.hasImages()) team.run(slabs.count(), [&](int slab, int) { pairs.foldImages(state, slab); });
}

// A grain, a listed pair and a grain near a wall take about as long.
std::vector<double> Simulation::Impl::workOfSlabs() const {
  std::vector<double> work;
  for (int slab = 0; slab < slabs.count(); ++slab) {
    const auto s = static_cast<std::size_t>(slab);
    work.push_back(static_cast<double>(slabs.end(slab) - slabs.begin(slab)) +
                   static_cast<double>(pairs.slabs()[s].i.size() + walls.slabs()[s].groups.size()));
  }
  return work;
}

template <class Real>
void Simulation::Impl::evaluateContactsIn(For whom, std::vector<StageIn<Real>>& pairStages) {
  walls.settle();
  slabOrder = orderSlabs(workOfSlabs(), team.used());
  const auto onPairs = pairKernel<Real>(law, {classes.grains.alike, accountsKnown});
  const auto onWalls = wallKernel(law, {classes.walls.alike, accountsKnown});
  const PassContext grainsWorld = context(classes.grains, onPairs.oneClass), wallsWorld = context(classes.walls, onWalls.oneClass);
  const int count = slabs.count();
  last.assign(static_cast<std::size_t>(count), Accounts{});
  const bool noting = model.contactForces && whom == For::observer;
  acting.assign(noting ? static_cast<std::size_t>(count) : 0, {});
  const auto evaluate = [&](int slab, int thread) {
    const auto s = static_cast<std::size_t>(slab);
    SlabPairs& list = pairs.slabs()[s];
    StageIn<Real>& stage = pairStages[static_cast<std::size_t>(thread)];
    Profile::Lap lap(profile, ProfilePart::pairs, thread);
    PairLists::refreshImages(state, list);
    const PairRangeIn<Real> range{list.i.data(),
                                  list.j.data(),
                                  static_cast<std::int64_t>(list.i.size()),
                                  list.memory.columns<Real>(),
                                  list.memory.stride(),
                                  list.touch.empty() ? nullptr : list.touch.data()};
    if (noting)
      passNoting(onPairs.kernel, grainsWorld, range, traits.rolls, stage, last[s], acting[s]);
    else
      onPairs.kernel(grainsWorld, range, stage, last[s]);
    lap.next(ProfilePart::walls);
    walls.evaluateSlab(slab, wallsWorld, onWalls.kernel, accountsKnown, stages[static_cast<std::size_t>(thread)], last[s],
                       noting ? &acting[s] : nullptr);
  };
  moved = whom == For::step && contactsActAlone();
  motions.assign(static_cast<std::size_t>(count), Motion{});
  overSlabs(slabOrder, team, evaluate, [&](int slab, int thread) {
    if (moved) return moveSlab(slab, thread);
    if (!state.mixed) return;
    const SlabPairs& list = pairs.slabs()[static_cast<std::size_t>(slab)];
    state.foldSingleForces(slabs.begin(slab), slabs.end(slab));
    if (!list.images.empty()) state.foldSingleForces(list.firstImage, list.firstImage + static_cast<std::int32_t>(list.images.size()));
  });
}

// Adds a share of what the last evaluation dissipated to the totals.
void Simulation::Impl::book(double share) {
  if (!model.ledger) return;
  for (const Accounts& accounts : last)
    for (int k = Accounts::normal; k <= Accounts::rolling; ++k)
      total[static_cast<std::size_t>(k)] += share * accounts.sum(static_cast<Accounts::Kind>(k));
}

void Simulation::Impl::changeGravity() {
  if (gravity.changes()) gravity.moveTo(time(), model.ledger ? momentOfMass() : Vec3(Vec3::Zero()));
}

Vec3 Simulation::Impl::momentOfMass() const { return massMoment(state) + massMoment(moving); }

void Simulation::Impl::placeMovingWalls() {
  for (const MovingWall& wall : moving)
    walls.place(wall.wall(), {Quat::Identity(), wall.way() * wall.axis()}, {wall.speedSeen() * wall.axis(), Vec3::Zero(), Vec3::Zero()});
}

// A wall lighter than its contacts can bear at this step is named before it takes off (S2 with all of them in one direction).
void Simulation::Impl::loadMovingWalls() {
  if (moving.empty()) return;
  const std::vector<WallLoad> loads = walls.loads();
  for (std::size_t w = 0; w < moving.size(); ++w) {
    MovingWall& wall = moving[w];
    wall.feel(loads[w], gravity.now(), time(), evaluationStep(), scheme);
    const double limit = sim::stableStep(wall, contactsOfMoving[w], model.integrator);
    if (warnedLightWall_ || !(model.timeStep > limit)) continue;
    warnedLightWall_ = true;
    complain(fmt::format("Wall '{}' is too light for {} contacts at once: its step would have to be below {:.4g} s, t = {:.6g} s.",
                         model.walls[wall.wall()].name, wall.contacts(), limit, time()),
             "give it more mass, or use a smaller time_step");
  }
}

void Simulation::Impl::moveSlab(int slab, int thread) {
  const Profile::Lap lap(profile, ProfilePart::motion, thread);
  const bool turn = (steps + 1) % turnInterval == 0;
  motions[static_cast<std::size_t>(slab)] =
      integrate(state, slabs.begin(slab), slabs.end(slab), gravity.now(), kickStep(), turn, state.mixed && moved);
}

Motion Simulation::Impl::moveBySlabs() {
  if (!moved) team.run(slabs.count(), [&](int slab, int thread) { moveSlab(slab, thread); });
  moved = false;
  Motion most;
  for (const Motion& motion : motions) {
    most.haste2 = std::max(most.haste2, motion.haste2);
    most.fastest2 = std::max(most.fastest2, motion.fastest2);
    most.travel2 = std::max(most.travel2, motion.travel2);
  }
  return most;
}

// The step's first evaluation has been made; three more follow (I7). Accounts take each with its weight.
Motion Simulation::Impl::moveByStages() {
  const double dt = model.timeStep;
  const std::vector<Accounts> atStart = last;
  book(RungeKutta::weight[0] - 1);
  rungeKutta->collect(0, state, slabs, pairs, walls, gravity.now(), dt, team);
  for (int stage = 1; stage < RungeKutta::stages; ++stage) {
    const auto k = static_cast<std::size_t>(stage);
    const double t = time() + RungeKutta::place[k] * dt;
    rungeKutta->moveTo(stage, state, slabs, pairs, walls, dt, team);
    if (gravity.changes()) gravity.moveTo(t, model.ledger ? momentOfMass() : Vec3(Vec3::Zero()));
    walls.moveTo(t, dt);
    evaluateContacts(For::step);
    book(RungeKutta::weight[k]);
    for (const auto& pass : passes) pass->addForces(world(t, RungeKutta::weight[k] * dt));
    rungeKutta->collect(stage, state, slabs, pairs, walls, gravity.now(), dt, team);
  }
  last = atStart;
  const Motion motion = rungeKutta->finish(state, pairs, walls, dt);
  const RungeKutta::Springs springs = rungeKutta->uncounted();
  total[Accounts::friction] += springs.tangential;
  total[Accounts::rolling] += springs.rolling;
  return motion;
}

void Simulation::Impl::move() {
  const Motion most = rungeKutta ? moveByStages() : moveBySlabs();
  if (rungeKutta) std::fill(motions.begin(), motions.end(), most);
  for (std::size_t g = 0; g < state.temperature.size(); ++g) state.temperature[g] += state.warming[g];
  bodyStep = 0;
  for (MovingWall& wall : moving) bodyStep = std::max(bodyStep, wall.move(kickStep(), changing ? nextTimeStep : model.timeStep, scheme));
  wallTravel += bodyStep;
  fastest = std::sqrt(most.fastest2);
  if (changing) finishChange();
  const bool far = !(most.travel2 <= model.watch.travelLimit * model.watch.travelLimit);
  if (model.continuous && !(fastest * model.timeStep <= hardShare() * smallestRadius)) fastest = std::max(fastest, sweep(model.timeStep));
  for (int slab = 0; slab < slabs.count(); ++slab)
    drift.add(slab, std::sqrt(motions[static_cast<std::size_t>(slab)].haste2) * model.timeStep);
  ++steps;
  grainSteps += state.size();
  forcesKnown = false;
  if (far) watchTravel();
}

void Simulation::Impl::complain(const std::string& sentence, const std::string& hint) {
  if (model.watch.stop) throw Error(ErrorKind::simulation, sentence, hint);
  warnings.push_back(sentence + " (" + hint + ")");
}

std::string Simulation::Impl::describe(std::size_t grain) const {
  const GrainRow& row = state.rows[grain];
  return fmt::format("grain {} at ({:.6g}, {:.6g}, {:.6g}) m, t = {:.6g} s (step {})", state.id[grain], row.x, row.y, row.z, time(), steps);
}

void Simulation::Impl::notANumber(std::size_t grain) const {
  throw Error(ErrorKind::simulation, fmt::format("Not a number: {}.", describe(grain)),
              "the step is probably too long for the stiffest contact: lower safety or give a smaller time_step");
}

void Simulation::Impl::watchTravel() {
  for (std::size_t g = 0; g < state.size(); ++g) {
    const GrainRow& row = state.rows[g];
    const double speed = Vec3(row.vx, row.vy, row.vz).norm();
    if (!std::isfinite(speed + row.x + row.y + row.z)) notANumber(g);
    if (model.continuous || warnedTravel_ || !(speed * model.timeStep > model.watch.travelLimit * row.radius)) continue;
    warnedTravel_ = true;
    complain(fmt::format("A grain moves {:.2g} of its radius in one step, more than {:.2g}: {}, speed {:.4g} m/s.",
                         speed * model.timeStep / row.radius, model.watch.travelLimit, describe(g), speed),
             "it may pass through another grain or a wall: use a smaller time_step, or look for what threw it");
  }
}

void Simulation::Impl::watchOverlap() {
  double deepest = 0;
  for (const Accounts& accounts : last) deepest = std::max(deepest, accounts.deepest());
  if (!(deepest > model.watch.overlapLimit) || warnedOverlap_) return;
  warnedOverlap_ = true;
  const DeepestContact contact = surveyContacts();
  complain(fmt::format("Overlap of {:.3g} of the radius, more than {:.3g}: {}, with {}.", deepest, model.watch.overlapLimit,
                       describe(contact.grain), contact.partner),
           steps == 0 ? "grains or walls overlap at the start: check their places"
                      : "the contact is too soft for the load or the speed: raise normal_stiffness");
}

Simulation::Simulation(Model model, int threads) : impl_(std::make_unique<Impl>(std::move(model), threads)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::advance(std::uint64_t steps) {
  for (std::uint64_t k = 0; k < steps; ++k) impl_->stepWithChoice();
}

void Simulation::Impl::stepWithChoice() {
  if (choice) team.use(choice->threads());
  threadSteps += static_cast<std::uint64_t>(team.used());
  if (!choice || !choice->listens()) {
    step();
    if (choice) choice->took(0);
    return;
  }
  const auto start = std::chrono::steady_clock::now();
  step();
  choice->took(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void Simulation::chooseThreads() { impl_->choice.emplace(impl_->team.threads()); }

void Simulation::setTimeStep(double dt) { impl_->setTimeStep(dt); }
StepLimit Simulation::stableStep() { return impl_->stableStepNow(); }
ContactNetwork Simulation::network() { return impl_->networkNow(); }
double Simulation::time() const { return impl_->time(); }
double Simulation::timeStep() const { return impl_->model.timeStep; }
std::uint64_t Simulation::steps() const { return impl_->steps; }
std::size_t Simulation::grains() const { return impl_->state.size(); }
const Counts& Simulation::counts() const { return impl_->counts; }
const std::vector<LostGrain>& Simulation::lostGrains() const { return impl_->lost; }
const std::vector<std::string>& Simulation::warnings() const { return impl_->warnings; }
std::uint64_t Simulation::grainSteps() const { return impl_->grainSteps; }
double Simulation::threadsUsed() const {
  return static_cast<double>(impl_->threadSteps) / std::max(1.0, static_cast<double>(impl_->steps));
}
Ledger Simulation::ledger() { return impl_->ledgerNow(); }
ContactSummary Simulation::contacts() { return impl_->contactsNow(); }
std::vector<WallState> Simulation::movingWalls() { return impl_->movingWallsNow(); }
void Simulation::startProfile() { impl_->profile.start(impl_->team.threads()); }
Profile::Seconds Simulation::profile() const { return impl_->profile.seconds(); }
void Simulation::fill(Snapshot& snapshot) { impl_->fill(snapshot); }
Instant Simulation::instant() { return impl_->instantNow(); }
std::uint64_t Simulation::stateHash() { return impl_->stateHash(); }

}  // namespace tsubu::sim
