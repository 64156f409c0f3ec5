#pragma once
// Variants in forms: the alternative is named by a word, or shown by which key is there.

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scene/form.h"

namespace tsubu::scene {

/// The default value of the alternative with this index.
template <class Variant>
Variant makeAlternative(std::size_t index) {
  return [index]<std::size_t... I>(std::index_sequence<I...>) {
    const std::array<Variant, sizeof...(I)> all{Variant(std::in_place_index<I>)...};
    return all[index];
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>{});
}

/// Describes the alternative with this index, or all of them for a form that wants all, each under `title(i)`.
template <class Variant, class Each, class Title>
void describeAlternative(Form& form, Variant& value, std::size_t index, Each&& each, Title&& title) {
  if (form.wantsAll()) {
    for (std::size_t i = 0; i < std::variant_size_v<Variant>; ++i) {
      form.beginAlternative(title(i));
      Variant example = makeAlternative<Variant>(i);
      std::visit(each, example);
      form.endAlternative();
    }
  } else if (index != noneOfThem) {
    if (index != value.index()) value = makeAlternative<Variant>(index);
    std::visit(each, value);
  }
}

/// The alternative is the word in `field`; choices in the order of the variant.
template <class Variant, class Each>
void byWord(Form& form, const Field& field, Variant& value, std::span<const Choice> choices, Each&& each) {
  std::size_t index = value.index();
  form.word(field, index, choices);
  if (index == noneOfThem) form.giveUp();
  describeAlternative(form, value, index, each, [&](std::size_t i) { return fmt::format("{} = \"{}\"", field.key, choices[i].word); });
}

/// The alternative is the first of `keys` that is there, in the order of the variant; `each` asks for that key.
template <class Variant, class Each>
void byKey(Form& form, Variant& value, std::span<const Choice> keys, bool exclusive, Each&& each) {
  const std::size_t index = form.wantsAll() ? 0 : form.whichKey(keys, value.index(), exclusive);
  describeAlternative(form, value, index, each, [&](std::size_t i) { return fmt::format("with `{}`", keys[i].word); });
}

/// An enumeration whose values are 0, 1, … in the order of the choices.
template <class Enum>
void words(Form& form, const Field& field, Enum& value, std::span<const Choice> choices) {
  std::size_t index = static_cast<std::size_t>(value);
  form.word(field, index, choices);
  if (index != noneOfThem) value = static_cast<Enum>(index);
}

/// An enumeration of the renderer, with its own table of words.
template <class Enum, std::size_t n>
void words(Form& form, const Field& field, Enum& value, const std::array<render::Word<Enum>, n>& table) {
  std::vector<Choice> choices;
  std::size_t index = 0;
  for (std::size_t i = 0; i < n; ++i) {
    choices.push_back({table[i].text, {}});
    if (table[i].value == value) index = i;
  }
  form.word(field, index, choices);
  if (index != noneOfThem) value = table[index].value;
}

/// Named tables for the elements of a vector with a member `name`.
template <class T, class Describe>
Entries namedEntries(std::vector<T>& items, Describe describeItem) {
  Entries entries;
  entries.count = items.size();
  entries.name = [&items](std::size_t i) { return items[i].name; };
  entries.add = [&items](const std::string& name) {
    items.emplace_back();
    items.back().name = name;
    return items.size() - 1;
  };
  entries.describe = [&items, describeItem](Form& form, std::size_t i) {
    if (form.wantsAll()) {
      T example;
      describeItem(form, example);
    } else {
      describeItem(form, items[i]);
    }
  };
  return entries;
}

/// The same for tables without names.
template <class T, class Describe>
Entries plainEntries(std::vector<T>& items, Describe describeItem) {
  Entries entries;
  entries.count = items.size();
  entries.name = [](std::size_t i) { return std::to_string(i); };
  entries.add = [&items](const std::string&) {
    items.emplace_back();
    return items.size() - 1;
  };
  entries.describe = [&items, describeItem](Form& form, std::size_t i) {
    if (form.wantsAll()) {
      T example;
      describeItem(form, example);
    } else {
      describeItem(form, items[i]);
    }
  };
  return entries;
}

}  // namespace tsubu::scene
