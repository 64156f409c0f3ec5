#pragma once
// The form that prints: `key = value` lines and [table] headers.

#include <string>
#include <vector>

#include "scene/form.h"

namespace tsubu::scene {

/// Values in the syntax of a scene file, SI without units, such that reading gives the same bits.
std::string valueText(double value);
std::string valueText(const Vec3& value);
std::string valueText(const std::string& text);
std::string valueText(render::Colour colour);

class ShowingForm : public Form {
 public:
  explicit ShowingForm(std::string path = {}) : path_(std::move(path)) {}
  /// The lines of this table, then its tables, with their headers.
  std::string text() const;

  void quantity(const Field& field, double& value, Dimension dimension, const Bounds& bounds) override;
  void quantityOrAuto(const Field& field, std::optional<double>& value, Dimension dimension, const Bounds& bounds) override;
  void optionalQuantity(const Field& field, std::optional<double>& value, Dimension dimension, const Bounds& bounds) override;
  void quantityOfKinds(const Field& field, double& value, std::size_t& which, std::span<const Dimension> dimensions,
                       const Bounds& bounds) override;
  void quantities(const Field& field, std::vector<double>& values, Dimension dimension, const Bounds& bounds) override;
  void vector(const Field& field, Vec3& value, Dimension dimension, VectorRule rule) override;
  void vectors(const Field& field, std::vector<Vec3>& values, Dimension dimension) override;
  void integer(const Field& field, std::uint64_t& value, std::uint64_t lower, std::uint64_t upper) override;
  void optionalInteger(const Field& field, std::optional<std::uint64_t>& value, std::uint64_t lower, std::uint64_t upper) override;
  void boolean(const Field& field, bool& value) override;
  void text(const Field& field, std::string& value) override;
  void colour(const Field& field, render::Colour& value) override;
  void optionalColour(const Field& field, std::optional<render::Colour>& value) override;
  void rangeOrAuto(const Field& field, std::optional<render::Range>& value, Dimension dimension) override;
  void word(const Field& field, std::size_t& index, std::span<const Choice> choices) override;
  void someWords(const Field& field, std::span<bool> chosen, std::span<const Choice> choices) override;
  void table(const Field& field, const Part& part) override;
  void optionalTable(const Field& field, bool& present, const Part& part) override;
  void list(const Field& field, Entries entries) override;
  void others(const Field& field, Entries entries) override;
  std::size_t whichKey(std::span<const Choice>, std::size_t present, bool) override { return present; }
  bool isPlain(std::string_view, bool present) override { return present; }
  void misplaced(std::string_view, std::string_view) override {}

 private:
  void line(const Field& field, std::string value);
  void inner(std::string path, std::string header, const Part& part);

  std::string path_, lines_, tables_;
};

}  // namespace tsubu::scene
