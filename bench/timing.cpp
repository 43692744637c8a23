#include "timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace faba::bench {

void time_in_turns(std::vector<Timed>& all, int least, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  for (int round = 0; round < least || std::chrono::duration<double>(Clock::now() - begin).count() < seconds;
       ++round)
    for (Timed& t : all) {
      t.prepare();
      const auto start = Clock::now();
      t.work();
      t.ns.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count() / t.units);
    }
}

Spread spread(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  const auto at = [&](double q) {
    const double k = q * double(v.size() - 1);
    const auto i = std::size_t(k);
    return i + 1 < v.size() ? std::lerp(v[i], v[i + 1], k - double(i)) : v[i];
  };
  return {at(0.5), at(0.25), at(0.75)};
}

}  // namespace faba::bench
