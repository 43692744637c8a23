#pragma once
#include <cstdint>

#include "cli/verbs.h"
#include "core/toml.h"

namespace faba::cli {

/// The scenario file of a verb with what its options change in it, and a title.
Document read_scene(const RunVerb& v);

/// A seed by chance: short enough to type, and exact in every language that will read the manifest.
std::uint64_t drawn_seed();

/// Throws Error(usage) when `out`, given by the user, is where an input lies: what a run is made from is not
/// to be replaced by it.
void refuse_own_input(const RunVerb& v);

}  // namespace faba::cli
