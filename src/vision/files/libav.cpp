#include "vision/files/libav.h"
#include "vision/files/ffmpeg.h"

#include <array>
#include <cstdarg>
#include <cstdio>
#include <mutex>

namespace faba::libav {
namespace {

thread_local std::string message;

void keep_first_error(void*, int level, const char* format, std::va_list arguments) {
  if (level > AV_LOG_ERROR || !message.empty()) return;
  std::array<char, 256> line{};
  std::vsnprintf(line.data(), line.size(), format, arguments);
  message = line.data();
  while (!message.empty() && (message.back() == '\n' || message.back() == ' ' || message.back() == '.'))
    message.pop_back();
}

}  // namespace

void quiet() {
  static std::once_flag once;
  std::call_once(once, [] { FABA_AV(av_log_set_callback)(keep_first_error); });
}

void forget_messages() { message.clear(); }

std::string first_message() { return message; }

std::string reason(int error_number) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  FABA_AV(av_strerror)(error_number, text.data(), text.size());
  return message.empty() ? std::string(text.data()) : std::string(text.data()) + " (" + message + ")";
}

}  // namespace faba::libav
