#include "study/uturn/simulated_turns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/stats/study_random.h"

namespace faba {

std::vector<Track> simulated_u_turns(double rate, double disorder, double noise, double frame_s,
                                     double after_s, std::size_t cells, std::uint64_t seed) {
  constexpr double kLargestStep =
      0.05;  // largest product of rate and time step: bias of an Euler step 2 %, of 1 / w less
  constexpr double kSettling = 5;  // times 1 / rate: the initial headings are forgotten
  StudyRandom random(seed, StudyDraws::u_turn);
  const double before_s = kSettling / rate + 3 * frame_s;
  const auto frames = std::size_t((before_s + after_s) / frame_s) + 1;
  const auto steps = std::size_t(std::max(1.0, std::ceil(rate * frame_s / kLargestStep)));
  const double dt = frame_s / double(steps), kick = std::sqrt(2 * disorder * rate * dt);
  const double place_sd = std::sqrt(noise / 2) * frame_s;  // a velocity has the noise of two positions
  std::vector<Track> tracks;
  for (std::size_t k = 0; k < cells; ++k) {
    Track t{.number = k + 1, .points = {}};
    double theta = std::numbers::pi + std::sqrt(disorder) * random.normal(), x = 0, y = 0;
    for (std::size_t i = 0; i < frames; ++i) {
      const double time = double(i) * frame_s - before_s;
      t.points.push_back({.frame = i,
                          .t_s = time + kSimulatedReversal_s,
                          .x_px = x + place_sd * random.normal(),
                          .y_px = y + place_sd * random.normal()});
      for (std::size_t j = 0; j < steps; ++j) {
        // The exact law of a dipole without noise, tan(theta / 2) ~ exp(-+ rate t), then the noise.
        const double sign = time + (double(j) + 0.5) * dt < 0 ? 1 : -1;
        theta = 2 * std::atan2(std::exp(sign * rate * dt) * std::sin(theta / 2), std::cos(theta / 2)) +
                kick * random.normal();
        x += std::cos(theta) * dt;
        y += std::sin(theta) * dt;
      }
    }
    tracks.push_back(std::move(t));
  }
  return tracks;
}

}  // namespace faba
