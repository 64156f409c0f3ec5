#pragma once
// The inside of a Simulation, shared by the files that implement it: the step (simulation.cpp), its neighbour lists
// (refresh_lists.cpp), who comes and goes (population.cpp), the length of a step (change_step.cpp), hard hits (sweep.cpp) and what can be
// seen (observe.cpp, diagnostics/instant.cpp).

#include <array>
#include <limits>
#include <optional>

#include "core/thread_choice.h"
#include "core/thread_team.h"
#include "sim/fields/gravity.h"
#include "sim/integrate.h"
#include "sim/kernel/kernels.h"
#include "sim/neighbours/cell_grid.h"
#include "sim/neighbours/drift.h"
#include "sim/neighbours/pair_lists.h"
#include "sim/neighbours/slab_order.h"
#include "sim/neighbours/slabs.h"
#include "sim/network.h"
#include "sim/pair_constants.h"
#include "sim/pass.h"
#include "sim/profile.h"
#include "sim/runge_kutta.h"
#include "sim/simulation.h"
#include "sim/state.h"
#include "sim/wall_pass.h"
#include "sim/walls/moving_wall.h"

namespace tsubu::sim {

class Simulation::Impl {
 public:
  Impl(Model model, int threads);

  // The step.
  void step();
  void stepWithChoice();
  /// The forces of the present instant, unless they are known. For an observer contacts are noted, if the model wants that.
  enum class For { step, observer };
  void computeForces(For whom = For::observer);
  double time() const { return since + static_cast<double>(steps - stepsSince) * model.timeStep; }
  void setTimeStep(double dt);
  /// By place: where a grain stands in the order of ids.
  std::vector<std::int32_t> ranks() const;
  ContactNetwork networkNow();
  StepLimit stableStepNow();

  // Who comes and goes.
  void changePopulation();
  void countCrossings();

  // What can be seen.
  Ledger ledgerNow();
  ContactSummary contactsNow();
  std::vector<WallState> movingWallsNow();
  void fill(Snapshot& snapshot);
  Instant instantNow();
  std::uint64_t stateHash();

  Model model;
  ThreadTeam team;
  State state;
  std::size_t law = 0;
  LawTraits traits{};
  PairConstants constants;
  PairClasses classes{};
  Scheme scheme;
  GravityClock gravity;
  Periods periods;

  Slabs slabs;
  SlabOrder slabOrder;  ///< in which the present step works on them
  CellGrid grid;
  PairLists pairs;
  WallPass walls;
  std::vector<MovingWall> moving;                  ///< walls that move under load
  std::vector<ContactMode> contactsOfMoving;       ///< the stiffest that each can have, for a mass of 1 kg
  std::vector<std::unique_ptr<ForcePass>> passes;  ///< beside contacts
  std::optional<RungeKutta> rungeKutta;            ///< when it is the integrator
  std::vector<Stage> stages;                       ///< one per thread
  std::vector<StageIn<float>> singleStages;        ///< of pairs, with mixed precision
  Profile profile;
  std::vector<Accounts> last;                      ///< one per slab: this step's
  std::vector<std::vector<ActingContact>> acting;  ///< one per slab: the contacts of the present instant, noted for an observer
  std::array<double, Accounts::kinds> total{};     ///< dissipated so far

  double largestSkin = 0;               ///< m
  double innerShare = 0;                ///< of the skins, what belongs to the inner lists
  double fastest = 0;                   ///< m/s: in the last step
  Drift drift;                          ///< how far grains have gone since the lists were made
  double wallSkin = 0, wallTravel = 0;  ///< m: how far walls may go before the lists must be made anew, and have gone
  double wallStep = 0, bodyStep = 0;    ///< m: how far any may go in the present step; those under load went in the last
  bool rebuildNeeded = true;
  std::vector<int> due;  ///< the inner lists that do not hold at the present instant, unless all are new

  std::uint64_t steps = 0;
  double since = 0;  ///< s: steps have had this length from here on
  std::uint64_t stepsSince = 0;
  double nextTimeStep = 0;   ///< s: asked for; 0: none
  bool changing = false;     ///< the present step goes over to it
  double stepAfterNext = 0;  ///< s: asked for while it does; 0: none
  StiffestMode stiffest;     ///< of the network, as it was found last
  std::uint64_t grainSteps = 0, threadSteps = 0;
  std::optional<ThreadChoice> choice;
  std::uint64_t stepsBetweenArrivals = 1;
  std::uint64_t turnInterval = turnEvery;  ///< steps between updates of the orientations; magnets need them all
  bool forcesKnown = false;
  bool moved = false;                           ///< the step's grains have been moved in the pass over their contacts
  bool accountsKnown = false;                   ///< the last pass kept accounts of what is dissipated
  bool observed = false;                        ///< and of what is stored, and how deep contacts are
  std::vector<Motion> motions;                  ///< one per slab
  std::vector<std::int32_t> placeAfterRemoval;  ///< old place → place after removals that the lists do not know yet; empty: none

  Counts counts;
  std::vector<LostGrain> lost;
  std::vector<std::string> warnings;
  std::vector<StreamProgress> streams;
  double insertedEnergy = 0, removedEnergy = 0;
  double hardRate = 0, smallestRadius = std::numeric_limits<double>::infinity();  ///< C1: radii per second; m
  double impactWork = 0;                                                          ///< J: of moving walls on grains that they hit hard
  double wrapWork = 0;             ///< J: what gravity gets for grains that go on at the other end of a periodic domain
  std::uint32_t firstArrival = 0;  ///< id: grains from here on have come in the present step
  double insertedHeat = 0, removedHeat = 0;
  double initialEnergy = 0, turnover = 0;
  Ledger lastLedger;

 private:
  void prepareLaws();
  void warnOfWalls();
  void prepareState();
  void prepareArrivals();
  void chooseDomain();
  void changeGravity();
  Vec3 momentOfMass() const;
  void placeMovingWalls();
  void loadMovingWalls();
  void addGrain(const Grain& grain);

  /// s: what the evaluation of the present forces stands for, and what they push for; the step, but for one that changes its length.
  double evaluationStep() const;
  double kickStep() const;
  void beginChange();
  void finishChange();

  void findDueLists();
  void giveSkins();
  void refreshLists();
  void wrapGrains();
  void rebuildLists();
  bool outerListsHold();
  bool slabHolds(int slab);
  PassContext context(PairClass pairClass, bool oneClass);
  /// What passes see at time t (s); `share` as in World.
  World world(double t, double share);
  void book(double share);
  StepOf stepOf() const;
  void evaluateContacts(For whom);
  std::vector<double> workOfSlabs() const;
  template <class Real>
  void evaluateContactsIn(For whom, std::vector<StageIn<Real>>& pairStages);
  void move();
  bool contactsActAlone() const;
  void moveSlab(int slab, int thread);
  Motion moveBySlabs();
  Motion moveByStages();

  void watchOverlap();
  class Sweep;
  void prepareSweep();
  /// Radii per step: what goes farther is swept.
  double hardShare() const;
  double sweep(double dt);
  void warnRattle(std::size_t grain);
  [[noreturn]] void notANumber(std::size_t grain) const;
  void watchTravel();
  void complain(const std::string& sentence, const std::string& hint);
  std::string describe(std::size_t grain) const;

  void arrive();
  void bookArrivals();
  /// `anyTunnelled`: a slab of walls says so.
  void leave(bool anyTunnelled);
  /// Has it come to a sink, out of the domain or across a counter?
  bool goesOrCrosses(std::size_t grain) const;
  /// Those of the grains of lists that are due, or of all when all lists are; in the order of their places, by list.
  std::vector<std::size_t> thoseWhoGoOrCross();
  void lose(std::size_t grain, const std::string& why, std::vector<char>& goes);
  void removeGrains(const std::vector<char>& goes);
  std::uint32_t sidesOf(const Vec3& position) const;
  void countCrossing(std::size_t grain);
  bool touchesGrain(const Vec3& centre, double radius, std::vector<std::int32_t>& near) const;

  struct DeepestContact {
    std::uint64_t touching = 0;
    double overlap = 0;  ///< over the smaller radius
    std::size_t grain = 0;
    std::string partner;
  };
  DeepestContact surveyContacts() const;
  static constexpr std::size_t noGrain = std::numeric_limits<std::size_t>::max();
  struct SeenContact;
  template <class Visit>
  void visitContacts(Visit&& visit) const;
  double energyOf(std::size_t grain) const;
  /// J: in the springs of all contacts that one of the marked grains takes part in.
  double storedInPasses(const std::vector<char>& grains);
  double storedInContactsOf(const std::vector<char>& grains) const;
  /// J: in the contact of two grains that touches at the sum of their radii.
  double contactEnergyOf(std::size_t i, std::size_t j) const;
  void addLoads(std::vector<double>& load) const;
  void showForces(Snapshot& snapshot) const;
  std::uint64_t contactHash() const;

  bool warnedOverlap_ = false, warnedTravel_ = false, warnedLightWall_ = false, warnedRattle_ = false;
};

}  // namespace tsubu::sim
