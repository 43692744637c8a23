#include "control/plan/horizon.h"

#include <algorithm>

namespace faba {
namespace {

constexpr double kStep = 1e-3;  // of a difference quotient, relative to the full command and to the speed

using Column = Eigen::Vector4d;

Column difference(const MeanState& high, const MeanState& low, double step) {
  const Vec2 p = high.position - low.position, v = high.velocity - low.velocity;
  return Column(p.x, p.y, v.x, v.y) / step;
}

}  // namespace

std::vector<MeanState> expected_states(const SwarmMotion& plant, MeanState from,
                                       const std::vector<Vec2>& commands, double strongest, double time) {
  std::vector<MeanState> states{from};
  for (const Vec2 a : commands) states.push_back(advanced(plant, 1, states.back(), strongest * a, time));
  return states;
}

Horizon horizon(const SwarmMotion& plant, MeanState from, const std::vector<Vec2>& commands, double strongest,
                double time) {
  const auto moves = Eigen::Index(commands.size());
  const auto after = [&](MeanState s, Vec2 command) {
    return advanced(plant, 1, s, strongest * command, time);
  };
  const double speed_step = kStep * std::max(plant.speed, 1e-6);
  Horizon h;
  h.states.push_back(from);
  h.by_command.push_back(Eigen::MatrixXd::Zero(4, 2 * moves));
  for (Eigen::Index i = 0; i < moves; ++i) {
    const MeanState s = h.states.back();
    const Vec2 a = commands[std::size_t(i)];
    Eigen::Matrix4d by_state = Eigen::Matrix4d::Identity();
    Eigen::Matrix<double, 4, 2> by_a;
    for (int axis = 0; axis < 2; ++axis) {
      const Vec2 direction = axis == 0 ? Vec2{1, 0} : Vec2{0, 1};
      MeanState faster = s, slower = s;
      faster.velocity = s.velocity + speed_step * direction;
      slower.velocity = s.velocity - speed_step * direction;
      by_state.col(2 + axis) = difference(after(faster, a), after(slower, a), 2 * speed_step);
      by_a.col(axis) =
          difference(after(s, a + kStep * direction), after(s, a - kStep * direction), 2 * kStep);
    }
    Eigen::MatrixXd d = by_state * h.by_command.back();
    d.middleCols<2>(2 * i) += by_a;
    h.by_command.push_back(std::move(d));
    h.states.push_back(after(s, a));
  }
  return h;
}

}  // namespace faba
