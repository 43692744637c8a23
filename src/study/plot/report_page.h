#pragma once
#include <string>
#include <string_view>

namespace faba {

/// A complete HTML page with `body` (escaped markup). Self-contained: embedded style sheet, no scripts, no
/// external resources. The layout adapts to phones, print, light and dark mode. The page is well-formed XML
/// if `body` is. Classes of the style sheet: `lead` (opening sentence), `cards`, `figures`, `note`, `wide`,
/// and `numbers` and `facts` for tables.
std::string html_page(std::string_view title, std::string_view body);

}  // namespace faba
