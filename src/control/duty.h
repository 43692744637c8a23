#pragma once
#include <algorithm>

#include "core/archive.h"

namespace faba {

/// Sigma-delta modulation: a mean command between -1 and 1 from full commands forwards and backwards, for
/// swarms whose speed does not depend on the field (theory F1 d).
class Duty {
 public:
  /// 1 while drift is owed, else -1; the mean is `fraction`.
  double sign(double fraction) {
    residual_ = std::clamp(residual_ + fraction, -2.0, 2.0);
    const double sign = residual_ >= 0 ? 1 : -1;
    residual_ -= sign;
    return sign;
  }
  void archive(Archive& a) { a& residual_; }

 private:
  double residual_ = 0;  ///< in frames at full speed
};

}  // namespace faba
