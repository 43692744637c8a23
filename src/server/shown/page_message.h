#pragma once
#include <string>
#include <string_view>

#include "core/toml.h"

namespace faba {

/// A request of a page to the live lab; see web/protocol.md.
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
  int sites = 0;                      ///< look, see FrameMessage
  std::string name;                   ///< save
  bool as_seen = false;               ///< save
  double from = 0;                    ///< save, s
  std::optional<double> to;           ///< save, s; empty: now
};

/// Parses any bytes. Throws Error(usage) if they are not a valid message.
PageMessage parse_page_message(std::string_view text);
/// The id of an invalid message; 0 if it has none.
std::int64_t message_id(std::string_view text);

}  // namespace faba
