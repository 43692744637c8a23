#pragma once
#include <optional>
#include <vector>

#include "control/plan/plan.h"
#include "control/plan/quadratic_program.h"
#include "core/vec.h"

namespace faba {

/// Limits of the coils for a plan. The currents are `offset` + x a.x + y a.y, A, one for each coil.
struct CoilLimits {
  std::vector<double> offset, x, y;
  std::vector<double> max_current;  ///< A
  std::vector<double> before;       ///< A, of the last command
  std::vector<double> resistance;   ///< ohm
  std::optional<double> max_slew;   ///< A/s
  std::optional<double> max_heat;   ///< W, mean of all coils together over the plan
  double spent = 0;                 ///< part of the heat of the plan that is used up, 0 to 1
  double first_time = 0;            ///< s, from the last command to the first move
  double move_time = 0;             ///< s, between two moves
};

/// The quadratic program of a plan: the variables are the commands of the moves, two for each.
class PlanProgram {
 public:
  /// `plan`: the commands about which the motion was linearised.
  explicit PlanProgram(const std::vector<Vec2>& plan);

  /// Adds the cost e^T weight e of an error e = error + by_command (a - plan).
  void add_error(const Eigen::MatrixXd& by_command, const Eigen::VectorXd& error,
                 const Eigen::MatrixXd& weight);
  /// Adds the cost sum |a|^2 + change sum |a_i - a_(i-1)|^2.
  void add_effort(double change);
  /// |a| <= 1, the currents, their rates and the heat.
  void limit(const CoilLimits& c);
  /// direction . (p - the p that is planned) <= room for a position with these derivatives, in units of
  /// `unit` (m), as far as possible: a violation has the cost of `weight` times its square.
  void keep(PlanLimit limit, const Eigen::MatrixXd& by_command, Vec2 direction, double room, double unit,
            double weight);

  /// The program. No more can be added.
  QuadraticProgram take();
  /// The limits without which the solution would be another: those with a multiplier.
  std::vector<PlanLimit> active(const QuadraticSolution& solution) const;

 private:
  struct Rows {
    PlanLimit limit;
    Eigen::Index first, count;
  };
  Eigen::Index size() const { return plan_.size(); }
  Eigen::Index row_count() const { return Eigen::Index(rows_.size()); }
  Eigen::RowVectorXd current_row(const CoilLimits& c, std::size_t coil, Eigen::Index move, double unit) const;
  void add(PlanLimit limit, QuadraticProgram::Block block);
  void limit_commands();
  void limit_coil(const CoilLimits& c, std::size_t coil);
  void limit_heat(const CoilLimits& c);

  Eigen::VectorXd plan_;
  QuadraticProgram q_;
  std::vector<Eigen::RowVectorXd> rows_;
  std::vector<Rows> limits_;     ///< of each block
  double largest_gradient_ = 0;  ///< at no command
};

}  // namespace faba
