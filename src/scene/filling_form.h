#pragma once
// The form that reads: fills the structs from the tables of a document and collects what is wrong.

#include <vector>

#include "core/error.h"
#include "io/document.h"
#include "scene/form.h"

namespace tsubu::scene {

class FillingForm : public Form {
 public:
  /// `table` may be nullptr: nothing is written, everything keeps its default, and what is required is missing at `place`.
  FillingForm(const io::Value* table, const io::Value& place, std::string path, std::vector<Diagnostic>& complaints)
      : table_(table), place_(place), path_(std::move(path)), complaints_(complaints) {}

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
  std::size_t whichKey(std::span<const Choice> keys, std::size_t present, bool exclusive) override;
  bool isPlain(std::string_view key, bool present) override;
  void misplaced(std::string_view key, std::string_view sentence) override;
  void giveUp() override;

 private:
  const io::Value* find(const Field& field, std::string_view example);
  void complain(const io::Value& value, std::string sentence, std::string hint = {});
  void fill(const Field& field, const io::Value& value, const Part& part);
  std::string pathOf(std::string_view key) const;
  /// Complains and returns `noneOfThem` when it is none of them.
  std::size_t whichWord(const io::Value& value, std::span<const Choice> choices);
  std::optional<Quantity> toQuantity(const io::Value& value, std::span<const Dimension> dimensions);
  std::optional<double> toNumber(const io::Value& value, Dimension dimension, const Bounds& bounds);
  std::optional<Vec3> toVector(const io::Value& value, Dimension dimension, VectorRule rule);

  const io::Value* table_;
  const io::Value& place_;
  std::string path_;
  std::vector<Diagnostic>& complaints_;
  bool givenUp_ = false;
};

}  // namespace tsubu::scene
