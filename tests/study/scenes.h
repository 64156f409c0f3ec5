#pragma once
// Scenes of a few grains, in files of a folder that goes when the test is over.

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "scene/build.h"
#include "scene/reader.h"
#include "study/trial.h"

namespace tsubu::study {

class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::path(testing::TempDir()) / (name + "_" + testing::UnitTest::GetInstance()->current_test_info()->name() +
                                                           "_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

/// One grain on a floor that it never leaves: it swings, damped.
inline const std::string swinging = R"(
[simulation]
end = "40 ms"
safety = 0.5
[contact]
tangential = "none"
tension = true
[materials.ball]
density = 1000
[pairs]
normal_stiffness = "2 kN/m"
restitution = 0.7
[grains.ball]
source = "list"
radius = "1 cm"
positions = [[0, 0, "9.6 mm"]]
[walls.floor]
plane = {}
[output]
ledger_interval = "1 ms"
frame_interval = "10 ms"
[observe]
height = { kind = "centre_of_mass" }
)";

/// Some grains that fall in a heap: no run is like another with another seed.
inline const std::string heap = R"(
[simulation]
end = "60 ms"
safety = 0.5
[materials.sand]
density = 2500
[pairs]
normal_stiffness = "500 N/m"
restitution = 0.3
friction = 0.5
[grains.pack]
source = "packing"
box = { min = ["-8 mm", "-8 mm", 0], max = ["8 mm", "8 mm", "20 mm"] }
count = 12
radius = { min = "1.5 mm", max = "2.5 mm" }
[walls.floor]
plane = {}
[output]
frame_interval = "10 ms"
[observe]
height = { kind = "centre_of_mass" }
motion = { kind = "kinetic_energy" }
)";

inline double valueOf(const Outcome& outcome, const std::string& name) {
  for (const Measured& value : outcome.values)
    if (value.name == name) return value.value;
  ADD_FAILURE() << "no observable " << name;
  return 0;
}

}  // namespace tsubu::study
