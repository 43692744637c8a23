#pragma once
#include "control/controller.h"
#include "core/schema.h"

namespace faba {

/// Currents within the limits of the coils that place a zero of the field at a point and trap the cells there
/// (theory C6). The previous currents are kept when the coils cannot make it.
class Trap {
 public:
  enum class Source { solve, library };
  /// Parameters common to the gradient controllers.
  struct Params {
    Source source = Source::solve;
    bool earth = true;
    static Schema<Params> schema();
  };
  /// Throws Error(usage) when `source` is library and there is no library.
  Trap(const Params& p, const ControlContext& c);
  /// `at` in m, world frame.
  Command at(Vec2 at);
  void archive(Archive& a) { a& current_valid_& at_& current_; }

 private:
  Params p_;
  ControlContext c_;
  bool current_valid_ = false;  ///< current_ belongs to at_
  Vec2 at_;
  std::vector<double> current_;  ///< A
};

}  // namespace faba
