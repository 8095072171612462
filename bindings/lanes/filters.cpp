// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A filter, and an Imm of filters: in one file, so that both share what the filters compile to.
#include <optional>

#include "job.hpp"
#include "linear_motion.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"
#include "wakeline/multimodel/variant_bank.hpp"

namespace wakeline::python {
namespace {

/// A motion model as lanes have it.
template <class Motion>
auto lane_motion(const Motion& motion) {
  if constexpr (LinearMotionModel<Motion>)
    return LinearInLanes<kLayoutOf<Motion>>(motion);
  else
    return motion;
}

template <class Filter>
using InLanesOf = decltype(in_lanes(std::declval<const Filter&>(),
                                    lane_motion(std::declval<const Filter&>().motion())));

template <class Filter>
struct IsForPacks : std::bool_constant<kForPacks<typename Filter::Motion>> {};

/// The filters that have lanes.
using Packed = Distinct<Mapped<InLanesOf, Selected<IsForPacks, MotionFilters>>>;
using AnyPacked = AsVariant<Packed>;

/// A filter over packs with the same parameters. None of a motion model that is not for packs, or
/// of a linear one made at run time whose matrices have not the pattern of those of the catalogue.
std::optional<AnyPacked> packed(const AnyFilter& any, const RunInput& in) {
  std::optional<AnyPacked> result;
  std::visit(
      [&]<class Filter>(const Filter& filter) {
        if constexpr (requires { requires IsForPacks<Filter>::value; })
          result.emplace(in_lanes(filter, lane_motion(filter.motion())));
      },
      any.variant());
  const auto* const custom = std::get_if<CustomFilter>(&any.variant());
  if (custom == nullptr || !custom->motion()->linear()) return result;
  Packed::for_each([&]<class Filter>(std::type_identity<Filter>) {
    using Motion = typename Filter::Motion;
    if constexpr (std::is_constructible_v<Motion, const CustomMotion&>) {
      if (custom->motion()->layout() != kLayoutOf<Motion>) return;
      const Motion motion(*custom->motion());
      if constexpr (std::is_same_v<Filter, Ekf<Motion, Lanes>>)
        if (custom->unscented() == nullptr && motion.fits(in)) result.emplace(Filter(motion));
      if constexpr (std::is_same_v<Filter, Ukf<Motion, Lanes>>)
        if (custom->unscented() != nullptr && motion.fits(in))
          result.emplace(Filter(motion, *custom->unscented()));
    }
  });
  return result;
}

/// The filters as a `Kind`, where they all are one; else none.
template <class Kind>
std::vector<Kind> all_as(const std::vector<AnyPacked>& filters) {
  std::vector<Kind> kinds;
  for (const AnyPacked& any : filters)
    std::visit(
        [&]<class Filter>(const Filter& filter) {
          if constexpr (std::is_constructible_v<Kind, const Filter&>) kinds.push_back(Kind(filter));
        },
        any);
  if (kinds.size() < filters.size()) kinds.clear();
  return kinds;
}

/// The same Imm over another bank.
template <class Bank>
bool run_over(const Bank& bank, const AnyImm& any, const LaneRecordings& recordings) {
  return run_from<static_cast<int>(Bank::kComponents.size())>(imm_over(bank, any), recordings);
}

using Plane = Ekf<LinearInLanes<StateLayout::kKinematics>, Lanes>;

/// Of K of them, or of a number known at run time.
template <int K>
bool run_planes(const std::vector<Plane>& filters, const AnyImm& any,
                const LaneRecordings& recordings) {
  return run_over(UniformBank<Plane, K>(std::span<const Plane>(filters)), any, recordings);
}

/// Extended Kalman filters of linear models over position and velocity. With the number of models
/// known at compile time, three and five, the usual ones, take a tenth less.
bool run_planes(const std::vector<AnyPacked>& all, const AnyImm& any,
                const LaneRecordings& recordings) {
  const auto filters = all_as<Plane>(all);
  switch (filters.size()) {
    case 0:
      return false;
    case 3:
      return run_planes<3>(filters, any, recordings);
    case 5:
      return run_planes<5>(filters, any, recordings);
    default:
      return run_planes<kRuntimeModes>(filters, any, recordings);
  }
}

/// Filters of any of the kinds, whose combined estimate is over the state they share, else over
/// position and velocity.
template <class... Kinds>
bool run_kinds(TypeList<Kinds...>, const std::vector<AnyPacked>& all, const AnyImm& any,
               const LaneRecordings& recordings) {
  using Bank = VariantBank<kMaxModes, Kinds...>;
  if (recordings.out.states != Bank::kComponents.size()) return false;
  const auto filters = all_as<typename Bank::Filter>(all);
  return !filters.empty() &&
         run_over(Bank(std::span<const typename Bank::Filter>(filters)), any, recordings);
}

template <StateLayout Layout>
struct OfLayout {
  template <class Filter>
  struct Has : std::bool_constant<kLayoutOf<typename Filter::Motion> == Layout> {};
};

/// Over each layout but that of position and velocity alone.
template <int... Layout>
bool run_alike(std::integer_sequence<int, Layout...>, const std::vector<AnyPacked>& all,
               const AnyImm& any, const LaneRecordings& recordings) {
  return (run_kinds(Selected<OfLayout<StateLayout(Layout + 1)>::template Has, Packed>{}, all, any,
                    recordings) ||
          ...);
}

}  // namespace

bool run_filter(const AnyFilter& any, const LaneRecordings& recordings) {
  const std::optional<AnyPacked> one = packed(any, recordings.in);
  return one && std::visit(
                    [&]<class Filter>(const Filter& filter) {
                      return run_from<Filter::kStates>(filter, recordings);
                    },
                    *one);
}

bool run_imm(const AnyImm& any, const LaneRecordings& recordings) {
  std::vector<AnyPacked> all;
  for (int k = 0; k < any.bank().size(); ++k) {
    const std::optional<AnyPacked> one = packed(any.bank().filter(k), recordings.in);
    if (!one) return false;
    all.push_back(*one);
  }
  return run_planes(all, any, recordings) ||
         run_alike(std::make_integer_sequence<int, kStateLayouts.count - 1>{}, all, any,
                   recordings) ||
         run_kinds(Packed{}, all, any, recordings);
}

}  // namespace wakeline::python
