#pragma once
#include <string>
#include <string_view>

namespace faba {

/// A whole HTML page around `body` (markup; its text already escaped). Self-contained: the style sheet is
/// inside, no script, nothing loaded from elsewhere. Readable on a phone, on paper, on light and dark
/// screens. It is well-formed XML too, provided `body` is. Classes the style sheet knows: `lead` (opening
/// sentence), `cards`, `figures`, `note`, `wide`, table classes `numbers` and `facts`.
std::string html_page(std::string_view title, std::string_view body);

}  // namespace faba
