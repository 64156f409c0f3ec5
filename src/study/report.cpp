#include "study/report.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "study/json_file.h"

namespace tsubu::study {

namespace {

using Json = nlohmann::ordered_json;

std::string percent(double share) {
  if (!std::isfinite(share)) return "not reached";
  if (share < 1e-4) return share == 0 ? "0 %" : fmt::format("{:.0e} %", 100 * share);
  return fmt::format("{:.{}f} %", 100 * share, share < 0.0995 ? 2 : share < 0.995 ? 1 : 0);
}

// What the table says of an observable at a setting.
std::string verdict(const Deviation& deviation, bool known) {
  if (!known) return "-";
  if (deviation.none() && deviation.floor <= Deviation::rounding) return "none";
  return deviation.none() ? fmt::format("none (< {})", percent(deviation.floor)) : percent(deviation.error);
}

std::string quotedForCsv(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

// A word in the name of a file.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) result += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return result;
}

std::string valueOf(const ObservableInfo& o) {
  if (!o.known) return fmt::format("{}: the reference did not come to it", o.name);
  return fmt::format("{} = {:.4g}{}{}, error bar {}{}", o.name, o.reference, o.unit.empty() ? "" : " ", o.unit, percent(o.bar),
                     o.spread > 0 ? fmt::format(", from seed to seed {}", percent(o.spread / o.scale)) : std::string());
}

/// Columns as wide as what is in them.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  const auto letters = [](const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
  };
  for (const auto& row : rows) {
    width.resize(std::max(width.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], letters(row[c]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) line += row[c] + std::string(width[c] - letters(row[c]) + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

Json jsonOfPoint(const Study& study, const Point& point) {
  Json json;
  json["label"] = point.label;
  json["axis"] = point.axis;
  json["at"] = point.at;
  json["overrides"] = point.overrides;
  if (!point.refused.empty()) json["refused"] = point.refused;
  if (!point.failure().empty()) json["failed"] = point.failure();
  json["cost_cpu_seconds"] = jsonOf(point.cost);
  json["bound"] = jsonOf(point.bound());
  json["pareto"] = point.pareto;
  json["errors"] = Json::object();
  for (std::size_t k = 0; k < point.deviations.size(); ++k) {
    const Deviation& d = point.deviations[k];
    json["errors"][study.observables[k].name] = {
        {"mean", jsonOf(d.mean)}, {"error", jsonOf(d.error)}, {"noise", jsonOf(d.noise)}, {"floor", jsonOf(d.floor)}, {"none", d.none()}};
  }
  json["trials"] = Json::array();
  for (const auto& [seed, outcome] : point.outcomes) {
    Json trial{{"seed", seed}, {"cpu_seconds", outcome.cost}, {"dt", outcome.timeStep}, {"grain_steps", outcome.grainSteps}};
    for (const Measured& value : outcome.values) trial["values"][value.name] = jsonOf(value.value);
    json["trials"].push_back(trial);
  }
  return json;
}

bool shown(const Point& point) { return point.ran() && point.failure().empty() && !point.deviations.empty(); }

}  // namespace

std::string tableOf(const Study& study) {
  std::string text =
      fmt::format("{}: the scene as it is takes {:.3g} s of CPU at {:.2g} of the stability limit; {} seed{} for each setting\n",
                  study.request.scene, study.scene().cost, study.safety, study.seeds, study.seeds == 1 ? "" : "s");
  if (!study.complete) text += "Interrupted: the same command goes on where this one was.\n";
  if (study.observables.empty()) return text + "Nothing can be compared yet: there is no reference.\n";
  text += study.request.features ? "The scene as it is, with which all others are compared\n" : "Reference\n";
  for (const ObservableInfo& o : study.observables) text += "  " + valueOf(o) + "\n";

  std::vector<std::vector<std::string>> rows{{"", "setting", "CPU s", "cost"}};
  for (const ObservableInfo& o : study.observables) rows[0].push_back(o.name);
  rows[0].emplace_back("at most");
  std::vector<const Point*> order;
  for (const Point& point : study.points)
    if (shown(point)) order.push_back(&point);
  std::stable_sort(order.begin(), order.end(), [](const Point* a, const Point* b) { return a->cost < b->cost; });
  for (const Point* point : order) {
    std::vector<std::string> row{point->pareto ? "*" : "", point->label, fmt::format("{:.3g}", point->cost),
                                 fmt::format("{:.2f}", point->cost / study.scene().cost)};
    for (std::size_t k = 0; k < point->deviations.size(); ++k) row.push_back(verdict(point->deviations[k], study.observables[k].known));
    row.push_back(percent(point->bound()));
    rows.push_back(row);
  }
  text +=
      fmt::format("\n{}* on the front: nothing is both cheaper and more accurate. none: within the noise of the seeds and the error bar.\n",
                  aligned(rows));
  for (const PictureQuality& picture : study.pictures)
    text += fmt::format("picture        {:<8}{:.3g} s of CPU a frame, {} from the finest (root mean square)\n", picture.quality,
                        picture.cost, percent(picture.error));
  for (const Point& point : study.points) {
    if (!point.refused.empty()) text += fmt::format("not possible   {}: {}\n", point.label, point.refused);
    if (!point.failure().empty()) text += fmt::format("failed         {}: {}\n", point.label, point.failure());
  }
  std::string leftOut;
  for (const std::string& label : study.leftOut) leftOut += (leftOut.empty() ? "" : "; ") + label;
  if (!leftOut.empty()) text += fmt::format("left out       for want of budget, whole or some seeds: {}\n", leftOut);
  for (const std::string& note : study.notes) text += fmt::format("note           {}\n", note);
  return text;
}

std::string csvOf(const Study& study) {
  std::string text =
      "axis,at,setting,cost_cpu_seconds,relative_cost,observable,unit,mean,error,noise,floor,none,bound,pareto,seeds,overrides\n";
  for (const Point& point : study.points) {
    if (!shown(point)) continue;
    std::string overrides;
    for (const std::string& override : point.overrides) overrides += (overrides.empty() ? "" : " ") + override;
    for (std::size_t k = 0; k < point.deviations.size(); ++k) {
      const Deviation& d = point.deviations[k];
      text += fmt::format("{},{:.6g},{},{:.6g},{:.6g},{},{},{:.9g},{:.6g},{:.6g},{:.6g},{},{:.6g},{},{},{}\n", point.axis, point.at,
                          quotedForCsv(point.label), point.cost, point.cost / study.scene().cost, study.observables[k].name,
                          study.observables[k].unit, d.mean, d.error, d.noise, d.floor, d.none() ? 1 : 0, point.bound(),
                          point.pareto ? 1 : 0, point.outcomes.size(), quotedForCsv(overrides));
    }
  }
  return text;
}

void writeStudy(const std::filesystem::path& file, const Study& study) {
  Json json;
  json["version"] = study.request.version;
  json["scene"] = study.request.scene;
  json["scene_key"] = study.key;
  json["given"] = study.request.overrides;
  json["end"] = study.end;
  json["complete"] = study.complete;
  json["budget_seconds"] = study.request.budget;
  json["used_seconds"] = study.used;
  json["seeds"] = study.seeds;
  json["share_of_limit"] = study.safety;
  json["observables"] = Json::array();
  for (const ObservableInfo& o : study.observables)
    json["observables"].push_back({{"name", o.name},
                                   {"unit", o.unit},
                                   {"reference", jsonOf(o.reference)},
                                   {"spread", jsonOf(o.spread)},
                                   {"error_bar", o.bar},
                                   {"scale", jsonOf(o.scale)},
                                   {"reached", o.known}});
  json["points"] = Json::array();
  for (const Point& point : study.points) json["points"].push_back(jsonOfPoint(study, point));
  for (const PictureQuality& picture : study.pictures)
    json["pictures"].push_back({{"quality", picture.quality}, {"cpu_seconds_per_frame", picture.cost}, {"error", picture.error}});
  json["left_out"] = study.leftOut;
  json["notes"] = study.notes;
  writeJson(file, json);
}

std::string plotScriptOf(const Study& study) {
  std::string text =
      "# gnuplot plot.gp, in this folder\n"
      "set datafile separator ','\n"
      "set terminal pngcairo size 960,640 font 'sans,11'\n"
      "set grid\nset key outside right top\nset style data points\nset pointsize 1.4\n";
  std::vector<std::string> axes;
  for (const Point& point : study.points)
    if (shown(point) && std::find(axes.begin(), axes.end(), point.axis) == axes.end()) axes.push_back(point.axis);
  // Errors of nought have no place on a scale of decades: they are drawn at its lower end.
  const auto at = [](const std::string& axis, const std::string& observable, const std::string& x, const std::string& y) {
    return fmt::format("(strcol(1) eq '{}' && strcol(6) eq '{}' ? {} : 1/0):({})", axis, observable, x, y);
  };
  // Along an axis the scene has a place as well; along that of steps its reference and refinement, too.
  const auto along = [](const std::string& axis, const std::string& observable, const std::string& y) {
    const std::string others = axis == "step"   ? "strstrt('scene reference refinement', strcol(1)) > 0 ? $2 : 1/0"
                               : axis == "skin" ? "1/0"
                                                : "strcol(1) eq 'scene' ? 1 : 1/0";
    return fmt::format("(strcol(6) ne '{}' ? 1/0 : strcol(1) eq '{}' ? $2 : {}):({})", observable, axis, others, y);
  };
  const std::string error = "100*($9 > 1e-5 ? $9 : 1e-5)", low = "100*($9-$10 > 1e-5 ? $9-$10 : 1e-5)", high = "100*($9+$10)";
  for (const ObservableInfo& o : study.observables) {
    if (!o.known) continue;
    text += fmt::format(
        "\nset output 'cost_{}.png'\nset title '{}: error against cost' noenhanced\nset logscale xy\n"
        "set xlabel 'CPU time, s'\nset ylabel 'error against the reference, %'\nplot ",
        plain(o.name), o.name);
    std::string parts;
    for (const std::string& axis : axes)
      parts += fmt::format("{}'tradeoff.csv' using {}:({}):({}) every ::1 with yerrorbars pt 7 title '{}' noenhanced",
                           parts.empty() ? "" : ", \\\n  ", at(axis, o.name, "$4", error), low, high, axis);
    text += parts + "\nunset logscale\n";
  }
  const std::set<std::string> numeric{"step", "stiffness", "grains", "skin"};
  for (const std::string& axis : axes) {
    if (!numeric.count(axis)) continue;
    text += fmt::format(
        "\nset output 'axis_{0}.png'\nset title 'error against {0}' noenhanced\nset logscale xy\nset xlabel '{1}' noenhanced\n"
        "set ylabel 'error against the reference, %'\nplot ",
        axis,
        axis == "step"        ? "time step over the stability limit"
        : axis == "stiffness" ? "factor on the stiffness"
        : axis == "grains"    ? "factor on the radii"
                              : "skin over the smallest radius");
    std::string parts;
    for (const ObservableInfo& o : study.observables)
      if (o.known)
        parts += fmt::format("{}'tradeoff.csv' using {}:({}):({}) every ::1 with yerrorbars pt 7 title '{}' noenhanced",
                             parts.empty() ? "" : ", \\\n  ", along(axis, o.name, error), low, high, o.name);
    text += parts + "\nunset logscale\n";
  }
  return text;
}

}  // namespace tsubu::study
