// libFuzzer target: any bytes from a page give a valid message or one Error(usage); the scenario or event in
// a message is read without a crash.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "app/scenario/read_event.h"
#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "server/shown/page_message.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const faba::Parts parts = faba::builtin_parts();
  static const faba::Scenario base = [] {
    return faba::read_scenario(faba::parse_toml("[[swarm]]\n", "fuzz.toml"), parts);
  }();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const faba::PageMessage m = faba::parse_page_message(text);
    if (m.id != faba::message_id(text)) std::abort();
    faba::Document d;
    if (m.what == faba::PageMessage::Do::start) {
      d.root = m.scenario;
      faba::read_scenario(d, parts);
    }
    if (m.what == faba::PageMessage::Do::exchange) {
      d.root = m.event;
      faba::Scenario now = base;
      faba::read_event(faba::Node(d), now, parts);
    }
  } catch (const faba::Error& e) {
    if (e.code() != faba::Errc::usage) std::abort();
    if (std::string_view(e.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
