// SPDX-License-Identifier: MIT
#include "device/session/pouring.h"

#include <algorithm>
#include <cmath>

namespace wholehand::device {

Pouring::Pouring(const std::vector<double>& volumes, const std::optional<TaskData>& task, double gravity, double rate)
    : task_(task), gravity_(gravity), rate_(rate) {
  std::copy_n(volumes.begin(), std::min<std::size_t>(volumes.size(), LIVE_VESSELS), volume_.begin());
  falling_.resize(static_cast<std::size_t>(std::ceil(LONGEST_FALL * rate)) + 2);  // a drop a tick
}

double Pouring::pour(int vessel, double held_back, core_f64::Vec3 lip, std::int64_t number, double seconds) noexcept {
  const double excess = volume_[vessel] - held_back;
  if (!(excess > LEAST_DROP) || !(seconds > 0)) return 0;
  const double leaves = std::min(volume_[vessel], -excess * std::expm1(-seconds / POUR_TIME));
  volume_[vessel] -= leaves;
  const double flow = leaves / seconds;
  bool hits = false;
  double fall = 0;
  if (task_) {
    const Triple& mouth = task_->target_place;
    const double height = lip.y - mouth[1];
    hits = height >= 0 && std::hypot(lip.x - mouth[0], lip.z - mouth[2]) <= 0.5 * task_->target_diameter;
    fall = std::min(LONGEST_FALL, gravity_ > 0 ? std::sqrt(2 * std::max(0.0, height) / gravity_) : LONGEST_FALL);
  }
  if (!hits || count_ == falling_.size()) {
    spilled_[vessel] += leaves;
    return flow;
  }
  falling_[(first_ + count_) % falling_.size()] = {number + static_cast<std::int64_t>(std::lround(fall * rate_)), vessel, leaves};
  ++count_;
  return flow;
}

void Pouring::land(std::int64_t number) noexcept {
  // a later drop from lower down waits for the one before it: at most milliseconds
  while (count_ > 0 && falling_[first_].lands <= number) {
    arrived_[falling_[first_].vessel] += falling_[first_].volume;
    first_ = (first_ + 1) % falling_.size();
    --count_;
  }
}

}  // namespace wholehand::device
