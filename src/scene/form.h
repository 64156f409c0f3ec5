#pragma once
// The format of scenes is described once (describe.cpp), as a walk through forms to be filled in. Three kinds of form make three
// things of that walk: a reader fills the structs from a document, a writer prints them, and the reference explains them.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/vec.h"
#include "render/style.h"
#include "scene/units.h"

namespace tsubu::scene {

/// What every entry of a form has. An entry that is not required keeps the value it had: the default.
struct Field {
  std::string_view key;
  std::string_view sentence;  ///< for the reference, and for the message when it is missing
  bool required = false;
};
constexpr Field required(std::string_view key, std::string_view sentence) { return {key, sentence, true}; }

/// What a number may be.
struct Bounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lowerIncluded = true;
  bool infinite = false;  ///< may it be infinite ("never", "everywhere")?

  bool allow(double value) const;
  /// "positive", "at least 0", "between 0 and 1"; empty when anything goes.
  std::string description() const;
};
inline constexpr Bounds anything{};
inline constexpr Bounds positive{0, std::numeric_limits<double>::infinity(), false, false};
inline constexpr Bounds notNegative{0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Bounds notNegativeOrForever{0, std::numeric_limits<double>::infinity(), true, true};
inline constexpr Bounds share{0, 1, true, false};
constexpr Bounds between(double lower, double upper) { return {lower, upper, true, false}; }

enum class VectorRule { any, notZero, mayBeInfinite };

/// A word that may be written, with its meaning.
struct Choice {
  std::string_view word;
  std::string_view sentence;
};

class Form;

inline constexpr std::size_t noneOfThem = std::numeric_limits<std::size_t>::max();

/// Tables of which there may be any number: how many, what they are called, how to make one more, and what is in each.
struct Entries {
  std::size_t count = 0;
  bool open = false;                                   ///< the names are known from elsewhere: an override may add an entry
  std::function<std::string(std::size_t)> name;        ///< of an entry that is there
  std::function<std::size_t(const std::string&)> add;  ///< makes an entry, returns its index
  std::function<void(Form&, std::size_t)> describe;
};

class Form {
 public:
  using Part = std::function<void(Form&)>;

  virtual ~Form() = default;

  virtual void quantity(const Field& field, double& value, Dimension dimension, const Bounds& bounds = anything) = 0;
  /// Absent when the scene says "auto" or nothing.
  virtual void quantityOrAuto(const Field& field, std::optional<double>& value, Dimension dimension, const Bounds& bounds) = 0;
  /// Absent when the scene says nothing.
  virtual void optionalQuantity(const Field& field, std::optional<double>& value, Dimension dimension, const Bounds& bounds) = 0;
  /// A quantity of one of several dimensions; `which` says of which. A number without a unit has the first.
  virtual void quantityOfKinds(const Field& field, double& value, std::size_t& which, std::span<const Dimension> dimensions,
                               const Bounds& bounds) = 0;
  /// As many as the scene writes, at least one.
  virtual void quantities(const Field& field, std::vector<double>& values, Dimension dimension, const Bounds& bounds) = 0;
  virtual void vector(const Field& field, Vec3& value, Dimension dimension, VectorRule rule = VectorRule::any) = 0;
  virtual void vectors(const Field& field, std::vector<Vec3>& values, Dimension dimension) = 0;
  virtual void integer(const Field& field, std::uint64_t& value, std::uint64_t lower, std::uint64_t upper) = 0;
  /// Absent when the scene says nothing.
  virtual void optionalInteger(const Field& field, std::optional<std::uint64_t>& value, std::uint64_t lower, std::uint64_t upper) = 0;
  virtual void boolean(const Field& field, bool& value) = 0;
  virtual void text(const Field& field, std::string& value) = 0;
  virtual void colour(const Field& field, render::Colour& value) = 0;
  virtual void optionalColour(const Field& field, std::optional<render::Colour>& value) = 0;
  /// Two numbers, low and high, or "auto".
  virtual void rangeOrAuto(const Field& field, std::optional<render::Range>& value, Dimension dimension) = 0;
  virtual void word(const Field& field, std::size_t& index, std::span<const Choice> choices) = 0;
  /// Which of the words are in an array; `chosen[i]` belongs to `choices[i]`.
  virtual void someWords(const Field& field, std::span<bool> chosen, std::span<const Choice> choices) = 0;

  /// A table inside this one.
  virtual void table(const Field& field, const Part& part) = 0;
  /// A table that may be absent; then `present` is false and the part is not asked.
  virtual void optionalTable(const Field& field, bool& present, const Part& part) = 0;
  /// One table, or an array of them.
  virtual void list(const Field& field, Entries entries) = 0;
  /// Every table in this one that has not been asked for by its key.
  virtual void others(const Field& field, Entries entries) = 0;

  /// Which of several keys is written: the first there is; `present` is the one that the value in hand has. `noneOfThem` when a
  /// complaint has been made because there is none, or more than one where they exclude each other.
  virtual std::size_t whichKey(std::span<const Choice> keys, std::size_t present, bool exclusive) = 0;
  /// Is the value of this key something else than a table? `present`: so for the value in hand.
  virtual bool isPlain(std::string_view key, bool present) = 0;
  /// These keys do not belong here; the sentence says where they do.
  virtual void misplaced(std::string_view key, std::string_view sentence) = 0;
  /// True when every alternative is wanted and not just the one that applies.
  virtual bool wantsAll() const { return false; }
  /// The fields until the matching end belong to one alternative (`source = "stream"`); only told to a form that wants all.
  virtual void beginAlternative(std::string_view) {}
  virtual void endAlternative() {}
  /// The kind is not known: nothing more can be said about this table.
  virtual void giveUp() {}
};

}  // namespace tsubu::scene
