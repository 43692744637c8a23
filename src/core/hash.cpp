#include "core/hash.h"

#include <fmt/format.h>

namespace faba {

std::string Hash::hex() const { return fmt::format("{:016x}", value_); }

}  // namespace faba
