#pragma once
#include "control/controller.h"
#include "core/schema.h"

namespace faba {

/// Currents that put a zero of the field at a place and trap the cells there (theory C6), within the limits
/// of the coils. Where the coils cannot, those of before stay.
class Trap {
 public:
  enum class Source { solve, library };
  /// Keys that controllers of gradients share.
  struct Params {
    Source source = Source::solve;
    bool earth = true;
    static Schema<Params> schema();
  };
  /// Throws Error(usage) when there is no library to take currents from.
  Trap(const Params& p, const ControlContext& c);
  /// `at` in m, world frame.
  Command at(Vec2 at);
  void archive(Archive& a) { a& known_& at_& current_; }

 private:
  Params p_;
  ControlContext c_;
  bool known_ = false;  ///< current_ is that for at_
  Vec2 at_;
  std::vector<double> current_;  ///< A
};

}  // namespace faba
