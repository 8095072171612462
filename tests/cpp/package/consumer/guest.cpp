// A project that has wakeline in a folder of its own.
#include <wakeline/filter/ekf.hpp>
#include <wakeline/motion/constant_velocity.hpp>

int main() {
  wakeline::Ekf filter{wakeline::ConstantVelocity{}};
  return filter.start({}) == wakeline::Status::kOk ? 0 : 1;
}
