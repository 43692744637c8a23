#pragma once
#include <cstdint>

namespace faba {

/// Bytes that uploads leave free on the disk for results; assumed.
inline constexpr std::uint64_t kSpareDisk = 256u << 20;

}  // namespace faba
