#include "control/trap.h"

#include <cmath>

#include "field/null.h"

namespace faba {

Command Trap::at(Vec2 at) {
  if ((known_ && at == at_) || !std::isfinite(at.x + at.y)) return {current_};
  const FieldNull n = null_at(*c_.field, at, c_.polarity, c_.max_current, earth_);
  if (n.reachable) current_ = n.current;
  known_ = true;
  at_ = at;
  return {current_};
}

}  // namespace faba
