#include "control/plant/swarm_pair.h"

#include <algorithm>

namespace faba {
namespace {

constexpr double kCoast = 10;  // s, for which a swarm that is not separate is predicted by the commands
// Ratio of the squared distances of an assignment to those of its exchange.
constexpr double kAmbiguous = 0.5;

}  // namespace

bool SwarmPair::follow(const std::vector<Group>& groups, Vec2 centroid, double age, double dt,
                       const Rotation& r) {
  const When t{age, dt, r};
  const Group first = groups.empty() ? Group{centroid, 1, {}} : groups[0];
  for (Followed& f : followed_) f.centre = f.centre + dt * f.velocity;
  if (groups.size() >= 2 && resolved_) return match(groups, t);
  if (groups.size() >= 2) {
    start(groups, centroid, t);
    return true;
  }
  if (resolved_) {
    match_single(first, t);
    return false;
  }
  for (std::size_t i = 0; i < 2; ++i) see(i, first.centroid, t);
  return true;
}

// The first swarm is the group that is nearest to the expected position, until their circles show which it
// is; the second is the largest of the others.
void SwarmPair::start(const std::vector<Group>& groups, Vec2 centroid, const When& t) {
  const Vec2 from = near_.value_or(centroid);
  std::size_t first = 0;
  for (std::size_t k = 1; k < groups.size(); ++k)
    if (norm(groups[k].centroid - from) < norm(groups[first].centroid - from)) first = k;
  std::size_t second = first == 0 ? 1 : 0;
  for (std::size_t k = 0; k < groups.size(); ++k)
    if (k != first && groups[k].share > groups[second].share) second = k;
  see_both(groups[first].centroid, groups[second].centroid, t);
  resolved_ = true;
}

// Exchanges the swarms if the other assignment fits their circles better.
bool SwarmPair::see_both(Vec2 first, Vec2 second, const When& t) {
  see(0, first, t);
  see(1, second, t);
  evidence_.add({followed_[0].centre, followed_[1].centre}, {centre_of(1, first, t), centre_of(0, second, t)},
                t.rotation.rate() * t.dt);
  if (!evidence_.contradicts()) return false;
  see(0, second, t);
  see(1, first, t);
  return true;
}

// Nearest assignment to the predicted centres; near a crossing both assignments are similar, and the swarms
// keep the predictions.
bool SwarmPair::match(const std::vector<Group>& groups, const When& t) {
  const auto cost = [&](std::size_t a, std::size_t b) {
    const Vec2 first = centre_of(0, groups[a].centroid, t) - followed_[0].centre;
    const Vec2 second = centre_of(1, groups[b].centroid, t) - followed_[1].centre;
    return dot(first, first) + dot(second, second);
  };
  std::size_t first = 0, second = 1;
  for (std::size_t a = 0; a < groups.size(); ++a)
    for (std::size_t b = 0; b < groups.size(); ++b)
      if (a != b && cost(a, b) < cost(first, second)) {
        first = a;
        second = b;
      }
  const bool clear = cost(first, second) <= kAmbiguous * cost(second, first);
  if (!clear && followed_[0].unseen < kCoast && followed_[1].unseen < kCoast) {
    for (Followed& f : followed_) f.unseen += t.dt;
    evidence_.skip();
    return false;
  }
  return see_both(groups[first].centroid, groups[second].centroid, t);
}

// A single group is the nearer swarm if the other is outside of it, else both.
void SwarmPair::match_single(const Group& g, const When& t) {
  evidence_.skip();
  constexpr double kOutside = 3;  // standard deviations
  const double size = kOutside * kOutside * std::max(g.cov.xx, g.cov.yy);
  std::array<double, 2> square{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec2 from = centre_of(i, g.centroid, t) - followed_[i].centre;
    square[i] = dot(from, from);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const bool alone = square[1 - i] > size && square[i] <= kAmbiguous * square[1 - i];
    followed_[i].unseen += t.dt;
    if (alone)
      see(i, g.centroid, t);
    else if (followed_[i].unseen >= kCoast)
      followed_[i].centre = centre_of(i, g.centroid, t);
  }
}

void SwarmPair::archive(Archive& a) {
  a& resolved_& evidence_;
  for (Followed& f : followed_) a& f;
}

}  // namespace faba
