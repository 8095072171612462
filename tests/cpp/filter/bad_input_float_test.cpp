// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/bad_input_laws.hpp"

namespace wakeline {
namespace {

INSTANTIATE_TYPED_TEST_SUITE_P(Float, BadInput, test::EveryFloatFilter, );

}  // namespace
}  // namespace wakeline
