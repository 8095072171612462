// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/long_run_laws.hpp"

namespace wakeline::long_run_float_test {
namespace {

INSTANTIATE_TYPED_TEST_SUITE_P(Float, LongRun, test::EveryFloatFilter, );

}  // namespace
}  // namespace wakeline::long_run_float_test
