#include "rig/sim_rig.h"

#include <algorithm>

namespace faba {

SimRig::SimRig(World& world, const Params& p) : world_(world), p_(p), frame_(world.parts().arena->frame()) {}

std::vector<Detection> SimRig::look() const {
  const auto x = world_.state().agents["x"], y = world_.state().agents["y"];
  std::vector<Detection> seen(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    seen[i] = {x[i], y[i], frame_.in_view(frame_.image_from_world({double(x[i]), double(y[i])}))};
  return seen;
}

bool SimRig::read(Observation& out) {
  if (next_ > 0) {
    for (int i = 0; i < p_.steps_per_frame; ++i) {
      world_.step();
      if (give_up_ && give_up_()) return false;
    }
    world_.check_finite();
  }
  seen_.push_back(look());
  if (seen_.size() > std::size_t(p_.delay_frames) + 1) seen_.pop_front();
  out.frame = next_;
  out.t = (double(next_) - p_.delay_frames) * p_.frame_period;
  out.age = p_.delay_frames * p_.frame_period;
  out.seen = seen_.front();
  ++next_;
  return true;
}

void SimRig::safe() noexcept {
  try {
    world_.command(std::vector<double>(world_.parts().field->coils(), 0.0));
  } catch (...) {  // out of memory while stopping a simulation: there is no coil to harm
    return;
  }
}

void SimRig::archive(Archive& a) {
  a& next_;
  std::uint64_t kept = seen_.size();
  a& kept;
  seen_.resize(std::size_t(std::min<std::uint64_t>(kept, std::uint64_t(p_.delay_frames) + 1)));
  std::vector<float> xy;
  for (auto& frame : seen_) {
    xy.clear();
    for (const Detection& d : frame) xy.insert(xy.end(), {d.x, d.y});
    a& xy;
    if (!a.reading()) continue;
    frame.resize(xy.size() / 2);
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const float x = xy[2 * i], y = xy[2 * i + 1];
      frame[i] = {x, y, frame_.in_view(frame_.image_from_world({double(x), double(y)}))};
    }
  }
}

}  // namespace faba
