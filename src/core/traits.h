#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace faba {

/// Properties of a part that code can query without knowing its name. A part declares its traits next to its
/// schema, `static constexpr std::array kTraits = {Trait::feedback};`. Its JSON Schema has them as
/// `x-traits`.
enum class Trait : std::size_t {
  feedback,         ///< controller: uses the estimate to steer towards the target
  open_loop,        ///< controller: follows a schedule or manual input, without estimate and target
  seeks_null,       ///< controller: produces zeros of the field at which the swarm gathers
  needs_positions,  ///< estimator: needs the position of every cell, which pictures do not provide
  needs_pictures,   ///< estimator: needs the camera's pictures
  no_estimate,      ///< estimator: estimates nothing
  no_target,        ///< reference: gives no target
  in_view,          ///< start: all initial positions are in the camera view
  inert,            ///< motility law: has no effect
  coil,             ///< field: one coil or pair, which can be a [[coil]] of a coil system
  coil_system,      ///< field: contains coils; a scenario may read it from a separate file
  simulated,        ///< camera, driver: part of a simulated bench, whose socket is its parameter `at`
  no_current        ///< driver: drives no current
};

namespace traits {
/// Names of the traits in JSON, in the order of the enum.
inline constexpr std::array kWords = {
    "feedback", "open_loop", "seeks_null", "needs_positions", "needs_pictures", "no_estimate", "no_target",
    "in_view",  "inert",     "coil",       "coil_system",     "simulated",      "no_current"};

/// Traits declared by the class of a part; empty if it declares none.
template <class T>
std::vector<Trait> of() {
  if constexpr (requires { T::kTraits; })
    return {T::kTraits.begin(), T::kTraits.end()};
  else
    return {};
}
}  // namespace traits

}  // namespace faba
