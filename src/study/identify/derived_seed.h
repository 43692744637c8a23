#pragma once
#include <cstddef>
#include <cstdint>

namespace faba {

/// What an identification makes a seed for.
enum class SeedUse {
  guide,        ///< posterior from which a search proposes its next round
  cut_off,      ///< posterior that shows whether the last round was wide enough
  left_out,     ///< posterior without one experiment; index: the experiment
  best_model,   ///< posterior of the best model, to simulate it again
  found_model,  ///< posterior and conclusions; index: the candidate
  search        ///< all rounds; index: the candidate
};

inline constexpr std::uint64_t kBestModelSeed = 5, kFoundModelSeeds = 77, kSearchSeeds = 1000;

/// The seed for a use, made from the seed of what it is a part of: of the study, for `guide` and `cut_off` of
/// the search, and for `left_out` of the found model. The numbers keep the results of studies; do not change
/// them.
constexpr std::uint64_t derived_seed(std::uint64_t seed, SeedUse use, std::size_t index = 0) {
  switch (use) {
    case SeedUse::guide:
      return seed + 1;
    case SeedUse::cut_off:
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

// Posteriors are told apart by their seeds alone, and no two are equal with up to 12 candidates and 75
// experiments: best model 5; found models 77 (c + 1) to 77 (c + 1) + 75; searches from 1000. With more, two
// candidates' Markov chains may have the same random numbers, which correlates their Monte Carlo errors.
static_assert(kBestModelSeed < kFoundModelSeeds);
static_assert(derived_seed(derived_seed(0, SeedUse::found_model, 0), SeedUse::left_out, 74) <
              derived_seed(0, SeedUse::found_model, 1));
static_assert(derived_seed(derived_seed(0, SeedUse::found_model, 11), SeedUse::left_out, 74) <
              derived_seed(0, SeedUse::search, 0));

}  // namespace faba
