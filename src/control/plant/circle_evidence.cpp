#include "control/plant/circle_evidence.h"

#include <cmath>

#include "core/portable_math.h"

namespace faba {
namespace {

// Noise of the positions adds the same to both variances, so that their ratio tends to 1. A bias of at most
// 0.3 of the rotating field varies the velocity of the right centre by 0.15 of the speed; that of a wrong one
// is twice the speed for the opposite polarity (ratio 0.006), and the difference of the speeds for the same.
constexpr double kClear = 0.5;
constexpr int kFewest = 6;  // steps; a turn has at least eight frames

}  // namespace

void CircleEvidence::Motion::add(const Centres& now, bool step) {
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vec2 moved = now[i] - last[i];
    last[i] = now[i];
    if (!step) continue;
    sum[i] = sum[i] + moved;
    squares += dot(moved, moved);
  }
}

double CircleEvidence::Motion::variance(int steps) const {
  return squares - (dot(sum[0], sum[0]) + dot(sum[1], sum[1])) / steps;
}

void CircleEvidence::Motion::archive(Archive& a) {
  for (std::size_t i = 0; i < last.size(); ++i) a& last[i] & sum[i];
  a& squares;
}

void CircleEvidence::add(const Centres& assigned, const Centres& exchanged, double angle) {
  assigned_.add(assigned, seen_);
  exchanged_.add(exchanged, seen_);
  if (seen_) {
    angle_ += std::fabs(angle);
    ++steps_;
  }
  seen_ = true;
}

bool CircleEvidence::contradicts() {
  if (steps_ < kFewest || angle_ < 2 * portable::kPi) return false;
  const bool contradicted = exchanged_.variance(steps_) < kClear * assigned_.variance(steps_);
  *this = {};
  return contradicted;
}

void CircleEvidence::archive(Archive& a) { a& assigned_& exchanged_& angle_& steps_& seen_; }

}  // namespace faba
