#include "sim/walls/contact.h"

#include <cmath>

namespace tsubu::sim {

double contactKinship(const Vec3& normalA, const Vec3& normalB) {
  const double squared = 0.5 * (normalA - normalB).squaredNorm();
  if (squared >= 1) return 0;
  const double x = std::sqrt(squared);
  const double y = (1 - x) * (1 - x);
  return y * y * (4 * x + 1);
}

namespace {

constexpr int most = WallContacts::capacity;

/// What a contact must add beyond the others' share before it counts, as a fraction of the deepest overlap: rounding, no more.
constexpr double negligible = 1e-12;

/// Maximises λ·δ − ½ λ·Gλ over λ ≥ 0 by the active-set method of Lawson and Hanson (Solving Least Squares Problems, 1974,
/// ch. 23): contacts enter one at a time, the one that is least resolved by the others first.
class LoadSharing {
 public:
  LoadSharing(const WallContacts& contacts, double radius) : count_(contacts.size()) {
    for (int i = 0; i < count_; ++i) {
      overlap_[i] = radius - contacts[i].distance;
      deepest_ = std::max(deepest_, overlap_[i]);
      kinship_[i][i] = 1;
      for (int j = 0; j < i; ++j) kinship_[i][j] = kinship_[j][i] = contactKinship(contacts[i].normal, contacts[j].normal);
    }
  }

  void solve() {
    for (int round = 0; round < 3 * most; ++round) {
      const int entering = leastResolved();
      if (entering < 0) return;
      active_[actives_++] = entering;
      if (!solveActive()) {  // to rounding a copy of those already there
        --actives_;
        refused_[entering] = true;
        continue;
      }
      while (!keepPositive()) solveActive();
    }
  }

  double load(int i) const { return load_[i]; }
  double overlap(int i) const { return overlap_[i]; }

 private:
  /// The contact whose overlap is least accounted for by the loads so far, or -1.
  int leastResolved() const {
    int best = -1;
    double most_ = negligible * deepest_;
    for (int i = 0; i < count_; ++i) {
      if (refused_[i] || std::find(active_, active_ + actives_, i) != active_ + actives_) continue;
      double rest = overlap_[i];
      for (int k = 0; k < actives_; ++k) rest -= kinship_[i][active_[k]] * load_[active_[k]];
      if (rest > most_) {
        most_ = rest;
        best = i;
      }
    }
    return best;
  }

  /// G trial = δ on the active contacts, by Cholesky's factorisation. False when G is singular to rounding.
  bool solveActive() {
    for (int i = 0; i < actives_; ++i) {
      for (int j = 0; j <= i; ++j) {
        double sum = kinship_[active_[i]][active_[j]];
        for (int k = 0; k < j; ++k) sum -= factor_[i][k] * factor_[j][k];
        if (i > j) {
          factor_[i][j] = sum / factor_[j][j];
        } else {
          if (sum < 1e-13) return false;
          factor_[i][i] = std::sqrt(sum);
        }
      }
    }
    for (int i = 0; i < actives_; ++i) {
      double sum = overlap_[active_[i]];
      for (int k = 0; k < i; ++k) sum -= factor_[i][k] * trial_[k];
      trial_[i] = sum / factor_[i][i];
    }
    for (int i = actives_ - 1; i >= 0; --i) {
      double sum = trial_[i];
      for (int k = i + 1; k < actives_; ++k) sum -= factor_[k][i] * trial_[k];
      trial_[i] = sum / factor_[i][i];
    }
    return true;
  }

  /// Goes from the loads towards the trial as far as none turns negative; those that reach zero leave. True when all the way.
  bool keepPositive() {
    double reach = 1;
    for (int k = 0; k < actives_; ++k)
      if (trial_[k] <= 0) reach = std::min(reach, load_[active_[k]] / (load_[active_[k]] - trial_[k]));
    int kept = 0;
    bool whole = true;
    for (int k = 0; k < actives_; ++k) {
      double& load = load_[active_[k]];
      load += reach * (trial_[k] - load);
      if (trial_[k] <= 0 && load <= negligible * deepest_) {
        load = 0;
        whole = false;
      } else {
        active_[kept++] = active_[k];
      }
    }
    whole = whole && reach == 1;
    actives_ = kept;
    return whole;
  }

  int count_, actives_ = 0;
  double deepest_ = 0;
  int active_[most] = {};
  bool refused_[most] = {};
  double overlap_[most], load_[most] = {}, trial_[most];
  double kinship_[most][most], factor_[most][most];
};

}  // namespace

void shareLoad(WallContacts& contacts, double radius) {
  for (WallContact& contact : contacts) contact.weight = 1;
  if (contacts.size() < 2) return;
  LoadSharing sharing(contacts, radius);
  sharing.solve();
  int kept = 0;
  for (int i = 0; i < contacts.size(); ++i) {
    if (!(sharing.load(i) > 0)) continue;
    contacts[kept] = contacts[i];
    contacts[kept++].weight = std::min(1.0, sharing.load(i) / sharing.overlap(i));
  }
  while (contacts.size() > kept) contacts.erase(contacts.size() - 1);
}

}  // namespace tsubu::sim
