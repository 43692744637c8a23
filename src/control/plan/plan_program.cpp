#include "control/plan/plan_program.h"

#include <algorithm>
#include <cmath>

namespace faba {
namespace {

constexpr double kActive = 1e-3;  // of a multiplier, relative to the gradient; the tolerance of the solver

}  // namespace

PlanProgram::PlanProgram(const std::vector<Vec2>& plan) : plan_(2 * Eigen::Index(plan.size())) {
  for (Eigen::Index i = 0; i < size() / 2; ++i) {
    plan_[2 * i] = plan[std::size_t(i)].x;
    plan_[2 * i + 1] = plan[std::size_t(i)].y;
  }
  q_.hessian = Eigen::MatrixXd::Zero(size(), size());
  q_.gradient = Eigen::VectorXd::Zero(size());
}

void PlanProgram::add_error(const Eigen::MatrixXd& by_command, const Eigen::VectorXd& error,
                            const Eigen::MatrixXd& weight) {
  const Eigen::MatrixXd weighted = 2 * by_command.transpose() * weight;
  q_.hessian += weighted * by_command;
  q_.gradient += weighted * (error - by_command * plan_);
}

void PlanProgram::add_effort(double change) {
  q_.hessian += 2 * Eigen::MatrixXd::Identity(size(), size());
  if (change == 0) return;
  const Eigen::Index n = size() - 2;
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(n, size());
  d.leftCols(n) = -Eigen::MatrixXd::Identity(n, n);
  d.rightCols(n) += Eigen::MatrixXd::Identity(n, n);
  q_.hessian += 2 * change * d.transpose() * d;
}

void PlanProgram::limit(const CoilLimits& c) {
  limit_commands();
  for (std::size_t k = 0; k < c.offset.size(); ++k) limit_coil(c, k);
  if (c.max_heat) limit_heat(c);
}

void PlanProgram::add(PlanLimit limit, QuadraticProgram::Block block) {
  limits_.push_back({limit, block.first, block.count});
  q_.blocks.push_back(std::move(block));
}

void PlanProgram::limit_commands() {
  for (Eigen::Index i = 0; i < size(); i += 2) {
    QuadraticProgram::Block disc;
    disc.first = row_count();
    disc.count = 2;
    disc.radius = 1;
    add(PlanLimit::output, disc);
    for (int axis = 0; axis < 2; ++axis) rows_.push_back(Eigen::RowVectorXd::Unit(size(), i + axis));
  }
}

Eigen::RowVectorXd PlanProgram::current_row(const CoilLimits& c, std::size_t coil, Eigen::Index move,
                                            double unit) const {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(size());
  row[2 * move] = c.x[coil] / unit;
  row[2 * move + 1] = c.y[coil] / unit;
  return row;
}

void PlanProgram::limit_coil(const CoilLimits& c, std::size_t coil) {
  const double most = c.max_current[coil], offset = c.offset[coil] / most;
  if (!(most > 0) || !std::isfinite(most)) return;
  const auto keep_within = [&](PlanLimit limit, Eigen::RowVectorXd row, double low, double high) {
    QuadraticProgram::Block block;
    block.first = row_count();
    block.low = low;
    block.high = high;
    add(limit, block);
    rows_.push_back(std::move(row));
  };
  const double reach = std::sqrt(c.x[coil] * c.x[coil] + c.y[coil] * c.y[coil]) / most + std::fabs(offset);
  for (Eigen::Index i = 0; i < size() / 2; ++i) {
    if (reach > 1) keep_within(PlanLimit::current, current_row(c, coil, i, most), -1 - offset, 1 - offset);
    if (!c.max_slew) continue;
    const double change = *c.max_slew * (i == 0 ? c.first_time : c.move_time) / most;
    if (change >= 2 * reach) continue;
    const double before = i == 0 ? c.before[coil] / most - offset : 0;
    Eigen::RowVectorXd row = current_row(c, coil, i, most);
    if (i > 0) row -= current_row(c, coil, i - 1, most);
    keep_within(PlanLimit::slew, std::move(row), before - change, before + change);
  }
}

// The sum of resistance current^2 over coils and moves is the square of a distance.
void PlanProgram::limit_heat(const CoilLimits& c) {
  const Eigen::Index moves = size() / 2, coils = Eigen::Index(c.offset.size());
  QuadraticProgram::Block ball;
  ball.first = row_count();
  ball.count = coils * moves;
  ball.radius = std::sqrt(double(moves) * (1 - c.spent));
  ball.centre.resize(ball.count);
  for (Eigen::Index k = 0; k < coils; ++k) {
    const auto coil = std::size_t(k);
    const double root = std::sqrt(c.resistance[coil] / *c.max_heat);
    for (Eigen::Index i = 0; i < moves; ++i) {
      ball.centre[k * moves + i] = -root * c.offset[coil];
      rows_.push_back(root * current_row(c, coil, i, 1));
    }
  }
  add(PlanLimit::heat, std::move(ball));
}

void PlanProgram::keep(PlanLimit limit, const Eigen::MatrixXd& by_command, Vec2 direction, double room,
                       double unit, double weight) {
  const Eigen::RowVectorXd row = (direction.x * by_command.row(0) + direction.y * by_command.row(1)) / unit;
  QuadraticProgram::Block block;
  block.first = row_count();
  block.high = room / unit + row.dot(plan_);
  block.weight = weight;
  add(limit, block);
  rows_.push_back(row);
}

QuadraticProgram PlanProgram::take() {
  q_.rows.resize(row_count(), size());
  for (Eigen::Index i = 0; i < row_count(); ++i) q_.rows.row(i) = rows_[std::size_t(i)];
  largest_gradient_ = q_.gradient.cwiseAbs().maxCoeff();
  return std::move(q_);
}

std::vector<PlanLimit> PlanProgram::active(const QuadraticSolution& solution) const {
  std::vector<PlanLimit> found;
  for (const Rows& r : limits_) {
    const bool acts = solution.multipliers.segment(r.first, r.count).norm() > kActive * largest_gradient_;
    if (acts && std::find(found.begin(), found.end(), r.limit) == found.end()) found.push_back(r.limit);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace faba
