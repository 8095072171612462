// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A filter, and an Imm of filters: in one file, so that both share what the filters compile to.
#include "job.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"
#include "wakeline/multimodel/variant_bank.hpp"

namespace wakeline::python {
namespace {

/// The same Imm over another bank.
template <class Bank>
bool run_over(const Bank& bank, const AnyImm& any, const LaneRecordings& recordings) {
  return run_from<static_cast<int>(Bank::kComponents.size())>(imm_over(bank, any), recordings);
}

using Turn = Ekf<CoordinatedTurn, Lanes>;

/// Of K of them, or of a number known at run time.
template <int K>
bool run_turns(const std::vector<Turn>& filters, const AnyImm& any,
               const LaneRecordings& recordings) {
  return run_over(UniformBank<Turn, K>(std::span<const Turn>(filters)), any, recordings);
}

/// Extended Kalman filters of known turns, or of none. With the number of models known at compile
/// time, three and five, the usual ones, take a tenth less.
bool run_turns(const AnyImm& any, const LaneRecordings& recordings) {
  const auto filters = filters_as<Turn>(
      any.bank(),
      [](const auto& filter) -> decltype(in_lanes(filter)) { return in_lanes(filter); });
  switch (filters.size()) {
    case 0:
      return false;
    case 3:
      return run_turns<3>(filters, any, recordings);
    case 5:
      return run_turns<5>(filters, any, recordings);
    default:
      return run_turns<kRuntimeModes>(filters, any, recordings);
  }
}

/// A filter as one of some kinds over packs.
template <class Kinds>
struct Into {
  template <class Filter>
  requires(std::is_constructible_v<Kinds, InLanesOf<Filter>>) Kinds operator()(
      const Filter& filter) const {
    return Kinds(in_lanes(filter));
  }
};

/// Filters of any of the kinds, whose combined estimate is over the state they share, else over
/// position and velocity.
template <class... Kinds>
bool run_kinds(TypeList<Kinds...>, const AnyImm& any, const LaneRecordings& recordings) {
  using Bank = VariantBank<kMaxModes, Kinds...>;
  if (recordings.out.states != Bank::kComponents.size()) return false;
  const auto filters = filters_as<typename Bank::Filter>(any.bank(), Into<typename Bank::Filter>{});
  return !filters.empty() &&
         run_over(Bank(std::span<const typename Bank::Filter>(filters)), any, recordings);
}

template <class Filter>
struct IsForPacks : std::bool_constant<kForPacks<typename InLanesOf<Filter>::Motion>> {};

template <StateLayout Layout>
struct OfLayout {
  template <class Filter>
  struct Has : std::bool_constant<kLayoutOf<typename Filter::Motion> == Layout> {};
};

using Packed = Distinct<Mapped<InLanesOf, Selected<IsForPacks, MotionFilters>>>;

/// Over each layout but that of position and velocity alone.
template <int... Layout>
bool run_alike(std::integer_sequence<int, Layout...>, const AnyImm& any,
               const LaneRecordings& recordings) {
  return (run_kinds(Selected<OfLayout<StateLayout(Layout + 1)>::template Has, Packed>{}, any,
                    recordings) ||
          ...);
}

}  // namespace

bool run_filter(const AnyFilter& any, const LaneRecordings& recordings) {
  return std::visit(
      [&]<class Filter>(const Filter& filter) {
        if constexpr (requires { requires kForPacks<typename InLanesOf<Filter>::Motion>; })
          return run_from<Filter::kStates>(in_lanes(filter), recordings);
        else
          return false;
      },
      any.variant());
}

bool run_imm(const AnyImm& any, const LaneRecordings& recordings) {
  return run_turns(any, recordings) ||
         run_alike(std::make_integer_sequence<int, kStateLayouts.count - 1>{}, any, recordings) ||
         run_kinds(Packed{}, any, recordings);
}

}  // namespace wakeline::python
