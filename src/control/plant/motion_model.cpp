#include "control/plant/motion_model.h"

#include <algorithm>
#include <cmath>

namespace faba {
namespace {

constexpr double kAnglePerStep = 0.25;  // rad; error of a step of the midpoint rule below 0.1 %
constexpr double kLargestAngle = 40;    // rad; a swarm that turns faster than this has turned within a frame

Vec2 acceleration(const SwarmMotion& m, double speed, Vec2 v, Vec2 along) {
  const double square = dot(v, v), most = speed * speed;
  const double ratio = most > 0 ? std::min(square / most, 1.0) : 1.0, fourth = ratio * ratio;
  const Vec2 parallel = square > 0 ? (dot(along, v) / square) * v : Vec2{};
  const Vec2 turned = 0.5 * (1 + fourth) * along - fourth * parallel;
  return speed * m.turning * turned - m.diffusion * v;
}

MeanState turned(const SwarmMotion& m, double speed, MeanState s, Vec2 along, double time) {
  double angle = m.turning * norm(along) * time;
  if (angle > kLargestAngle) {
    along = (kLargestAngle / angle) * along;
    angle = kLargestAngle;
  }
  const double wanted = std::max(angle, m.diffusion * time) / kAnglePerStep;
  const int steps = int(std::clamp(std::ceil(wanted), 1.0, kLargestAngle / kAnglePerStep));
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const Vec2 middle = s.velocity + (h / 2) * acceleration(m, speed, s.velocity, along);
    const Vec2 next = s.velocity + h * acceleration(m, speed, middle, along);
    s.position = s.position + (h / 2) * (s.velocity + next);
    s.velocity = next;
  }
  return s;
}

}  // namespace

Schema<MotionParams> MotionParams::schema() {
  return Schema<MotionParams>("motion", "Plant: how the swarm moves")
      .add("speed", &MotionParams::speed,
           {.unit = "m/s",
            .min = 1e-8,
            .max = 1e-2,
            .doc = "Swimming speed of the cells; default: that of the model of the first swarm",
            .title = "Swimming speed of the plant"})
      .add("turning", &MotionParams::turning,
           {.unit = "rad/(s T)",
            .min = 1,
            .max = 1e9,
            .doc = "Rate at which the cells turn, per tesla; default: that of the model of the first swarm",
            .title = "Turning rate of the plant"})
      .add("rotational_diffusion", &MotionParams::rotational_diffusion,
           {.unit = "1/s",
            .min = 0,
            .max = 1e4,
            .doc = "Rotational diffusion coefficient; default: that of the model of the first swarm",
            .title = "Rotational diffusion of the plant"})
      .add("mobility", &MotionParams::mobility,
           {.unit = "m/(s T)",
            .min = 1e-6,
            .max = 1e6,
            .doc = "Drift per tesla, of a swarm whose drift is proportional to the field (model basic); "
                   "default: that of the model of the first swarm",
            .title = "Drift per tesla of the plant"});
}

SwarmMotion MotionParams::of(const SwarmMotion& model) const {
  SwarmMotion m = model;
  m.speed = speed.value_or(m.speed);
  m.turning = turning.value_or(m.turning);
  m.diffusion = rotational_diffusion.value_or(m.diffusion);
  m.mobility = mobility.value_or(m.mobility);
  return m;
}

MeanState advanced(const SwarmMotion& m, double factor, MeanState s, Vec2 along, double time) {
  if (m.response == SwarmMotion::Response::turning) return turned(m, factor * m.speed, s, along, time);
  const double b = norm(along);
  if (m.response == SwarmMotion::Response::proportional)
    s.velocity = factor * m.mobility * along;
  else
    s.velocity = b > 0 ? (factor * m.speed / b) * along : Vec2{};
  s.position = s.position + time * s.velocity;
  return s;
}

LinearPlant linear_plant(const SwarmMotion& m, double strongest) {
  switch (m.response) {
    case SwarmMotion::Response::turning:
      return {false, m.speed * m.turning * strongest / 2, m.diffusion};
    case SwarmMotion::Response::proportional:
      return {true, m.mobility * strongest, 0};
    case SwarmMotion::Response::constant:
      return {true, m.speed, 0};
  }
  return {};
}

Vec2 field_along(const ControlContext& c, Vec2 at, const Command& command) {
  std::vector<double> current = command.current;
  current.resize(c.field->coils(), 0.0);
  const Vec3 b = c.field->at({at.x, at.y, 0}, current);
  return double(c.polarity) * Vec2{b.x, b.y};
}

}  // namespace faba
