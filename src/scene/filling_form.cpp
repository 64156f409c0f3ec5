#include "scene/filling_form.h"

#include <fmt/format.h>

#include <cmath>

#include "core/names.h"

namespace tsubu::scene {

namespace {

bool saysAuto(const io::Value* value) { return value && value->text() && *value->text() == "auto"; }

std::string lowered(std::string_view sentence) {
  std::string text(sentence.substr(0, sentence.find_last_not_of('.') + 1));
  if (text.size() > 1 && ((text[1] >= 'a' && text[1] <= 'z') || text[1] == ' ') && text[0] >= 'A' && text[0] <= 'Z')
    text[0] = static_cast<char>(text[0] - 'A' + 'a');
  return text;
}

std::string quoted(std::span<const Choice> choices) {
  std::vector<std::string> words;
  for (const Choice& choice : choices) words.push_back(fmt::format("\"{}\"", choice.word));
  return listNames(words);
}

}  // namespace

void FillingForm::complain(const io::Value& value, std::string sentence, std::string hint) {
  complaints_.push_back({value.position(), std::move(sentence), std::move(hint)});
}

std::string FillingForm::pathOf(std::string_view key) const { return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key); }

const io::Value* FillingForm::find(const Field& field, std::string_view example) {
  if (givenUp_) return nullptr;
  const io::Value* value = table_ ? table_->find(field.key) : nullptr;
  if (!value && field.required) {
    const std::string sample = example.empty() ? "" : fmt::format(", for instance {} = {}", field.key, example);
    complaints_.push_back({place_.keyPosition(), fmt::format("The key '{}' is missing.", pathOf(field.key)),
                           fmt::format("{}{}", lowered(field.sentence), sample)});
  }
  return value;
}

// --- numbers ------------------------------------------------------------------------------------------------------------

std::optional<Quantity> FillingForm::toQuantity(const io::Value& value, std::span<const Dimension> dimensions) {
  if (value.integer()) return Quantity{static_cast<double>(*value.integer()), dimensions.front()};
  if (value.real()) return Quantity{*value.real(), dimensions.front()};
  if (!value.text()) {
    complain(value, fmt::format("'{}' is {}; {} was expected, such as {}.", value.path(), value.description(), nameOf(dimensions.front()),
                                exampleOf(dimensions.front())));
    return std::nullopt;
  }
  try {
    const Quantity quantity = parseQuantity(*value.text());
    std::vector<std::string> names;
    for (const Dimension& dimension : dimensions) {
      if (quantity.dimension == dimension) return quantity;
      names.push_back(nameOf(dimension));
    }
    complain(value, fmt::format("'{}' is {}; {} was expected, such as {}.", *value.text(), nameOf(quantity.dimension), listNames(names),
                                exampleOf(dimensions.front())));
  } catch (const Error& error) {
    const Diagnostic& what = error.diagnostics().front();
    complain(value,
             fmt::format("{} Expected for '{}': {}, such as {}.", what.message, value.path(), nameOf(dimensions.front()),
                         exampleOf(dimensions.front())),
             what.hint);
  }
  return std::nullopt;
}

std::optional<double> FillingForm::toNumber(const io::Value& value, Dimension dimension, const Bounds& bounds) {
  const auto quantity = toQuantity(value, {&dimension, 1});
  if (!quantity) return std::nullopt;
  if (bounds.allow(quantity->value)) return quantity->value;
  const std::string unit = unitOf(dimension);
  const std::string number = fmt::format("{}{}{}", quantity->value, unit.empty() ? "" : " ", unit);
  complain(value, fmt::format("'{}' is {}; it must be {}{}{}.", value.path(), number, bounds.description(), unit.empty() ? "" : " ", unit));
  return std::nullopt;
}

void FillingForm::quantity(const Field& field, double& value, Dimension dimension, const Bounds& bounds) {
  if (const io::Value* written = find(field, exampleOf(dimension))) value = toNumber(*written, dimension, bounds).value_or(value);
}

void FillingForm::quantityOrAuto(const Field& field, std::optional<double>& value, Dimension dimension, const Bounds& bounds) {
  const io::Value* written = find(field, exampleOf(dimension));
  if (saysAuto(written))
    value.reset();
  else if (written)
    value = toNumber(*written, dimension, bounds);
}

void FillingForm::optionalQuantity(const Field& field, std::optional<double>& value, Dimension dimension, const Bounds& bounds) {
  if (const io::Value* written = find(field, exampleOf(dimension))) value = toNumber(*written, dimension, bounds);
}

void FillingForm::quantityOfKinds(const Field& field, double& value, std::size_t& which, std::span<const Dimension> dimensions,
                                  const Bounds& bounds) {
  const io::Value* written = find(field, exampleOf(dimensions.front()));
  if (!written) return;
  const auto quantity = toQuantity(*written, dimensions);
  if (!quantity) return;
  if (!bounds.allow(quantity->value)) {
    complain(*written, fmt::format("'{}' is {}; it must be {}.", written->path(), quantity->value, bounds.description()));
    return;
  }
  value = quantity->value;
  for (which = 0; dimensions[which] != quantity->dimension;) ++which;
}

void FillingForm::quantities(const Field& field, std::vector<double>& values, Dimension dimension, const Bounds& bounds) {
  const io::Value* written = find(field, fmt::format("[{0}, {0}]", exampleOf(dimension)));
  if (!written) return;
  values.clear();
  if (!written->array() || written->array()->empty()) {
    complain(*written,
             fmt::format("'{}' is {}; an array was expected, each of it {}.", written->path(), written->description(), nameOf(dimension)));
    return;
  }
  for (const io::Value& element : *written->array()) {
    if (const auto number = toNumber(element, dimension, bounds)) values.push_back(*number);
  }
}

std::optional<Vec3> FillingForm::toVector(const io::Value& value, Dimension dimension, VectorRule rule) {
  if (!value.array() || value.array()->size() != 3) {
    complain(value, fmt::format("'{}' is {}; three numbers were expected, such as [{}, 0, 0], each {}.", value.path(), value.description(),
                                exampleOf(dimension), nameOf(dimension)));
    return std::nullopt;
  }
  Bounds bounds = anything;
  bounds.infinite = rule == VectorRule::mayBeInfinite;
  Vec3 result;
  for (int k = 0; k < 3; ++k) {
    const auto component = toNumber((*value.array())[static_cast<std::size_t>(k)], dimension, bounds);
    if (!component) return std::nullopt;
    result[k] = *component;
  }
  const double length = result.norm();
  if (rule == VectorRule::notZero && !(length > 1e-100 && std::isfinite(length))) {
    complain(value, fmt::format("'{}' has no direction.", value.path()), "write a vector of any length but zero");
    return std::nullopt;
  }
  return result;
}

void FillingForm::vector(const Field& field, Vec3& value, Dimension dimension, VectorRule rule) {
  if (const io::Value* written = find(field, fmt::format("[{}, 0, 0]", exampleOf(dimension)))) {
    value = toVector(*written, dimension, rule).value_or(value);
  }
}

void FillingForm::vectors(const Field& field, std::vector<Vec3>& values, Dimension dimension) {
  const io::Value* written = find(field, fmt::format("[[0, 0, {}]]", exampleOf(dimension)));
  if (!written) return;
  values.clear();
  if (!written->array() || written->array()->empty()) {
    complain(*written, fmt::format("'{}' is {}; an array of places was expected, such as [[0, 0, 0.1], [0, 0, 0.2]].", written->path(),
                                   written->description()));
    return;
  }
  for (const io::Value& element : *written->array()) {
    if (const auto place = toVector(element, dimension, VectorRule::any)) values.push_back(*place);
  }
}

void FillingForm::integer(const Field& field, std::uint64_t& value, std::uint64_t lower, std::uint64_t upper) {
  std::optional<std::uint64_t> written;
  const io::Value* found = find(field, std::to_string(std::max<std::uint64_t>(lower, 1)));
  if (!found) return;
  const std::int64_t* number = found->integer();
  // 1e5 is a whole number as well.
  if (!number && found->real() && *found->real() == std::floor(*found->real()) && std::abs(*found->real()) < 1e15) {
    written = *found->real() >= 0 ? std::optional(static_cast<std::uint64_t>(*found->real())) : std::nullopt;
  } else if (!number) {
    complain(*found, fmt::format("'{}' is {}; a whole number was expected.", found->path(), found->description()));
    return;
  } else if (*number >= 0) {
    written = static_cast<std::uint64_t>(*number);
  }
  if (written && *written >= lower && *written <= upper)
    value = *written;
  else
    complain(*found,
             fmt::format("'{}' is {}; it must be a whole number between {} and {}.", found->path(), found->description(), lower, upper));
}

void FillingForm::optionalInteger(const Field& field, std::optional<std::uint64_t>& value, std::uint64_t lower, std::uint64_t upper) {
  if (!table_ || !table_->has(field.key)) {
    if (table_) table_->know(field.key);
    return;
  }
  value = lower;
  integer(field, *value, lower, upper);
}

// --- words --------------------------------------------------------------------------------------------------------------

void FillingForm::boolean(const Field& field, bool& value) {
  const io::Value* written = find(field, "true");
  if (!written) return;
  if (written->boolean())
    value = *written->boolean();
  else
    complain(*written, fmt::format("'{}' is {}; true or false was expected.", written->path(), written->description()));
}

void FillingForm::text(const Field& field, std::string& value) {
  const io::Value* written = find(field, "\"…\"");
  if (!written) return;
  if (written->text())
    value = *written->text();
  else
    complain(*written, fmt::format("'{}' is {}; a text in quotes was expected.", written->path(), written->description()));
}

void FillingForm::colour(const Field& field, render::Colour& value) {
  std::optional<render::Colour> found;
  optionalColour(field, found);
  value = found.value_or(value);
}

void FillingForm::optionalColour(const Field& field, std::optional<render::Colour>& value) {
  const io::Value* written = find(field, "\"#d8b478\"");
  if (!written) return;
  if (written->text()) value = render::parseColour(*written->text());
  if (!written->text() || !value) {
    complain(*written, fmt::format("'{}' is {}; a colour was expected, such as \"#d8b478\".", written->path(), written->description()));
  }
}

void FillingForm::rangeOrAuto(const Field& field, std::optional<render::Range>& value, Dimension dimension) {
  const io::Value* written = find(field, "");
  if (!written) return;
  value.reset();
  if (saysAuto(written)) return;
  if (!written->array() || written->array()->size() != 2) {
    complain(*written, fmt::format("'{}' is {}; [low, high] was expected, each {}, or \"auto\".", written->path(), written->description(),
                                   nameOf(dimension)));
    return;
  }
  const auto low = toNumber(written->array()->front(), dimension, anything), high = toNumber(written->array()->back(), dimension, anything);
  if (!low || !high) return;
  if (*low < *high)
    value = render::Range{*low, *high};
  else
    complain(*written, fmt::format("'{}' begins at {} and ends at {}: the first must be the smaller.", written->path(), *low, *high));
}

void FillingForm::word(const Field& field, std::size_t& index, std::span<const Choice> choices) {
  const io::Value* written = find(field, fmt::format("\"{}\"", choices.front().word));
  if (!written) {
    if (field.required) index = noneOfThem;
    return;
  }
  index = whichWord(*written, choices);
}

std::size_t FillingForm::whichWord(const io::Value& value, std::span<const Choice> choices) {
  std::vector<std::string> known;
  if (value.text()) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (choices[i].word == *value.text()) return i;
      known.emplace_back(choices[i].word);
    }
  }
  const auto nearest = value.text() ? nearestName(*value.text(), known) : std::nullopt;
  complain(value, fmt::format("'{}' is {}; expected {}.", value.path(), value.description(), quoted(choices)),
           nearest ? fmt::format("did you mean '{}'?", *nearest) : std::string());
  return noneOfThem;
}

void FillingForm::someWords(const Field& field, std::span<bool> chosen, std::span<const Choice> choices) {
  const io::Value* written = find(field, fmt::format("[\"{}\"]", choices.front().word));
  if (!written) return;
  std::fill(chosen.begin(), chosen.end(), false);
  if (!written->array()) {
    complain(*written, fmt::format("'{}' is {}; an array of {} was expected.", written->path(), written->description(), quoted(choices)));
    return;
  }
  for (const io::Value& element : *written->array()) {
    const std::size_t index = whichWord(element, choices);
    if (index != noneOfThem) chosen[index] = true;
  }
}

// --- tables -------------------------------------------------------------------------------------------------------------

void FillingForm::fill(const Field& field, const io::Value& value, const Part& part) {
  if (!value.table()) {
    complain(value, fmt::format("'{}' is {}; a table was expected: {}.", value.path(), value.description(), lowered(field.sentence)));
    return;
  }
  FillingForm form(&value, value, value.path(), complaints_);
  part(form);
}

void FillingForm::table(const Field& field, const Part& part) {
  const io::Value* written = find(field, "");
  if (written) {
    fill(field, *written, part);
  } else if (!field.required && !givenUp_) {
    FillingForm form(nullptr, place_, pathOf(field.key), complaints_);
    part(form);
  }
}

void FillingForm::optionalTable(const Field& field, bool& present, const Part& part) {
  const io::Value* written = find(field, "");
  if (!written) return;
  present = true;
  fill(field, *written, part);
}

void FillingForm::list(const Field& field, Entries entries) {
  const io::Value* written = find(field, "");
  if (!written) return;
  const auto one = [&](const io::Value& value) { fill(field, value, [&](Form& form) { entries.describe(form, entries.add({})); }); };
  if (!written->array()) {
    one(*written);
  } else {
    for (const io::Value& element : *written->array()) one(element);
  }
}

void FillingForm::others(const Field& field, Entries entries) {
  if (!table_ || givenUp_) return;
  const bool nothingElse = !table_->knowsKeys();
  std::vector<std::string> written;
  for (const auto& [name, value] : *table_->table()) {
    if (!value.madeByOverride() && !table_->knows(name)) written.push_back(name);
  }
  for (const auto& [name, value] : *table_->table()) {
    if (table_->knows(name) || value.skipped()) continue;
    if (!value.table() && !nothingElse) continue;  // rather a slip in one of the other keys than a name
    if (value.madeByOverride() && !entries.open) {
      const auto nearest = nearestName(name, written);
      complaints_.push_back({value.keyPosition(), fmt::format("There is no '{}' in the scene.", value.path()),
                             nearest ? fmt::format("did you mean '{}'?", *nearest) : std::string()});
      table_->findQuietly(name)->skip();
      continue;
    }
    fill(field, *table_->findQuietly(name), [&, &own = name](Form& form) { entries.describe(form, entries.add(own)); });
  }
}

std::size_t FillingForm::whichKey(std::span<const Choice> keys, std::size_t present, bool exclusive) {
  if (givenUp_) return noneOfThem;
  if (!table_) return present;
  std::size_t found = noneOfThem;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (!table_->has(keys[i].word)) {
      table_->know(keys[i].word);
      continue;
    }
    if (found == noneOfThem) {
      found = i;
      if (!exclusive) break;
    } else {
      const io::Value* second = table_->find(keys[i].word);
      second->skip();
      complaints_.push_back(
          {second->keyPosition(), fmt::format("'{}' has both '{}' and '{}'; only one can be.", path_, keys[found].word, keys[i].word), {}});
    }
  }
  if (found == noneOfThem) {
    std::vector<std::string> names;
    for (const Choice& key : keys) names.push_back(fmt::format("'{}'", key.word));
    complaints_.push_back({place_.keyPosition(), fmt::format("'{}' needs one of the keys {}.", path_, listNames(names)), {}});
  }
  return found;
}

bool FillingForm::isPlain(std::string_view key, bool present) {
  if (!table_ || !table_->has(key)) return present;
  return !table_->find(key)->table();
}

void FillingForm::misplaced(std::string_view key, std::string_view sentence) {
  if (givenUp_ || !table_ || table_->knows(key) || !table_->has(key)) return;
  const io::Value* value = table_->findQuietly(key);
  value->skip();
  complaints_.push_back({value->keyPosition(), fmt::format("The key '{}' has no meaning in '{}'. {}", key, path_, sentence), {}});
}

void FillingForm::giveUp() {
  givenUp_ = true;
  if (table_) table_->skip();
}

}  // namespace tsubu::scene
