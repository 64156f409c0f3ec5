// How contacts share their load.

#include "sim/walls/contact.h"

#include <gtest/gtest.h>

#include "shapes.h"

namespace tsubu::sim::test {
namespace {

WallContact contact(const Vec3& normal, double distance, std::uint32_t feature = 0) {
  return {-distance * normal, normal, distance, 1, feature};
}

Vec3 tilted(double angle) { return {std::sin(angle), 0, std::cos(angle)}; }

TEST(Kinship, IsOneForEqualNormalsAndZeroFromARightAngleOn) {
  EXPECT_EQ(contactKinship(Vec3::UnitZ(), Vec3::UnitZ()), 1);
  EXPECT_EQ(contactKinship(Vec3::UnitZ(), Vec3::UnitX()), 0);
  EXPECT_EQ(contactKinship(Vec3::UnitZ(), tilted(2)), 0);
  EXPECT_EQ(contactKinship(Vec3::UnitZ(), -Vec3::UnitZ()), 0);
  // Wendland's function at the chord of 60°, |n − n'| = 1, x = 1/√2.
  const double x = std::sqrt(0.5);
  EXPECT_NEAR(contactKinship(Vec3::UnitZ(), tilted(std::numbers::pi / 3)), std::pow(1 - x, 4) * (4 * x + 1), 1e-15);
  double before = 1;
  for (double angle = 0.01; angle < 1.57; angle += 0.01) {
    const double now = contactKinship(Vec3::UnitZ(), tilted(angle));
    EXPECT_LT(now, before);
    before = now;
  }
}

TEST(ShareLoad, OneContactCarriesAll) {
  WallContacts contacts;
  contacts.push(contact(Vec3::UnitZ(), 0.09));
  shareLoad(contacts, 0.1);
  ASSERT_EQ(contacts.size(), 1);
  EXPECT_EQ(contacts[0].weight, 1);
}

TEST(ShareLoad, NearlyParallelContactsOfEqualDepthAreHalfEach) {
  for (const double angle : {0.0001, 0.001, 0.01}) {
    WallContacts contacts;
    contacts.push(contact(tilted(0), 0.09, 0));
    contacts.push(contact(tilted(angle), 0.09, 1));
    shareLoad(contacts, 0.1);
    ASSERT_EQ(contacts.size(), 2);
    EXPECT_NEAR(contacts[0].weight + contacts[1].weight, 1, 10 * angle * angle);
    EXPECT_NEAR(contacts[0].weight, contacts[1].weight, 1e-6);
  }
}

TEST(ShareLoad, AContactThatAnotherResolvesIsDropped) {
  WallContacts contacts;
  contacts.push(contact(tilted(0), 0.0905, 0));
  contacts.push(contact(tilted(0.05), 0.09, 1));
  shareLoad(contacts, 0.1);
  ASSERT_EQ(contacts.size(), 1);
  EXPECT_EQ(contacts[0].feature, 1u);
  EXPECT_EQ(contacts[0].weight, 1);
}

TEST(ShareLoad, RightAnglesAndWiderStayApart) {
  WallContacts contacts;
  contacts.push(contact(Vec3::UnitX(), 0.09, 0));
  contacts.push(contact(Vec3::UnitY(), 0.095, 1));
  contacts.push(contact(-Vec3::UnitX(), 0.08, 2));
  contacts.push(contact(Vec3::UnitZ(), 0.0999, 3));
  shareLoad(contacts, 0.1);
  ASSERT_EQ(contacts.size(), 4);
  for (const WallContact& c : contacts) EXPECT_EQ(c.weight, 1);
}

// The definition: with λ = weight·δ, the contacts that are left have Gλ = δ, and those that are dropped Gλ ≥ δ.
TEST(ShareLoad, SatisfiesTheConditionsOfItsMaximum) {
  Random random(5, 5);
  for (int trial = 0; trial < 3000; ++trial) {
    WallContacts all;
    const int count = 2 + trial % (WallContacts::capacity - 1);
    const double spread = trial % 3 == 0 ? 3.0 : trial % 3 == 1 ? 0.3 : 0.03;
    for (int i = 0; i < count; ++i)
      all.push(contact((Vec3::UnitZ() + spread * randomDirection(random)).normalized(), random.uniform(0.09, 0.1),
                       static_cast<std::uint32_t>(i)));
    WallContacts kept = all;
    shareLoad(kept, 0.1);
    ASSERT_FALSE(kept.empty());
    for (int i = 0; i < count; ++i) {
      double resolved = 0;
      bool isKept = false;
      for (const WallContact& k : kept) {
        resolved += contactKinship(all[i].normal, k.normal) * k.weight * (0.1 - k.distance);
        isKept = isKept || k.feature == all[i].feature;
        EXPECT_GT(k.weight, 0);
        EXPECT_LE(k.weight, 1);
      }
      const double overlap = 0.1 - all[i].distance;
      if (isKept)
        EXPECT_NEAR(resolved, overlap, 1e-9);
      else
        EXPECT_GT(resolved, overlap - 1e-9);
    }
  }
}

// Force = −∇U with U = Σ ½ k w δ² where planes meet: the ledger closes.
TEST(ShareLoad, TheForceIsTheGradientOfTheEnergy) {
  for (const int n : {5, 10, 50, 200}) {
    const Surface funnel(makeCone(n, 0.1, 0, 0.3, 0.5));
    Probe probe(funnel);
    Random random(static_cast<std::uint64_t>(n), 6);
    const double radius = 0.05, h = 1e-9;
    int several = 0;
    for (int i = 0; i < 3000; ++i) {
      const double z = random.uniform(0.15, 0.4), phi = random.uniform(0, 2 * std::numbers::pi);
      const double wall = 0.1 + 0.4 * z, out = wall - radius * std::sqrt(1 + 0.16) * random.uniform(0.95, 1.02);
      const Vec3 centre(out * std::cos(phi), out * std::sin(phi), z);
      const Vec3 force = probe.force(centre, radius);
      several += probe.contacts(centre, radius).size() > 1;
      for (int k = 0; k < 3; ++k) {
        const double slope =
            (probe.energy(centre + h * Vec3::Unit(k), radius) - probe.energy(centre - h * Vec3::Unit(k), radius)) / (2 * h);
        // Rounding 1e-16·U/h, and the kink in the force's slope where a contact begins: both far below the force, up to 2.5e-3.
        EXPECT_NEAR(force[k], -slope, 2e-8);
      }
    }
    EXPECT_GT(several, 3);
  }
}

}  // namespace
}  // namespace tsubu::sim::test
