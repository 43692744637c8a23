#pragma once
#include "control/controller.h"

namespace faba {

/// Currents that put a zero of the field at a place and trap the cells there (theory C6), within the limits
/// of the coils. Where the coils cannot, those of before stay.
class Trap {
 public:
  /// `earth`: whether the Earth's field is allowed for.
  Trap(const ControlContext& c, bool earth) : c_(c), earth_(earth), current_(c.field->coils(), 0.0) {}
  /// `at` in m, world frame.
  Command at(Vec2 at);
  void archive(Archive& a) { a& known_& at_& current_; }

 private:
  ControlContext c_;
  bool earth_;
  bool known_ = false;  ///< current_ is that for at_
  Vec2 at_;
  std::vector<double> current_;  ///< A
};

}  // namespace faba
