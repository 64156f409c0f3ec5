#include "scene/alternatives.h"
#include "scene/describe.h"

namespace tsubu::scene {

namespace {

void describeRegionOfRows(Form& form, DiagnosticRegion& region) {
  form.table(required("box", "Where."), [&](Form& f) { describeBox(f, region.box); });
}

void describeGrid(Form& form, DiagnosticGrid& grid) {
  form.table(required("box", "What the cells divide."), [&](Form& f) { describeBox(f, grid.box); });
  form.table(required("cells", "How many there are."), [&](Form& f) {
    constexpr std::uint64_t most = 1000;
    f.integer({"x", "Along x."}, grid.cells[0], 1, most);
    f.integer({"y", "Along y."}, grid.cells[1], 1, most);
    f.integer({"z", "Along z."}, grid.cells[2], 1, most);
  });
}

}  // namespace

void describeDiagnostics(Form& form, Scene& scene) {
  bool present = scene.diagnostics.has_value();
  Diagnostics held = scene.diagnostics.value_or(Diagnostics{});
  form.optionalTable(
      {"diagnostics",
       "What grains do as a crowd: contacts and force chains, temperature, stress, in diagnostics.csv; what walls carry, in walls.csv."},
      present, [&](Form& f) {
        f.integer({"every", "Rows of the ledger from one measurement to the next."}, held.every, 1, 1000000);
        f.table({"regions", "Parts of space with rows of their own, beside those of the whole."}, [&](Form& regions) {
          regions.others({"name", "A region."}, namedEntries(held.regions, describeRegionOfRows));
        });
        bool divided = held.grid.has_value();
        DiagnosticGrid grid = held.grid.value_or(DiagnosticGrid{});
        f.optionalTable({"grid", "Cells with solid fraction, velocity, temperature and stress, in grid.csv."}, divided,
                        [&](Form& g) { describeGrid(g, grid); });
        held.grid = divided ? std::optional(grid) : std::nullopt;
      });
  scene.diagnostics = present ? std::optional(held) : std::nullopt;
}

}  // namespace tsubu::scene
