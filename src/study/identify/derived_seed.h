#pragma once
#include <cstddef>
#include <cstdint>

namespace faba {

/// Purpose of a seed within an identification.
enum class SeedUse {
  proposal,     ///< posterior for the proposal of the next round of a search
  truncation,   ///< posterior for the check that the last round was wide enough
  left_out,     ///< posterior without one experiment; index: the experiment
  best_model,   ///< posterior of the best model, for predictive simulations
  found_model,  ///< posterior and estimates; index: the candidate
  search        ///< all rounds of a search; index: the candidate
};

inline constexpr std::uint64_t kBestModelSeed = 5, kFoundModelSeeds = 77, kSearchSeeds = 1000;

/// Seed for a purpose. `seed` is the seed of the search for `proposal` and `truncation`, the seed of the
/// found model for `left_out`, and the seed of the study otherwise. The numbers determine the results of
/// studies; do not change them.
constexpr std::uint64_t derived_seed(std::uint64_t seed, SeedUse use, std::size_t index = 0) {
  switch (use) {
    case SeedUse::proposal:
      return seed + 1;
    case SeedUse::truncation:
      return seed + 2;
    case SeedUse::left_out:
      return seed + 1 + index;
    case SeedUse::best_model:
      return seed + kBestModelSeed;
    case SeedUse::found_model:
      return seed + kFoundModelSeeds * (index + 1);
    case SeedUse::search:
      return seed + kSearchSeeds * (index + 1);
  }
  return seed;
}

// The seeds of all posteriors are different for up to 12 candidates and 75 experiments: best model 5; found
// models 77 (c + 1) to 77 (c + 1) + 75; searches from 1000. With more, the Markov chains of two candidates
// can have equal random numbers, which correlates their Monte Carlo errors.
static_assert(kBestModelSeed < kFoundModelSeeds);
static_assert(derived_seed(derived_seed(0, SeedUse::found_model, 0), SeedUse::left_out, 74) <
              derived_seed(0, SeedUse::found_model, 1));
static_assert(derived_seed(derived_seed(0, SeedUse::found_model, 11), SeedUse::left_out, 74) <
              derived_seed(0, SeedUse::search, 0));

}  // namespace faba
