#pragma once
// The damping that gives an asked restitution coefficient.

namespace tsubu::sim {

/// N3: the damping ratio ζ = η/(2√(m* k)) of a linear contact that gives restitution e, and that of a Hertz contact (N7).
///
/// With tension the contact lasts half a period and e = exp(−πζ/√(1−ζ²)). Without, it ends when the force vanishes, and (Schwager
/// & Pöschel 2007, Granular Matter 9, 465), with ω = √|1−ζ²|:
///   ζ < 1/√2       e = exp[−(ζ/ω)(π − arctan(2ζω/(ω²−ζ²)))]
///   1/√2 ≤ ζ < 1   e = exp[−(ζ/ω) arctan(−2ζω/(ω²−ζ²))]
///   ζ > 1          e = exp[−(ζ/ω) ln((ζ+ω)/(ζ−ω))]
/// inverted by bisection. e in (0, 1]; 1 gives exactly 0.
double dampingRatio(double restitution, bool tension);

/// The restitution that a damping ratio gives, by the same relations.
double restitutionOf(double zeta, bool tension);

}  // namespace tsubu::sim
