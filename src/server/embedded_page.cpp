#include "server/embedded_page.h"

#include <utility>

// embedded_page.inc, made by CMake, has one line for each file of web/dist: FABA_PAGE(name, number).
#define FABA_PAGE(name, n) extern const char faba_page_##n[], faba_page_end_##n[];
extern "C" {
#include "embedded_page.inc"
}
#undef FABA_PAGE

namespace faba {

std::optional<std::string_view> embedded_page(std::string_view name) {
#define FABA_PAGE(file, n) \
  if (name == (file)) return std::string_view(faba_page_##n, std::size_t(faba_page_end_##n - faba_page_##n));
#include "embedded_page.inc"
#undef FABA_PAGE
  return {};
}

}  // namespace faba
