#include "control/plant/steering.h"

#include <cmath>

namespace faba {

Steering::Steering(const MotionParams& motion, double max_output, const ControlContext& c)
    : c_(c),
      strongest_(max_output * c.scale.field_unit),
      plant_(motion.of(c.motion)),
      delay_(std::size_t(std::lround(c.delay_frames))) {
  given_.assign(delay_, Vec2{});
  modulated_ = plant_.response == SwarmMotion::Response::constant;
  if (modulated_)
    plant_ = {.response = SwarmMotion::Response::proportional, .mobility = plant_.speed / strongest_};
}

double Steering::max_field() const {
  const Vec3 ambient = c_.field->ambient();
  return strongest_ + norm(Vec2{ambient.x, ambient.y});
}

MeanState Steering::at_command(const Estimate& e) const {
  MeanState s{e.centroid, e.velocity};
  if (e.predicted) return s;
  for (const Vec2 along : given_) s = advanced(plant_, 1, s, along, c_.frame_period);
  return s;
}

Command Steering::linear(Vec2 at, Vec2 a) const {
  const Vec3 ambient = c_.field->ambient();
  const Vec2 added = (double(c_.polarity) / c_.scale.field_unit) * Vec2{ambient.x, ambient.y};
  return field_command(c_, at, (strongest_ / c_.scale.field_unit) * a - added);
}

Command Steering::command(const Estimate& e, Vec2 a) {
  const double size = norm(a);
  if (modulated_ && size > 0)
    a = (duty_.sign(std::min(size, 1.0)) / size) * a;
  else if (size > 1)
    a = (1 / size) * a;
  Command command = linear(e.centroid, a);
  if (delay_ > 0) {
    given_.erase(given_.begin());
    given_.push_back(field_along(c_, e.centroid, command));
  }
  return command;
}

Command Steering::none() {
  if (delay_ > 0) {
    given_.erase(given_.begin());
    given_.push_back({});
  }
  return {std::vector<double>(c_.field->coils(), 0.0)};
}

}  // namespace faba
