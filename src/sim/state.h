#pragma once
// The grains of a running simulation. Everything that is indexed by grain is here, in the order of memory (which changes at every
// rebuild of the lists); permanent ids tell grains apart.

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "sim/grain_rows.h"
#include "sim/insertion/grain.h"
#include "sim/scheme.h"

namespace tsubu::sim {

inline Vec3 positionOf(const GrainRow& row) { return {row.x, row.y, row.z}; }

/// Rows, forces and materials may go on beyond the grains: images of grains across a periodic boundary (neighbours/pair_lists.h).
struct State {
  std::vector<GrainRow> rows;
  std::vector<ForceRow> forces;
  std::vector<SingleRow> single;             ///< mixed precision: the rows, as contacts between grains read them
  std::vector<SingleForceRow> singleForces;  ///< and what these contacts have done, beside `forces`
  std::vector<HalfStepRow> half;             ///< velocity Verlet
  std::vector<PlaceRow> previous;            ///< central differences: positions one step ago
  std::vector<Quat> orientation;             ///< empty unless it is kept; as it was when `turned` was last zero
  std::vector<AngleRow> turned;              ///< ∫ω dt since then: orientations only show, and are brought up to date every few steps
  std::vector<std::uint16_t> material;
  std::vector<double> temperature;  ///< K; empty unless heat is modelled
  std::vector<double> warming;      ///< K, in the present step
  std::vector<std::uint32_t> id;
  std::vector<std::uint32_t> sides;   ///< bit c: on the positive side of counter c; empty without counters
  std::vector<Vec3> reference;        ///< positions at the last rebuild of the outer lists
  std::vector<float> skin, perSkin2;  ///< m, 1/m²: see neighbours/skins.h
  std::vector<Vec3> wrap;             ///< what the last rebuild added to the positions; empty unless the domain is periodic

  Integrator integrator = Integrator::symplecticEuler;
  bool mixed = false;  ///< precision
  bool turns = false;
  bool keepsOrientation = false;
  bool conducts = false;
  std::uint32_t nextId = 0;

  std::size_t images = 0;  ///< rows beyond those of the grains

  std::size_t size() const { return rows.size() - images; }
  double mass(std::size_t g) const { return 1 / rows[g].inverseMass; }

  /// Adds a grain; its velocity is that of the present instant. Schemes that keep something of the last (half) step take it as free
  /// fall.
  void add(const Grain& grain, double density, const Vec3& gravity, double dt);
  /// Makes room for grains that are going to be added: so many, all in all.
  void reserve(std::size_t grains);
  /// Makes room for so many images, or takes them away.
  void setImages(std::size_t count);
  /// Puts the grains into a new order: place k gets what was at order[k]. Grains that `order` leaves out are gone, and all images.
  /// Forces and references are let go, to be there again when the lists have been made: in between, the room is needed for these.
  void reorder(const std::vector<std::int32_t>& order);
  void clearForces();
  /// Brings a single row, or all of them, up to date with the row.
  void toSingle(std::size_t g);
  void allToSingle();
  /// Adds what contacts did in single precision to the forces of rows [first, last), and clears it.
  void foldSingleForces(std::int32_t first, std::int32_t last);
};

/// kg
double massOf(double density, double radius);

}  // namespace tsubu::sim
