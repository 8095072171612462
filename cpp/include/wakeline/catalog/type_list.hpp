// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/environment.hpp"

#include <type_traits>
#include <variant>

namespace wakeline {

/// A closed list of types.
template <class... Types>
struct TypeList {
  static constexpr int kSize = sizeof...(Types);

  /// Calls `f(std::type_identity<Type>{})` for each type in turn.
  template <class Function>
  static constexpr void for_each(Function&& function) {
    (function(std::type_identity<Types>{}), ...);
  }
};

/// The types of several lists, in order.
template <class... Lists>
struct JoinedLists;
template <class... Types>
struct JoinedLists<TypeList<Types...>> {
  using Type = TypeList<Types...>;
};
template <class... First, class... Second, class... Rest>
struct JoinedLists<TypeList<First...>, TypeList<Second...>, Rest...>
    : JoinedLists<TypeList<First..., Second...>, Rest...> {};
template <class... Lists>
using Joined = typename JoinedLists<Lists...>::Type;

/// `Template` of each type of a list.
template <template <class> class Template, class List>
struct MappedList;
template <template <class> class Template, class... Types>
struct MappedList<Template, TypeList<Types...>> {
  using Type = TypeList<Template<Types>...>;
};
template <template <class> class Template, class List>
using Mapped = typename MappedList<Template, List>::Type;

/// The types of a list of which `Predicate<Type>::value` is true.
template <template <class> class Predicate, class List>
struct SelectedList;
template <template <class> class Predicate, class... Types>
struct SelectedList<Predicate, TypeList<Types...>> {
  using Type = Joined<TypeList<>,
                      std::conditional_t<Predicate<Types>::value, TypeList<Types>, TypeList<>>...>;
};
template <template <class> class Predicate, class List>
using Selected = typename SelectedList<Predicate, List>::Type;

/// Each type of a list once.
template <class Kept, class List>
struct DistinctList {
  using Type = Kept;
};
template <class... Kept, class Next, class... Rest>
struct DistinctList<TypeList<Kept...>, TypeList<Next, Rest...>>
    : DistinctList<std::conditional_t<(std::is_same_v<Next, Kept> || ...), TypeList<Kept...>,
                                      TypeList<Kept..., Next>>,
                   TypeList<Rest...>> {};
template <class List>
using Distinct = typename DistinctList<TypeList<>, List>::Type;

/// A variant of the types of a list.
template <class List>
struct VariantOfList;
template <class... Types>
struct VariantOfList<TypeList<Types...>> {
  using Type = std::variant<Types...>;
};
template <class List>
using AsVariant = typename VariantOfList<List>::Type;

}  // namespace wakeline
