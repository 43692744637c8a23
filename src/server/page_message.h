#pragma once
#include <string>
#include <string_view>

#include "core/toml.h"

namespace faba {

/// What a page may ask of the live lab; web/protocol.md.
struct PageMessage {
  enum class Do { start, exchange, pause, go, step, speed, restart, steer, look, save, ping };
  Do what = Do::pause;
  std::int64_t id = 0;
  Json scenario;                      ///< start
  std::optional<std::uint64_t> seed;  ///< start
  Json event;                         ///< exchange
  std::uint64_t frames = 1;           ///< step
  double factor = 1;                  ///< speed
  bool camera = false;                ///< look
  double rate = 60;                   ///< look, Hz
  std::string name;                   ///< save
  bool as_seen = false;               ///< save
};

/// Throws Error(usage) for anything that is not a message: any bytes may come.
PageMessage parse_page_message(std::string_view text);
/// The id of a message that cannot be read further; 0 when it has none.
std::int64_t message_id(std::string_view text);

}  // namespace faba
