#pragma once
#include <functional>
#include <vector>

namespace faba::bench {

/// One piece of work whose time is wanted.
struct Timed {
  std::function<void()> prepare;  ///< restores the state and warms up; not timed
  std::function<void()> work;
  double units = 1;  ///< agent-steps, or whatever the time is to be divided by, in one call of work
  std::vector<double> ns = {};  ///< ns per unit, one entry per repeat
};

/// Times all of them in turn, again and again, so that what disturbs the machine for a while disturbs each
/// of them: at least `least` rounds, then until `seconds` have passed.
void time_in_turns(std::vector<Timed>& all, int least, double seconds);

/// Median and quartiles of the repeats.
struct Spread {
  double median = 0, low = 0, high = 0;
};
Spread spread(std::vector<double> v);

}  // namespace faba::bench
