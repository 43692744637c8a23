#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace faba {

/// What the rest of the program may ask about a part without knowing its name. A part declares its traits
/// beside its schema, `static constexpr std::array kTraits = {Trait::feedback};`, and they stand in its JSON
/// Schema as `x-traits`.
enum class Trait : std::size_t {
  feedback,         ///< controller: steers by the estimate towards the target
  open_loop,        ///< controller: follows a schedule or the user's hand, without estimate and target
  seeks_null,       ///< controller: puts zeros of the field where the swarm is to gather
  needs_positions,  ///< estimator: needs the position of every cell, which pictures do not give
  needs_pictures,   ///< estimator: needs the camera's pictures
  no_estimate,      ///< estimator: estimates nothing
  no_target,        ///< reference: sets no target
  in_view,          ///< start: puts every cell where the camera sees it
  inert,            ///< motility law: changes nothing
  coil,             ///< field: one coil or pair, which can be a [[coil]] of a coil system
  coil_system,      ///< field: holds coils; a scenario may give it as a file of its own
  simulated,        ///< camera, driver: belongs to a simulated bench, whose socket is its parameter `at`
  no_current        ///< driver: moves no current
};

namespace traits {
/// The words that stand for traits in JSON, in the order of the enum.
inline constexpr std::array kWords = {
    "feedback", "open_loop", "seeks_null", "needs_positions", "needs_pictures", "no_estimate", "no_target",
    "in_view",  "inert",     "coil",       "coil_system",     "simulated",      "no_current"};

/// The traits that a part's class declares; none when it declares none.
template <class T>
std::vector<Trait> of() {
  if constexpr (requires { T::kTraits; })
    return {T::kTraits.begin(), T::kTraits.end()};
  else
    return {};
}
}  // namespace traits

}  // namespace faba
