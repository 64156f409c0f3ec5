#pragma once
// A list of types, all combinations of three lists, and the step from a number to a type.

#include <cstddef>
#include <type_traits>
#include <utility>

namespace tsubu::sim {

template <class... Types>
struct TypeList {
  static constexpr std::size_t size = sizeof...(Types);
};

template <class... Lists>
struct Joined;
template <class... A>
struct Joined<TypeList<A...>> {
  using type = TypeList<A...>;
};
template <class... A, class... B, class... Rest>
struct Joined<TypeList<A...>, TypeList<B...>, Rest...> : Joined<TypeList<A..., B...>, Rest...> {};

template <template <class, class, class> class Law, class A, class B, class Cs>
struct WithThird;
template <template <class, class, class> class Law, class A, class B, class... C>
struct WithThird<Law, A, B, TypeList<C...>> {
  using type = TypeList<Law<A, B, C>...>;
};
template <template <class, class, class> class Law, class A, class Bs, class Cs>
struct WithSecond;
template <template <class, class, class> class Law, class A, class... B, class Cs>
struct WithSecond<Law, A, TypeList<B...>, Cs> : Joined<typename WithThird<Law, A, B, Cs>::type...> {};
template <template <class, class, class> class Law, class As, class Bs, class Cs>
struct WithFirst;
template <template <class, class, class> class Law, class... A, class Bs, class Cs>
struct WithFirst<Law, TypeList<A...>, Bs, Cs> : Joined<typename WithSecond<Law, A, Bs, Cs>::type...> {};

/// Law<A, B, C> for all A, B, C of three lists, the last running fastest.
template <template <class, class, class> class Law, class As, class Bs, class Cs>
using Combinations = typename WithFirst<Law, As, Bs, Cs>::type;

/// Calls f.template operator()<T>() for every type.
template <class... Types, class F>
constexpr void forEachType(TypeList<Types...>, F&& f) {
  (f.template operator()<Types>(), ...);
}

namespace detail {
template <class Result, class First, class... Rest, class Visitor>
constexpr Result visit(TypeList<First, Rest...>, std::size_t index, Visitor& visitor) {
  if constexpr (sizeof...(Rest) == 0)
    return visitor.template operator()<First>();
  else
    return index == 0 ? visitor.template operator()<First>() : visit<Result>(TypeList<Rest...>{}, index - 1, visitor);
}
template <class First, class... Rest>
First firstOf(TypeList<First, Rest...>);
}  // namespace detail

/// Calls visitor.template operator()<T>() for the type with this index (the last one when the index is too large).
template <class List, class Visitor>
constexpr decltype(auto) visitType(std::size_t index, Visitor& visitor) {
  using First = decltype(detail::firstOf(List{}));
  using Result = decltype(visitor.template operator()<First>());
  return detail::visit<Result>(List{}, index, visitor);
}

}  // namespace tsubu::sim
