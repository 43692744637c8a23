#pragma once
#include <optional>
#include <string_view>

namespace faba {

/// A file of the page (web/dist) embedded in the program; empty if there is no such file.
std::optional<std::string_view> embedded_page(std::string_view name);

}  // namespace faba
