// libFuzzer target: for any bytes the loader returns a scenario or throws one Error(usage). Built and run for
// a limited time by `make fuzz`; the corpus is scenes/ plus tests/fuzz/corpus/.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const faba::Parts parts = faba::builtin_parts();
  try {
    const faba::Document d =
        faba::parse_toml(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.toml");
    const faba::Scenario s = faba::read_scenario(d, parts);
    // An accepted scenario must be unchanged after writing and reading.
    const faba::Document again = faba::parse_toml(faba::to_toml(s.resolved()), "again.toml");
    if (faba::read_scenario(again, parts).resolved() != s.resolved()) std::abort();
  } catch (const faba::Error& e) {
    if (e.code() != faba::Errc::usage) std::abort();
    if (std::string_view(e.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
