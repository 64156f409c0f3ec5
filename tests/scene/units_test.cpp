#include "scene/units.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"

namespace tsubu::scene {
namespace {

constexpr double pi = std::numbers::pi;

struct Case {
  const char* text;
  double value;
  Dimension dimension;
};

// Values by the definition of each unit.
const Case cases[] = {
    {"2", 2, dimension::number},
    {"-3.5e2", -350, dimension::number},
    {"+4", 4, dimension::number},
    {"30 %", 0.3, dimension::number},
    {"2 mm", 2e-3, dimension::length},
    {"2mm", 2e-3, dimension::length},
    {"  2 mm ", 2e-3, dimension::length},
    {"1.1 mm", 1.1e-3, dimension::length},
    {"7 um", 7e-6, dimension::length},
    {"7 \u00b5m", 7e-6, dimension::length},
    {"7 \u03bcm", 7e-6, dimension::length},
    {"3 cm", 0.03, dimension::length},
    {"2 km", 2000, dimension::length},
    {"5 g", 5e-3, dimension::mass},
    {"5 mg", 5e-6, dimension::mass},
    {"5 kg", 5, dimension::mass},
    {"1.5 t", 1500, dimension::mass},
    {"20 ms", 0.02, dimension::time},
    {"3 min", 180, dimension::time},
    {"2 h", 7200, dimension::time},
    {"180 deg", pi, dimension::angle},
    {"90°", pi / 2, dimension::angle},
    {"1 rev", 2 * pi, dimension::angle},
    {"500 mrad", 0.5, dimension::angle},
    {"12 rpm", 12 * 2 * pi / 60, dimension::angularVelocity},
    {"1 rev/s", 2 * pi, dimension::angularVelocity},
    {"2 rad/s", 2, dimension::angularVelocity},
    {"50 Hz", 50, dimension::frequency},
    {"30 fps", 30, dimension::frequency},
    {"500 grains/s", 500, dimension::frequency},
    {"8 1/s", 8, dimension::frequency},
    {"8 s^-1", 8, dimension::frequency},
    {"1 m/s", 1, dimension::velocity},
    {"36 km/h", 10, dimension::velocity},
    {"9.81 m/s^2", 9.81, dimension::acceleration},
    {"9.81 m/s²", 9.81, dimension::acceleration},
    {"9.81 m s⁻²", 9.81, dimension::acceleration},
    {"9.81 m/s2", 9.81, dimension::acceleration},
    {"9.81 m/s/s", 9.81, dimension::acceleration},
    {"3 N", 3, dimension::force},
    {"3 kg m/s^2", 3, dimension::force},
    {"1 GPa", 1e9, dimension::pressure},
    {"2 bar", 2e5, dimension::pressure},
    {"5 N/mm^2", 5e6, dimension::pressure},
    {"2.5 g/cm^3", 2500, dimension::density},
    {"2500 kg m^-3", 2500, dimension::density},
    {"1 kg/L", 1000, dimension::density},
    {"1e3 N/m", 1e3, dimension::stiffness},
    {"1 kN/m", 1e3, dimension::stiffness},
    {"1 kg/(s*s)", 1, dimension::stiffness},
    {"1 kg/(s·s)", 1, dimension::stiffness},
    {"0.2 kg/s", 0.2, dimension::massRate},
    {"6 t/h", 6000.0 / 3600, dimension::massRate},
    {"2 N m", 2, {{2, 1, -2, 0}}},
    {"2 J", 2, {{2, 1, -2, 0}}},
    {"2 kW", 2000, {{2, 1, -3, 0}}},
};

TEST(Units, Table) {
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const Quantity quantity = parseQuantity(c.text);
    EXPECT_DOUBLE_EQ(quantity.value, c.value);
    EXPECT_EQ(quantity.dimension, c.dimension);
  }
}

// "1.1 mm" is 1.1/1000, one rounding, and so the double that 0.0011 is.
TEST(Units, DecimalPrefixesRoundOnce) {
  EXPECT_EQ(parseQuantity("1.1 mm").value, 0.0011);
  EXPECT_EQ(parseQuantity("0.7 ms").value, 0.0007);
  EXPECT_EQ(parseQuantity("3 um").value, 3e-6);
}

struct Bad {
  const char* text;
  const char* message;
};

const Bad bad[] = {
    {"", "'' does not begin with a number."},
    {"mm", "'mm' does not begin with a number."},
    {"1e999 m", "The number in '1e999 m' is out of range."},
    {"2 mn", "'mn' in '2 mn' is not a known unit."},
    {"2 kmin", "'kmin' in '2 kmin' is not a known unit."},
    {"2 /s", "In '2 /s' a unit is missing."},
    {"2 m^", "In '2 m^' a power is missing its whole number."},
    {"2 m^x", "In '2 m^x' a power is missing its whole number."},
    {"2 kg/m s", "In '2 kg/m s' it is not clear what is divided."},
    {"2 (m", "In '2 (m' a parenthesis is not closed."},
    {"2 m)", "In '2 m)' nothing is expected at ')'."},
    {"2 m+s", "In '2 m+s' nothing is expected at '+s'."},
    {"2 ((((((((((((((((((((((m))))))))))))))))))))))", "'2 ((((((((((((((((((((((m))))))))))))))))))))))' has too many parentheses."},
};

TEST(Units, BadOnesSayWhatIsWrong) {
  for (const Bad& b : bad) {
    SCOPED_TRACE(b.text);
    try {
      parseQuantity(b.text);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.diagnostics().front().message, b.message);
    }
  }
}

TEST(Units, NearestUnitIsOffered) {
  try {
    parseQuantity("3 grain/sec");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics().front().message, "'sec' in '3 grain/sec' is not a known unit.");
  }
  try {
    parseQuantity("3 GPA");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics().front().hint, "did you mean 'GPa'?");
  }
}

TEST(Units, DimensionsHaveNamesExamplesAndUnits) {
  for (const Dimension& d : {dimension::length, dimension::mass, dimension::time, dimension::angle, dimension::velocity,
                             dimension::acceleration, dimension::angularVelocity, dimension::frequency, dimension::massRate,
                             dimension::density, dimension::stiffness, dimension::force, dimension::pressure}) {
    SCOPED_TRACE(nameOf(d));
    std::string example = exampleOf(d);
    EXPECT_EQ(parseQuantity(example.substr(1, example.size() - 2)).dimension, d);  // without the quotes
    EXPECT_EQ(dimensionOf(unitOf(d)), d);
    EXPECT_EQ(parseQuantity("1 " + unitOf(d)).value, 1);
  }
  EXPECT_EQ(nameOf({{1, 1, 0, 0}}), "a quantity in m kg");
  EXPECT_EQ(unitOf({{0, 2, -1, 0}}), "kg^2 s^-1");
}

}  // namespace
}  // namespace tsubu::scene
