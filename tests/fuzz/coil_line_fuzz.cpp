// libFuzzer target: for any input on the serial line, the outputs of the board stay in range, and current
// flows only after valid commands within the timeout. In the input, a byte 0 is followed by a delay in ms,
// and a byte 1 stands for the checksum and the end of the line since the last $, which a fuzzer cannot guess.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

extern "C" {
#include "firmware/coil_controller.h"
}

namespace {

std::array<std::int32_t, COIL_CHANNELS> outputs;
bool enabled = false;

void check(bool holds) {
  if (!holds) std::abort();
}

void put(int channel, std::int32_t microvolt) {
  check(channel >= 0 && channel < COIL_CHANNELS);
  check(microvolt >= COIL_LEAST_UV && microvolt <= COIL_MOST_UV);
  outputs[std::size_t(channel)] = microvolt;
}
void enable(int on) { enabled = on != 0; }
std::int32_t sense(int channel) { return outputs[std::size_t(channel)]; }
void send(const char* text, int length) {
  check(length > 7 && length <= COIL_LINE && text[0] == '$' && text[length - 1] == '\n');
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  coil_controller c;
  std::memset(&c, 0xA5, sizeof c);  // uninitialised memory of a board
  std::uint32_t now = 0xFFFFFF00u;  // close to the overflow of the millisecond counter
  coil_begin(&c, {put, enable, sense, send}, now);
  std::string body;
  const auto receive = [&](char byte) {
    coil_receive(&c, byte, now);
    body = byte == '$' ? std::string() : std::move(body) + byte;
  };
  for (std::size_t i = 0; i < size; ++i) {
    if (data[i] == 0 && i + 1 < size) {
      now += data[++i];
      coil_tick(&c, now);
      check(!enabled || now - c.last_ms <= COIL_DEADLINE_MS);
    } else if (data[i] == 1) {
      const unsigned crc = coil_crc(body.data(), int(body.size()));
      receive('*');
      for (int shift = 12; shift >= 0; shift -= 4) receive("0123456789ABCDEF"[crc >> shift & 15]);
      receive('\n');
    } else {
      receive(char(data[i]));
    }
    check(enabled == (c.state == COIL_ON));
    for (const std::int32_t v : outputs) check(enabled || v == COIL_NEUTRAL_UV);
  }
  return 0;
}
