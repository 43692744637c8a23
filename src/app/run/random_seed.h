#pragma once
#include <cstdint>

namespace faba {

/// A seed from the operating system's random device, for a run whose seed is not given. It has 48 bits, so
/// that JSON and every language store it exactly.
std::uint64_t random_seed();

}  // namespace faba
