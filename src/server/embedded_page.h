#pragma once
#include <optional>
#include <string_view>

namespace faba {

/// A file of the lab's page as it was built into the program (web/dist); none for other names.
std::optional<std::string_view> embedded_page(std::string_view name);

}  // namespace faba
