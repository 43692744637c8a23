#pragma once
#include "core/schema.h"
#include "sim/state.h"

namespace faba {

/// Turns the headings of cells that push against a wall parallel to the wall (theory B6):
///   d delta / dt = -rate sin(2 delta), delta the angle between heading and wall.
/// Does nothing for models without a heading (columns ux, uy).
class WallAlignment {
 public:
  WallAlignment(State& s, double rate, double dt);
  /// `nx, ny`: the wall's unit normal, pointing out of the arena.
  void touch(std::size_t agent, float nx, float ny) const {
    if (turn_ == 0.0f) return;
    const float ux = ux_[agent], uy = uy_[agent], out = ux * nx + uy * ny;
    if (out <= 0.0f) return;
    const float along = uy * nx - ux * ny;  // signed component along the wall
    const float out_after = out * (1.0f - std::min(1.0f, 2.0f * turn_ * along * along));
    const float along_after = std::copysign(std::sqrt(std::max(0.0f, 1.0f - out_after * out_after)), along);
    ux_[agent] = out_after * nx - along_after * ny;
    uy_[agent] = out_after * ny + along_after * nx;
  }
  /// The scenario key, the same for every arena.
  static FieldInfo field_info();

 private:
  std::span<float> ux_, uy_;
  float turn_ = 0;
};

}  // namespace faba
