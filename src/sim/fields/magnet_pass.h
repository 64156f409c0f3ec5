#pragma once
// Grains as magnets (docs/physics.md, F5–F8).
//
//   F8   m = p + α B₀,  p = M V R ẑ (fixed in the grain),  α = (V/μ₀) 3χ/(3 + χ) (a sphere in the field of the sources)
//        U = Σ (−p·B₀ − ½ α B₀²) + Σ_pairs U(m_i, m_j)
//        F = F_pairs + ∇B₀ (m + α B_pairs),  T = p × (B₀ + B_pairs),  work of moving sources −Σ (m + α B_pairs)·∂B₀/∂t
//
// Grains are magnetised by the sources and not by each other: right to first order in (r/d)³ χ/(3 + χ). Force and torque are the exact
// derivatives of U, so that the ledger closes. A susceptible sphere feels no torque; that of its moment is borne by the source.

#include "sim/fields/dipole.h"
#include "sim/fields/field_source.h"
#include "sim/pass.h"

namespace tsubu::sim {

/// Does any material that grains have carry a magnetisation of its own? Then grains turn, friction or not.
bool hasPermanentMagnets(const Model& model);

/// (rad/s)²: how fast the magnets of a model may swing at the start, for S2.
double fastestMagnet(const Model& model);

class MagnetPass : public ForcePass {
 public:
  explicit MagnetPass(const Model& model);
  std::string name() const override { return "magnets"; }
  void regroup(const World& world, const std::vector<std::int32_t>& newPlace) override;
  void addForces(const World& world) override;
  void account(const World& world, Ledger& ledger) const override;
  double storedIn(const World& world, const std::vector<char>& grains) const override;

 private:
  struct Magnet {
    V3 fixed, moment;       // p and m, A m²
    double polarisability;  // α, A m²/T
    FieldAt source;         // B₀ where it is
  };
  struct alignas(64) Point {  // what a neighbour needs of it, in one line of cache
    V3 position, moment;
  };
  struct Neighbours {  // of the grains of a slab
    std::vector<std::int32_t> start, list;
  };
  struct Share {
    double energy = 0, power = 0;
  };

  Magnet magnetAt(const World& world, std::size_t grain) const;
  bool isMagnetic(const State& state, std::size_t grain) const { return magnetic_[state.material[grain]]; }
  void act(const World& world, int slab, Share& share);

  const Magnets magnets_;
  std::vector<double> magnetisation_, susceptibility_;  // by material
  std::vector<char> magnetic_;
  bool fixed_;  // do grains have moments of their own?
  CutOff cut_;
  std::vector<Magnet> now_;    // by grain
  std::vector<Point> points_;  // by grain
  std::vector<Neighbours> near_;
  std::vector<Share> shares_;
  double energy_ = 0;
  Tally work_;
};

}  // namespace tsubu::sim
