#pragma once
#include <array>
#include <optional>
#include <vector>

#include "control/plant/circle_evidence.h"
#include "control/plant/rotation.h"
#include "core/archive.h"
#include "core/signals.h"

namespace faba {

/// Two swarms that circle in a rotating field, followed from frame to frame in the groups of an estimator.
class SwarmPair {
 public:
  /// `sign`: 1 for a swarm that swims along the field times the polarity, -1 against it. `near`: position at
  /// which the first swarm is expected at the start, m; empty: at the estimate.
  SwarmPair(const std::array<CirclingSwarm, 2>& swarms, const std::array<double, 2>& sign,
            std::optional<Vec2> near)
      : swarms_(swarms), sign_(sign), near_(near) {}

  /// Assigns the groups of a frame, which is `age` s older than the next command and `dt` s newer than the
  /// last one. Returns whether it has decided which swarm is which.
  bool follow(const std::vector<Group>& groups, Vec2 centroid, double age, double dt, const Rotation& r);
  /// The velocity of the centre by the last command, m/s.
  void set_velocity(std::size_t swarm, Vec2 velocity) { followed_[swarm].velocity = velocity; }
  Vec2 centre(std::size_t swarm) const { return followed_[swarm].centre; }  ///< of its circle, m
  bool resolved() const { return resolved_; }  ///< whether both have been seen as two groups
  void archive(Archive& a);

 private:
  /// One of the two swarms.
  struct Followed {
    Vec2 centre;        ///< of its circle, m
    Vec2 velocity;      ///< by the last command, m/s
    double unseen = 0;  ///< s, since it was last a group of its own
    void archive(Archive& a) { a& centre& velocity& unseen; }
  };
  /// The time of a frame.
  struct When {
    double age, dt;  ///< s
    const Rotation& rotation;
  };
  Vec2 centre_of(std::size_t swarm, Vec2 position, const When& t) const {
    return swarms_[swarm].centre(position, t.age, sign_[swarm], t.rotation);
  }
  void see(std::size_t swarm, Vec2 position, const When& t) {
    followed_[swarm].centre = centre_of(swarm, position, t);
    followed_[swarm].unseen = 0;
  }
  void start(const std::vector<Group>& groups, Vec2 centroid, const When& t);
  bool match(const std::vector<Group>& groups, const When& t);
  void match_single(const Group& g, const When& t);
  bool see_both(Vec2 first, Vec2 second, const When& t);

  std::array<CirclingSwarm, 2> swarms_;
  std::array<double, 2> sign_;
  std::optional<Vec2> near_;
  bool resolved_ = false;
  std::array<Followed, 2> followed_;
  CircleEvidence evidence_;
};

}  // namespace faba
