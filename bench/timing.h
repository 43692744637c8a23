#pragma once
#include <functional>
#include <vector>

namespace faba::bench {

/// A piece of work to be timed.
struct Timed {
  std::function<void()> prepare;  ///< restores the state and warms up; not timed
  std::function<void()> work;
  double units = 1;             ///< number of units, e.g. agent-steps, in one call of `work`
  std::vector<double> ns = {};  ///< ns per unit, one entry per repeat
};

/// Times all items in turn, so that temporary load affects all of them equally: at least `least` rounds, and
/// until `seconds` have passed.
void time_in_turns(std::vector<Timed>& all, int least, double seconds);

/// Median and quartiles of the repeats.
struct Spread {
  double median = 0, low = 0, high = 0;
};
Spread spread(std::vector<double> v);

}  // namespace faba::bench
