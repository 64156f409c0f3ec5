#pragma once
// A list of types, all combinations of lists, and the step from a number to a type.

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace tsubu::sim {

template <class... Types>
struct TypeList {
  static constexpr std::size_t size = sizeof...(Types);
};

namespace detail {

template <class... Lists>
struct Joined {
  using type = TypeList<>;
};
template <class... A>
struct Joined<TypeList<A...>> {
  using type = TypeList<A...>;
};
template <class... A, class... B, class... Rest>
struct Joined<TypeList<A...>, TypeList<B...>, Rest...> : Joined<TypeList<A..., B...>, Rest...> {};

// Fills the places of Law one list at a time.
template <template <class...> class Law, class Done, class... Lists>
struct Combined;
template <template <class...> class Law, class... Done>
struct Combined<Law, TypeList<Done...>> {
  using type = TypeList<Law<Done...>>;
};
template <template <class...> class Law, class... Done, class... First, class... Rest>
struct Combined<Law, TypeList<Done...>, TypeList<First...>, Rest...>
    : Joined<typename Combined<Law, TypeList<Done..., First>, Rest...>::type...> {};

}  // namespace detail

/// Law<A, B, …> for all A, B, … of the lists, the last running fastest.
template <template <class...> class Law, class... Lists>
using Combinations = typename detail::Combined<Law, TypeList<>, Lists...>::type;

/// Calls f.template operator()<T>() for every type.
template <class... Types, class F>
constexpr void forEachType(TypeList<Types...>, F&& f) {
  (f.template operator()<Types>(), ...);
}

/// What f.template operator()<T>() returns, type by type: a number becomes a type by looking up what was made for it.
template <class... Types, class F>
constexpr auto tableOf(TypeList<Types...>, F&& f) {
  return std::array{f.template operator()<Types>()...};
}

}  // namespace tsubu::sim
