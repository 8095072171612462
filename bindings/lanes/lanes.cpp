// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <pybind11/pybind11.h>

#include "job.hpp"

namespace wakeline::python {
namespace {

class Vessels : public VesselLanes {
 public:
  explicit Vessels(const VesselImm& prototype) : side_by_side_(prototype) {}
  void predict(std::span<PredictionStep<VesselImm>> steps) noexcept override {
    side_by_side_.predict(steps);
  }
  void update(std::span<UpdateStep<VesselImm>> steps) noexcept override {
    side_by_side_.update(steps);
  }

 private:
  SideBySide<VesselImm> side_by_side_;
};

std::unique_ptr<VesselLanes> vessels(const VesselImm& prototype) {
  return std::make_unique<Vessels>(prototype);
}

}  // namespace
}  // namespace wakeline::python

PYBIND11_MODULE(WAKELINE_LANES_MODULE, m) {
  using namespace wakeline::python;
  static constexpr LaneKernels kKernels{
      wakeline::kNativeLanes<double>, &run_filter, &run_imm, &run_linear, &run_history, &vessels};
  m.doc() = "Estimators in lanes, for one instruction set.";
  m.attr("kernels") = pybind11::capsule(static_cast<const void*>(&kKernels), "wakeline.lanes");
}
