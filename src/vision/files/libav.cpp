#include "vision/files/libav.h"

extern "C" {
#include <libavutil/error.h>
#include <libavutil/log.h>
}

#include <array>
#include <cstdarg>
#include <cstdio>
#include <mutex>

namespace faba::libav {
namespace {

thread_local std::string said;

void keep_first_complaint(void*, int level, const char* format, std::va_list arguments) {
  if (level > AV_LOG_ERROR || !said.empty()) return;
  std::array<char, 256> line{};
  std::vsnprintf(line.data(), line.size(), format, arguments);
  said = line.data();
  while (!said.empty() && (said.back() == '\n' || said.back() == ' ' || said.back() == '.')) said.pop_back();
}

}  // namespace

void quiet() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_callback(keep_first_complaint); });
}

void forget_messages() { said.clear(); }

std::string first_message() { return said; }

std::string reason(int error_number) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(error_number, text.data(), text.size());
  return said.empty() ? std::string(text.data()) : std::string(text.data()) + " (" + said + ")";
}

}  // namespace faba::libav
