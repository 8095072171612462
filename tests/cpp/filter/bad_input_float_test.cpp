// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/bad_input_laws.hpp"

namespace wakeline::bad_input_float_test {
namespace {

INSTANTIATE_TYPED_TEST_SUITE_P(Float, BadInput, test::EveryFloatFilter, );

}  // namespace
}  // namespace wakeline::bad_input_float_test
